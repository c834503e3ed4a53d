#include "emulator/interpolator/segment_point.h"

#include <algorithm>
#include <cmath>

#include "machine/base/numbers.h"

namespace kadr::emulator {

namespace {

// 2 pi in two parts; the first has 31 bits, so that its product with a count of turns below 2^22 is exact
constexpr double kTurnHead = 0x1.921fb54400000p+2;
constexpr double kTurnTail = 0x1.0b4611a626331p-32;

SinCos turn_sincos(double angle_rad) {
  const double turns = std::floor(angle_rad / (2.0 * kPi));
  return exact_sincos((angle_rad - turns * kTurnHead) - turns * kTurnTail);
}

}  // namespace

void eval_segment(const planner::Path& path, std::size_t segment, double s_u, std::span<double> position_u,
                  std::span<double> tangent) {
  const planner::PathSegment& piece = path.segments[segment];
  const auto begin = path.node(segment), end = path.node(segment + 1);
  const double length_u = piece.length_u;
  const double u = std::clamp(s_u / length_u, 0.0, 1.0);
  for (std::size_t k = 0; k < begin.size(); ++k) {
    const double way_u = end[k] - begin[k];
    tangent[k] = way_u / length_u;
    // from the nearer end, so that both ends are exact
    position_u[k] = u < 0.5 ? begin[k] + way_u * u : end[k] - way_u * (1.0 - u);
  }
  if (piece.kind != planner::SegmentKind::arc) return;

  const planner::ArcShape& arc = path.arcs[static_cast<std::size_t>(piece.arc)];
  const auto first = static_cast<std::size_t>(arc.first_axis),
             second = static_cast<std::size_t>(arc.second_axis);
  const SinCos at = turn_sincos(arc.angle_begin_rad + arc.sweep_rad * u);
  const double growth_u = arc.radius_end_u - arc.radius_begin_u;
  const double r_u = arc.radius_begin_u + growth_u * u;
  tangent[first] = (growth_u * at.cos - r_u * arc.sweep_rad * at.sin) / length_u;
  tangent[second] = (growth_u * at.sin + r_u * arc.sweep_rad * at.cos) / length_u;
  if (u > 0.0 && u < 1.0) {
    position_u[first] = arc.center_first_u + r_u * at.cos;
    position_u[second] = arc.center_second_u + r_u * at.sin;
  }
}

}  // namespace kadr::emulator
