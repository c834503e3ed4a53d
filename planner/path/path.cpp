#include "planner/path/path.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "machine/base/numbers.h"
#include "machine/machine.h"
#include "planner/path/arc_place.h"

namespace kadr::planner {
namespace {

/// Where an extreme of one circular coordinate lies near u: zero of its derivative, Newton with a fixed count.
double polish_extreme(const ArcShape& arc, double u, bool first) {
  for (int i = 0; i < 4; ++i) {
    const ArcPlace place(arc, u);
    const auto d1 = place.first();
    const auto d2 = place.second();
    const double slope = first ? d2.first : d2.second;
    if (slope == 0.0) break;
    u = std::clamp(u - (first ? d1.first : d1.second) / slope, 0.0, 1.0);
  }
  return u;
}

}  // namespace

Path Path::tail(std::size_t i) const {
  Path rest(axes_);
  const auto at = static_cast<std::ptrdiff_t>(i);
  rest.segments.assign(segments.begin() + at, segments.end());
  rest.nodes_u.assign(nodes_u.begin() + at * axes_, nodes_u.end());
  rest.start_s_u.assign(start_s_u.begin() + at, start_s_u.end());
  for (PathSegment& segment : rest.segments) {
    if (segment.shape < 0) continue;
    const auto shape = static_cast<std::size_t>(segment.shape);
    if (segment.kind == SegmentKind::arc) {
      segment.shape = static_cast<std::int32_t>(rest.arcs.size());
      rest.arcs.push_back(arcs[shape]);
    } else {
      segment.shape = static_cast<std::int32_t>(rest.curves.size());
      rest.curves.push_back(curves[shape]);
    }
  }
  return rest;
}

std::string_view motion_name(const PathSegment& segment) { return gcode::kBlockKinds.word(segment.made_by); }

void eval_position(const Path& path, std::size_t segment, double s_u, std::span<double> position_u) {
  const PathSegment& seg = path.segments[segment];
  const auto from = path.node(segment);
  const auto to = path.node(segment + 1);
  // the nodes themselves at the ends, so that neighbours agree to the bit
  if (s_u <= 0.0 || s_u >= seg.length_u) {
    const auto at = s_u <= 0.0 ? from : to;
    std::copy(at.begin(), at.end(), position_u.begin());
    return;
  }
  if (seg.kind == SegmentKind::curve) {
    const PathCurve& curve = path.curve_of(segment);
    return curve.position(curve.t(s_u), position_u);
  }
  const double u = s_u / seg.length_u;
  for (std::size_t j = 0; j < from.size(); ++j) position_u[j] = from[j] + (to[j] - from[j]) * u;
  if (seg.kind == SegmentKind::arc) {
    const ArcShape& arc = path.arc_of(segment);
    const auto p = ArcPlace(arc, u).position();
    position_u[static_cast<std::size_t>(arc.first_axis)] = p.first;
    position_u[static_cast<std::size_t>(arc.second_axis)] = p.second;
  }
}

std::pair<double, double> axis_extent(const Path& path, std::size_t segment, int axis) {
  const auto j = static_cast<std::size_t>(axis);
  double low = std::min(path.node(segment)[j], path.node(segment + 1)[j]);
  double high = std::max(path.node(segment)[j], path.node(segment + 1)[j]);
  if (path.segments[segment].kind == SegmentKind::curve) {
    const PathCurve& curve = path.curve_of(segment);
    for (const double t : curve.turning_points(j)) {
      const double value = curve.position(j, t);
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (path.segments[segment].kind != SegmentKind::arc) return {low, high};
  const ArcShape& arc = path.arc_of(segment);
  if ((axis != arc.first_axis && axis != arc.second_axis) || arc.sweep_rad == 0.0) return {low, high};

  // a coordinate turns round every half turn: cos at k pi, sin at (k + 1/2) pi; the radius is monotone, so
  // the outermost of them are among the first two and the last two
  const bool first = axis == arc.first_axis;
  const double phase = first ? 0.0 : 0.5;
  const double begin = arc.angle_begin_rad / kPi - phase;
  const double end = (arc.angle_begin_rad + arc.sweep_rad) / kPi - phase;
  const double k_low = std::ceil(std::min(begin, end));
  const double k_high = std::floor(std::max(begin, end));
  for (const double k : {k_low, k_low + 1.0, k_high - 1.0, k_high}) {
    if (k < k_low || k > k_high) continue;
    const double u = std::clamp(((k + phase) * kPi - arc.angle_begin_rad) / arc.sweep_rad, 0.0, 1.0);
    const auto p = ArcPlace(arc, polish_extreme(arc, u, first)).position();
    const double value = first ? p.first : p.second;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return {low, high};
}

bool is_positioning(const Path& path, std::size_t segment, const machine::MachineModel& machine) {
  if (machine.planner.rapid_law == machine::RapidShape::scurve || !path.segments[segment].rapid) return false;
  for (std::size_t c = 0; c < machine.axis.size(); ++c)
    if (machine.axis[c].has_plant && path.node(segment)[c] != path.node(segment + 1)[c]) return true;
  return false;
}

}  // namespace kadr::planner
