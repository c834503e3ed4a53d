#pragma once
#include <vector>

#include "planner/limits/limits.h"
#include "planner/limits/ramp.h"

namespace kadr::planner {

/// Trapezoidal plan of one run without jerk limit: the exact time optimum for acceleration limits that are
/// constant on each segment. Forward and backward pass over v^2, then the peak of each segment from
///   w^2 = min(cap^2, a L + (v0^2 + v1^2)/2)
void plan_trapezoids(const Path& path, const PathLimitTable& table, const Run& run,
                     std::vector<Element>& out);

}  // namespace kadr::planner
