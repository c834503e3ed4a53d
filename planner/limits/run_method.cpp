#include "planner/limits/run_method.h"

#include <algorithm>

#include "machine/infinity.h"

namespace kadr::planner {

bool limits_jerk(const PathLimitTable& table, const Run& run) {
  const auto first = table.jerk_u_s3.begin();
  return std::any_of(first + static_cast<std::ptrdiff_t>(run.first),
                     first + static_cast<std::ptrdiff_t>(run.last + 1),
                     [](double jerk_u_s3) { return jerk_u_s3 < machine::kInfinity; });
}

}  // namespace kadr::planner
