#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

#include "planner/limits/limits.h"

/// Ramps and holds: the elements of a plan before it becomes pieces of time.
namespace kadr::planner {

/// Shape of a ramp, and its limits.
struct RampLimits {
  double accel_u_s2;
  double jerk_u_s3;  // may be inf with jerk_limited
  machine::RampLaw law = machine::RampLaw::jerk_limited;
};

/// A quintic ramp's largest acceleration is kQuinticAccel dv/T (in its middle), its largest jerk kQuinticJerk
/// dv/T^2 (at x = (3 +- sqrt(3))/6).
inline constexpr double kQuinticAccel = 1.875;
inline constexpr double kQuinticJerk = 5.773502691896258;  // 10/sqrt(3)

/// Shortest time to change speed by dv with acceleration zero at both ends:
///   jerk_limited   T = 2 sqrt(dv/j) if dv <= a^2/j, else dv/a + a/j   (dv/a where j is inf)
///   quintic        T = max(1.875 dv/a, sqrt(10/sqrt(3) dv/j))
inline double ramp_time_s(double dv_u_s, RampLimits l) {
  if (!(dv_u_s > 0.0)) return 0.0;
  if (l.law == machine::RampLaw::quintic)
    return std::fmax(kQuinticAccel * dv_u_s / l.accel_u_s2, std::sqrt(kQuinticJerk * dv_u_s / l.jerk_u_s3));
  if (dv_u_s * l.jerk_u_s3 <= l.accel_u_s2 * l.accel_u_s2) return 2.0 * std::sqrt(dv_u_s / l.jerk_u_s3);
  return dv_u_s / l.accel_u_s2 + l.accel_u_s2 / l.jerk_u_s3;
}

/// Path that such a ramp takes; it is symmetric, so S = (v0 + v1)/2 T. Increasing in the higher speed.
inline double ramp_length_u(double low_u_s, double high_u_s, RampLimits l) {
  return 0.5 * (low_u_s + high_u_s) * ramp_time_s(high_u_s - low_u_s, l);
}

/// Highest speed w between `floor` and `ceiling` with S(v0 -> w) + S(w -> v1) <= d, all under the same
/// limits. Newton's method inside a bracket, at most 64 steps, relative accuracy 1e-15; the inequality always
/// holds.
/// @pre S(v0 -> floor) + S(floor -> v1) <= d, floor >= max(v0, v1)
double peak_speed_u_s(double v0_u_s, double v1_u_s, double distance_u, RampLimits limits, double floor_u_s,
                      double ceiling_u_s);

/// Highest speed w up to `ceiling` with S(v -> w) <= d; as peak_speed_u_s.
/// @pre ceiling >= v
double reach_speed_u_s(double v_u_s, double distance_u, RampLimits limits, double ceiling_u_s);

/// A stretch of constant speed (v0 == v1) or one ramp between two speeds with acceleration zero at both ends
/// (a jump of acceleration where jerk is inf).
struct Element {
  double s_u = 0;
  double length_u = 0;
  double v0_u_s = 0;
  double v1_u_s = 0;
  RampLimits limits{0, 0};  // of a ramp
  Signature signature;

  bool is_hold() const { return v0_u_s == v1_u_s; }
  double time_s() const {
    if (!is_hold()) return ramp_time_s(std::fabs(v1_u_s - v0_u_s), limits);
    return length_u > 0.0 ? length_u / v0_u_s : 0.0;
  }
};

/// A stretch of path from rest to rest.
struct Run {
  std::size_t first = 0;  // segments [first, last]
  std::size_t last = 0;
};

}  // namespace kadr::planner
