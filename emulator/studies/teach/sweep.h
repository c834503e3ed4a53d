#pragma once
#include <cstdint>

#include "emulator/studies/teach/follow.h"

namespace kadr::studies {

/// Case number n of a sweep over all kinds of curve and all methods that know them: small lines, arcs,
/// ellipses, parabolas and Beziers from a fixed sequence of pseudo-random numbers.
struct SweepCase {
  interpolator::lattice::Curve curve;
  interpolator::lattice::Method method;
};
SweepCase sweep_case(std::uint32_t n);

/// One hash over the traces of cases `first` to `first + count - 1`: steps, what was tested, and the bits of
/// t in every slot. The same in every build of the core, whatever compiler, processor or optimisation.
/// @param hash  of the cases before, to go on from; kSweepBegin for none
inline constexpr std::uint64_t kSweepBegin = 1469598103934665603ULL;
std::uint64_t sweep_hash(std::uint32_t first, std::uint32_t count, std::uint64_t hash = kSweepBegin);

}  // namespace kadr::studies
