#pragma once
#include <functional>

#include "tests/storm/isolation.h"

namespace kadr::storm {

/// A smaller case that breaks the same invariant: without files, tables, lines and words that it does not need, and with
/// shorter numbers.
/// @param minutes  when to stop
/// @param tries    how often a case is looked at before it counts as sound: more than once for what depends on moments
StormCase shrunk(const StormCase& storm_case, Invariant invariant, std::uint64_t seed,
                 const CheckOptions& options, double minutes, int tries = 1);

}  // namespace kadr::storm
