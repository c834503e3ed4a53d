#pragma once
#include "planner/time_law/problem.h"

namespace kadr::planner {

/// Multipliers that prove how good any law can be: x = v^2 makes the problem convex (dt = 2 ds/(sqrt x0 +
/// sqrt x1), limits linear), so for any profile x > 0 and any multipliers l >= 0
///   J* >= J(x) + l (G x - h) + sum min over 0 <= y_i <= cap_i^2 of r_i (y_i - x_i),   r = grad J(x) + G^T l.
struct Certificate {
  std::vector<double> speed_u_s;  // [nodes], > 0 inside; need not keep the limits
  std::vector<double> upper;      // [nodes][rows of accel_rows], of  before x0 + after x1 <= 1; s per limit
  std::vector<double> lower;      // of -(before x0 + after x1) <= 1
};

/// The bound, computed from the problem's definitions alone: whoever made the certificate need not be
/// trusted. Costs of laws that keep every limit are not below it. Multipliers below 0 count as 0.
double lower_bound_s(const LawProblem& problem, const Certificate& certificate);

}  // namespace kadr::planner
