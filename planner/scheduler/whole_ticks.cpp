#include "planner/scheduler/whole_ticks.h"

#include <algorithm>
#include <cmath>

#include "machine/base/require.h"

namespace kadr::planner {
namespace {

// of a speed range: until both ends are neighbours
constexpr int kPlateauHalvings = 100;
// relative error of a compensated sum of correctly rounded times
constexpr double kScaleRounding = 4e-15;

/// A plateau with its ramps: elements [up, holds..., down].
struct Plateau {
  std::size_t up = 0;
  std::size_t down = 0;
  bool found = false;
};

double total_time_s(const std::vector<Element>& run) {
  double sum = 0.0, lost = 0.0;  // compensated: a run can have a million elements
  for (const Element& e : run) {
    const double y = e.time_s() - lost;
    const double next = sum + y;
    lost = (next - sum) - y;
    sum = next;
  }
  return sum;
}

struct PlateauShape {
  double v0, v1, w0, length;
  RampLimits up, down;
  double time_s(double w) const {
    const RampLimits u = lowered(up, v0, w), d = lowered(down, v1, w);
    const double hold = length - ramp_length_u(v0, w, u) - ramp_length_u(v1, w, d);
    return ramp_time_s(w - v0, u) + ramp_time_s(w - v1, d) + std::max(hold, 0.0) / w;
  }
  /// Limits of a ramp between v and a plateau lowered from w0 to w. A quintic ramp keeps its time: a shorter
  /// one would begin steeper and could pass a cap that the higher ramp keeps below. With the same time it is
  /// slower at every place: r w(t') <= w(t) where r W(t') <= W(t) and t' >= t, as W, the path above v, is log-concave.
  RampLimits lowered(RampLimits l, double v, double w) const {
    if (l.law != machine::RampLaw::quintic || !(w0 > v)) return l;
    l.accel_u_s2 *= (w - v) / (w0 - v);
    l.jerk_u_s3 *= (w - v) / (w0 - v);
    return l;
  }
};

PlateauShape shape_of(const std::vector<Element>& run, const Plateau& p) {
  const Element& up = run[p.up];
  const Element& down = run[p.down];
  double length = 0.0;
  for (std::size_t i = p.up; i <= p.down; ++i) length += run[i].length_u;
  return {up.v0_u_s, down.v1_u_s, up.v1_u_s, length, up.limits, down.limits};
}

/// The longest plateau (in path) that can be lowered, keeping its anchors, so far that it lasts `more_s` longer.
Plateau longest_plateau(const std::vector<Element>& run, double more_s) {
  Plateau best;
  double best_length = 0.0;
  for (std::size_t i = 0; i + 2 < run.size(); ++i) {
    if (run[i].is_hold() || run[i].v1_u_s < run[i].v0_u_s) continue;
    std::size_t k = i + 1;
    while (k < run.size() && run[k].is_hold()) ++k;
    if (k == i + 1 || k == run.size() || run[k].v1_u_s > run[k].v0_u_s) continue;
    const Plateau p{i, k, true};
    const PlateauShape shape = shape_of(run, p);
    const double lowest = std::max({shape.v0, shape.v1, 0.05 * run[i].v1_u_s});
    if (shape.length > best_length && shape.time_s(lowest) >= shape.time_s(run[i].v1_u_s) + more_s) {
      best = p;
      best_length = shape.length;
    }
    i = k - 1;
  }
  return best;
}

void lower_plateau(std::vector<Element>& run, const Plateau& p, double more_s) {
  const PlateauShape shape = shape_of(run, p);
  const double wanted = shape.time_s(run[p.up].v1_u_s) + more_s;
  double low = std::max({shape.v0, shape.v1, 0.05 * run[p.up].v1_u_s});
  double high = run[p.up].v1_u_s;
  for (int i = 0; i < kPlateauHalvings; ++i) {
    const double w = 0.5 * (low + high);
    (shape.time_s(w) >= wanted ? low : high) = w;
  }
  const double w = high;  // not longer than wanted: at most the last bits remain
  Element& up = run[p.up];
  Element& down = run[p.down];
  // lengths are kept relative, so that a slow run far along the path does not lose its time to the last bits of s
  const double before = up.length_u;
  const double behind = down.length_u;
  up.limits = shape.lowered(up.limits, shape.v0, w);
  down.limits = shape.lowered(down.limits, shape.v1, w);
  up.v1_u_s = down.v0_u_s = w;
  up.length_u = ramp_length_u(up.v0_u_s, w, up.limits);
  down.length_u = ramp_length_u(down.v1_u_s, w, down.limits);
  for (std::size_t i = p.up + 1; i < p.down; ++i) run[i].v0_u_s = run[i].v1_u_s = w;
  run[p.up + 1].length_u += before - up.length_u;
  run[p.up + 1].s_u = up.s_u + up.length_u;
  run[p.down - 1].length_u += behind - down.length_u;
  down.s_u += behind - down.length_u;
}

double whole_number(double time, double tau_s) {
  // times that are whole up to rounding count as whole
  const double ticks = std::max(std::ceil(time / tau_s * (1.0 - 1e-12)), 1.0);
  require(ticks < 9e15, "a run's number of control ticks fits an integer");
  return ticks;
}

}  // namespace

WholeTicks stretched_to_ticks(double time, double tau_s) {
  const double ticks = whole_number(time, tau_s);
  const double wanted = ticks * tau_s;
  return {static_cast<std::int64_t>(ticks),
          std::fabs(wanted - time) > kScaleRounding * time ? wanted / time : 1.0};
}

WholeTicks fill_whole_ticks(std::vector<Element>& run, double tau_s) {
  const double time = total_time_s(run);
  const double ticks = whole_number(time, tau_s);
  const double more = ticks * tau_s - time;
  if (more > 1e-12 * time) {
    const Plateau p = longest_plateau(run, more);
    if (p.found) lower_plateau(run, p, more);
  }
  // the rest, if it is more than rounding: near a plateau's lowest speed time is a steep function of it
  const double now = total_time_s(run);
  const double wanted = ticks * tau_s;
  return {static_cast<std::int64_t>(ticks),
          std::fabs(wanted - now) > kScaleRounding * now ? wanted / now : 1.0};
}

}  // namespace kadr::planner
