#include "planner/override/approach.h"

#include <algorithm>
#include <cmath>

#include "machine/base/require.h"
#include "planner/override/feed_terrain.h"
#include "planner/override/motion_step.h"

namespace kadr::planner {
namespace {

using machine::kInfinity;

/// A ramp grows over so many more segments, then counts the whole run.
constexpr int kApproachRounds = 12;

}  // namespace

bool Approach::ramp_on(double w, RampLimits new_limits) {
  const double a = from.accel_u_s2;
  const double v = from.speed_u_s;
  limits = new_limits;
  virtual_u_s = v;
  done_s = 0.0;
  if (a == 0.0) return true;
  const double turn = a * a / (2.0 * limits.jerk_u_s3);
  virtual_u_s = a > 0.0 ? v - turn : v + turn;
  done_s = std::fabs(a) / limits.jerk_u_s3;
  return std::fabs(a) <= limits.accel_u_s2 && (a > 0.0 ? v + turn <= w : v - turn >= w);
}

double Approach::reach_u(double w) const {
  const double low = std::min(virtual_u_s, w), high = std::max(virtual_u_s, w);
  const double t = done_s;
  const double jerk = from.accel_u_s2 > 0.0 ? limits.jerk_u_s3 : -limits.jerk_u_s3;
  const double behind = t > 0.0 ? t * (virtual_u_s + t * t * jerk / 6.0) : 0.0;
  return from.s_u + ramp_length_u(low, high, limits) - behind;
}

Approach approach(const ApproachStart& start, double w) {
  const FeedTerrain& terrain = start.terrain;
  Approach way;
  way.from = start.state;
  way.from.jerk_u_s3 = 0.0;
  if (!(start.held.jerk_u_s3 < kInfinity)) way.from.accel_u_s2 = 0.0;
  for (bool flared = false;; flared = true) {
    std::size_t covered = terrain.segment_at(way.from.s_u, start.segment);
    const std::size_t first = covered;
    const std::size_t most = terrain.run_end(start.segment);
    bool fits = way.ramp_on(w, terrain.scaled(first, covered, start.scale));
    for (int i = 0; fits && i < kApproachRounds; ++i) {
      way.end_u = way.reach_u(w);
      if (way.done_s == 0.0 && same_speed(way.from.speed_u_s, w)) way.end_u = way.from.s_u;
      // an end that rounding takes over a joint is on it
      const double inside_u = way.end_u - start.slack_u;
      const std::size_t end = std::min(terrain.segment_at(inside_u, covered), most);
      if (end == covered) return way;
      covered = i + 2 == kApproachRounds ? most : end;
      fits = way.ramp_on(w, terrain.scaled(first, covered, start.scale));
    }
    if (fits) return way;
    require(!flared, "a ramp from acceleration 0 fits");
    // the acceleration leads away from w, or is more than the way ahead allows: to 0 under the limits it has
    const double a = way.from.accel_u_s2;
    way.flare_jerk = a > 0.0 ? -start.held.jerk_u_s3 : start.held.jerk_u_s3;
    way.flare_s = std::fabs(a) / start.held.jerk_u_s3;
    way.from.jerk_u_s3 = way.flare_jerk;
    way.from = moved(way.from, way.flare_s);
    way.from.accel_u_s2 = way.from.jerk_u_s3 = 0.0;
  }
}

}  // namespace kadr::planner
