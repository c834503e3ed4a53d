#pragma once
#include <cstdint>
#include <vector>

#include "planner/limits/ramp.h"

namespace kadr::planner {

struct WholeTicks {
  std::int64_t ticks = 0;
  double stretch = 1.0;  ///< factor on all times that is left to apply
};
/// Makes the time of one run a whole number of control ticks (paper 003, eq. 2) by lowering the longest
/// plateau, or, if no plateau can give enough, by slowing the whole run a little (v/k, a/k^2, j/k^3); both
/// keep every limit.
WholeTicks fill_whole_ticks(std::vector<Element>& run, double tau_s);
/// The same by slowing the whole run alone.
WholeTicks stretched_to_ticks(double time_s, double tau_s);

}  // namespace kadr::planner
