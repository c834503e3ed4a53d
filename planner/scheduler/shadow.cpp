#include "planner/scheduler/shadow.h"

#include <algorithm>
#include <cmath>

#include "machine/infinity.h"

namespace kadr::planner {
namespace {

/// A shadow is looked for when the level it may win is higher than the plain one by this factor.
constexpr double kWorthwhile = 1.01;
constexpr double kBelowPeak = 1e-12;  ///< relative: so much lower two ramps leave a plateau
constexpr int kPlaceHalvings = 45;    ///< of a fraction of a ramp's time, to 3e-14
constexpr int kLevelRounds = 6;
constexpr std::size_t kFewPlaces = 4;  ///< so few are looked at one by one
constexpr int kDepth = 7;              ///< halvings of a ramp's time, then it counts as too fast

/// Between two fractions of a ramp's time.
struct RampPart {
  double t0, t1;
  int depth;
};

/// Speed of the ramp p -> q at a fraction of its time, and the path up to there.
void ramp_at(const Anchor& p, const Anchor& q, RampLimits l, double fraction, double& s, double& v) {
  const double low = std::min(p.v, q.v);
  const double dv = std::fabs(q.v - p.v);
  const double time = ramp_time_s(dv, l);
  const bool rising = q.v > p.v;
  // measured from the low end; the second half mirrors the first about its middle
  const double t = time * (rising ? fraction : 1.0 - fraction);
  if (l.law == machine::RampLaw::quintic) {
    const JerkPiece piece{0.0, time, 0.0, low, 0.0, 0.0, {}, -1, dv};
    v = piece.speed_after_u_s(t);
    s = rising ? p.s + piece.way_u(t) : q.s - piece.way_u(t);
    return;
  }
  const double half = 0.5 * time;
  const double x = t <= half ? t : time - t;
  const double t_jerk = l.jerk_u_s3 * dv <= l.accel_u_s2 * l.accel_u_s2 ? half : l.accel_u_s2 / l.jerk_u_s3;
  double gain = 0.0, way = 0.0;  // speed above low, path beyond low * x
  const double jerk = t_jerk > 0.0 && l.jerk_u_s3 < machine::kInfinity ? l.jerk_u_s3 : 0.0;
  const double y = std::min(x, t_jerk);
  gain = 0.5 * jerk * y * y;
  way = jerk * y * y * y / 6.0;
  if (x > t_jerk) {
    const double z = x - t_jerk;
    way += gain * z + 0.5 * l.accel_u_s2 * z * z;
    gain += l.accel_u_s2 * z;
  }
  double from_low = low * x + way;
  v = low + gain;
  if (t > half) {
    v = low + dv - gain;
    // the whole ramp less what the mirror image has left
    from_low = 0.5 * (2.0 * low + dv) * time - ((low + dv) * x - way);
  }
  s = rising ? p.s + from_low : q.s - from_low;
}

/// The same for a few places, between two fractions of the ramp's time: each by the speed with
/// which the ramp comes to its higher end.
bool below_each_cap(const ValleyRamps& r, const Anchor& p, const Anchor& q, RampLimits limits, double t0,
                    double t1, std::size_t from, std::size_t to) {
  for (std::size_t place = from; place <= to; ++place) {
    const double edge = q.v > p.v ? r.end_of(place) : r.begin_of(place);
    double low = t0, high = t1;
    double s, v;
    for (int i = 0; i < kPlaceHalvings; ++i) {
      const double mid = 0.5 * (low + high);
      ramp_at(p, q, limits, mid, s, v);
      (s < edge ? low : high) = mid;
    }
    ramp_at(p, q, limits, q.v > p.v ? low : high, s, v);
    if (v > r.table.cap_u_s[place]) return false;
  }
  return true;
}

}  // namespace

bool find_level(const ValleyRamps& r, const Anchor& a, const Anchor& b, double m, double start,
                ShadowSides sides, ShadowLevel& found) {
  const std::size_t first = a.first_inside();
  const std::size_t last = b.last_inside();
  double w = start;
  for (int i = 0; i < kLevelRounds; ++i) {
    if (!(w > kWorthwhile * m)) return false;
    found = {w, r.ramp_from(a, w, b), r.ramp_to(b, w, a), {}, {}};
    if (!(found.up.length + found.down.length <= b.s - a.s)) {
      // too high to be reached: the peak two ramps can have, a little below to leave a plateau
      const RampLimits both{std::min(found.up.limits.accel_u_s2, found.down.limits.accel_u_s2),
                            std::min(found.up.limits.jerk_u_s3, found.down.limits.jerk_u_s3), r.table.law};
      const double floor = std::max(a.v, b.v);
      if (!(ramp_length_u(std::min(a.v, b.v), floor, both) <= b.s - a.s)) return false;
      w = peak_speed_u_s(a.v, b.v, b.s - a.s, both, floor, w) * (1.0 - kBelowPeak);
      continue;
    }
    found.up_end = r.anchor_after(a, found.up.length, w, b);
    found.down_begin = r.anchor_before(b, found.down.length, w, a);
    const std::size_t low = sides.left ? found.up_end.place : first;
    const std::size_t high = sides.right ? found.down_begin.place : last;
    const double lowest = low <= high ? r.caps.min(std::max(low, first), std::min(high, last)) : w;
    if (lowest >= w) return true;
    w = lowest;
  }
  return false;
}

bool keeps_below_caps(const ValleyRamps& r, const Anchor& p, const Anchor& q, RampLimits limits,
                      const Anchor& b) {
  RampPart parts[kDepth + 2];
  int count = 0;
  parts[count++] = {0.0, 1.0, 0};
  const std::size_t first = p.first_inside();
  const std::size_t last = q.last_inside();
  if (first > last) return true;
  while (count > 0) {
    const RampPart part = parts[--count];
    double s0, v0, s1, v1;
    ramp_at(p, q, limits, part.t0, s0, v0);
    ramp_at(p, q, limits, part.t1, s1, v1);
    const auto place_at = [&](double s) {
      return std::clamp(r.locate_after(std::clamp(s, p.s, b.s), p.place, b.place), first, last);
    };
    const std::size_t from = part.t0 > 0.0 ? place_at(s0) : first;
    const std::size_t to = part.t1 < 1.0 ? std::max(place_at(s1), from) : last;
    const double lowest = r.caps.min(from, to);
    if (std::max(v0, v1) <= lowest) continue;
    if (std::min(v0, v1) > lowest) return false;
    if (to <= from + kFewPlaces) {
      if (!below_each_cap(r, p, q, limits, part.t0, part.t1, from, to)) return false;
      continue;
    }
    if (part.depth == kDepth) return false;
    const double mid = 0.5 * (part.t0 + part.t1);
    parts[count++] = {mid, part.t1, part.depth + 1};
    parts[count++] = {part.t0, mid, part.depth + 1};
  }
  return true;
}

}  // namespace kadr::planner
