#pragma once
#include <algorithm>
#include <cmath>

#include "planner/laws/feed_plan.h"

namespace kadr::planner {

/// A state after a time of constant jerk.
inline MotionState moved(const MotionState& x, double t_s) {
  return {x.s_u + t_s * (x.speed_u_s + t_s * (0.5 * x.accel_u_s2 + t_s * x.jerk_u_s3 / 6.0)),
          std::max(x.speed_u_s + t_s * (x.accel_u_s2 + 0.5 * t_s * x.jerk_u_s3), 0.0),
          x.accel_u_s2 + t_s * x.jerk_u_s3, x.jerk_u_s3};
}

/// Speeds that differ only by rounding: a ramp between them would still take the root of that difference.
inline bool same_speed(double a_u_s, double b_u_s) {
  return std::fabs(a_u_s - b_u_s) <= 1e-14 * std::max(a_u_s, b_u_s);
}

}  // namespace kadr::planner
