#include "planner/limits/ramp.h"

#include <algorithm>

namespace kadr::planner {
namespace {

double two_ramps(double v0, double v1, double w, RampLimits l) {
  return ramp_length_u(v0, w, l) + ramp_length_u(v1, w, l);
}

/// dS/dw of one ramp v -> w.
double slope(double v, double w, RampLimits l) {
  const double dv = w - v;
  if (!(dv > 0.0)) return 0.0;
  if (l.law == machine::RampLaw::quintic) {
    const double time = ramp_time_s(dv, l);
    const bool full = kQuinticAccel * dv >= time * l.accel_u_s2;
    return 0.5 * time + 0.5 * (v + w) * (full ? time / dv : 0.5 * time / dv);
  }
  const bool full = !(dv * l.jerk_u_s3 <= l.accel_u_s2 * l.accel_u_s2);
  const double rate = full ? 1.0 / l.accel_u_s2 : 1.0 / std::sqrt(dv * l.jerk_u_s3);
  return 0.5 * ramp_time_s(dv, l) + 0.5 * (v + w) * rate;
}

/// A guard: halving alone would need 54 steps to the last bit, and Newton helps.
constexpr int kBracketSteps = 64;

/// Highest w in [low, high] with way(w) <= distance; `way` increases, slope is its derivative.
template <class Way, class Slope>
double highest_speed(double low, double high, double distance, Way way, Slope slope_at) {
  if (way(high) <= distance) return high;
  double w = high;
  for (int i = 0; i < kBracketSteps && high - low > 1e-15 * high; ++i) {
    const double excess = way(w) - distance;
    (excess <= 0.0 ? low : high) = w;
    if (std::fabs(excess) <= 1e-15 * distance) break;
    const double next = w - excess / slope_at(w);
    w = next > low && next < high ? next : 0.5 * (low + high);
  }
  // Newton mostly comes from above: the last bits below its result are tried until the inequality holds
  for (double step = 1e-15; step < 1e-9; step *= 4.0) {
    w = high * (1.0 - step);
    if (w <= low) break;
    if (way(w) <= distance) return w;
  }
  return low;
}

}  // namespace

double peak_speed_u_s(double v0_u_s, double v1_u_s, double distance_u, RampLimits limits, double floor_u_s,
                      double ceiling_u_s) {
  // without a jerk limit w^2 = a d + (v0^2 + v1^2)/2; with one it is lower
  const double bound =
      std::sqrt(limits.accel_u_s2 * distance_u + 0.5 * (v0_u_s * v0_u_s + v1_u_s * v1_u_s)) * (1.0 + 1e-15);
  const double high = std::max(std::min(ceiling_u_s, bound), floor_u_s);
  return highest_speed(
      floor_u_s, high, distance_u, [&](double w) { return two_ramps(v0_u_s, v1_u_s, w, limits); },
      [&](double w) { return slope(v0_u_s, w, limits) + slope(v1_u_s, w, limits); });
}

double reach_speed_u_s(double v_u_s, double distance_u, RampLimits limits, double ceiling_u_s) {
  // without a jerk limit w^2 = v^2 + 2 a d
  const double bound = std::sqrt(v_u_s * v_u_s + 2.0 * limits.accel_u_s2 * distance_u) * (1.0 + 1e-15);
  return highest_speed(
      v_u_s, std::max(std::min(ceiling_u_s, bound), v_u_s), distance_u,
      [&](double w) { return ramp_length_u(v_u_s, w, limits); },
      [&](double w) { return slope(v_u_s, w, limits); });
}

}  // namespace kadr::planner
