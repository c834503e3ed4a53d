#include "planner/point_to_point/builders.h"

#include <cmath>
#include <span>

#include "machine/base/numbers.h"
#include "machine/base/require.h"

namespace kadr::planner {
namespace {

PointLaw convolved(const PointLaw& law, std::span<const Impulse> impulses) {
  require(law.edges().size() * impulses.size() <= PointLaw::kMostEdges, "a shaped law has at most 72 edges");
  std::array<PointEdge, PointLaw::kMostEdges> edges{};
  std::size_t n = 0;
  for (const Impulse& i : impulses)
    for (const PointEdge& e : law.edges())
      edges[n++] = {i.time_s + e.time_s, i.share * e.accel_u_s2, i.share * e.jerk_u_s3};
  return PointLaw::from_edges(std::span(edges.data(), n), law.distance_u());
}

/// Factor on an amplitude after half a damped period.
double half_period_decay(const Mode& mode) {
  return mode.zeta == 0.0 ? 1.0
                          : exact_exp(-mode.zeta * kPi / std::sqrt((1.0 - mode.zeta) * (1.0 + mode.zeta)));
}

}  // namespace

PointLaw ramp_law(double distance_u, double ramp_up_s, double cruise_s, double ramp_down_s) {
  const double v = distance_u / (cruise_s + (ramp_up_s + ramp_down_s) / 2);
  const double up = v / ramp_up_s, down = v / ramp_down_s;
  const double late_s = ramp_up_s + cruise_s;
  const PointEdge edges[] = {
      {0, up, 0}, {ramp_up_s, -up, 0}, {late_s, -down, 0}, {late_s + ramp_down_s, down, 0}};
  return PointLaw::from_edges(edges, distance_u);
}

PointLaw t_law(double distance_u, double duration_s, double xi) {
  const double ramp_s = xi * duration_s;
  return ramp_law(distance_u, ramp_s, std::fmax(0.0, duration_s - 2 * ramp_s), ramp_s);
}

PointLaw double_zero_law(double distance_u, double period_s, int ramp, int shift) {
  require(1 <= ramp && ramp <= shift, "a double zero has 1 <= ramp <= shift");
  return ramp_law(distance_u, ramp * period_s, (shift - ramp) * period_s, ramp * period_s);
}

PointLaw bang_bang_law(double distance_u, double v, double a) {
  const double full_s = v / a;
  // distance of both ramps at the speed limit is v^2/a
  if (distance_u > v * full_s) return ramp_law(distance_u, full_s, distance_u / v - full_s, full_s);
  const double ramp_s = std::sqrt(distance_u / a);
  return ramp_law(distance_u, ramp_s, 0, ramp_s);
}

PointLaw averaged(const PointLaw& law, double window_s) {
  require(2 * law.edges().size() <= PointLaw::kMostEdges, "an averaged law has at most 72 edges");
  std::array<PointEdge, PointLaw::kMostEdges> edges{};
  std::size_t n = 0;
  for (const PointEdge& e : law.edges()) {
    require(e.jerk_u_s3 == 0.0, "only a law without jerk is averaged");
    edges[n++] = {e.time_s, 0, e.accel_u_s2 / window_s};
    edges[n++] = {e.time_s + window_s, 0, -e.accel_u_s2 / window_s};
  }
  return PointLaw::from_edges(std::span(edges.data(), n), law.distance_u());
}

std::array<Impulse, 2> zv_impulses(const Mode& mode) {
  const double k = half_period_decay(mode);
  return {{{0, 1 / (1 + k)}, {mode.damped_period_s() / 2, k / (1 + k)}}};
}

std::array<Impulse, 3> zvd_impulses(const Mode& mode) {
  const double k = half_period_decay(mode), sum = (1 + k) * (1 + k), t_s = mode.damped_period_s();
  return {{{0, 1 / sum}, {t_s / 2, 2 * k / sum}, {t_s, k * k / sum}}};
}

PointLaw zv_shaped(const PointLaw& law, const Mode& mode) { return convolved(law, zv_impulses(mode)); }
PointLaw zvd_shaped(const PointLaw& law, const Mode& mode) { return convolved(law, zvd_impulses(mode)); }

}  // namespace kadr::planner
