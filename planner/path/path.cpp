#include "planner/path/path.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "machine/base/numbers.h"
#include "machine/machine.h"

namespace kadr::planner {
namespace {

/// Derivatives of the two circular coordinates with respect to u = s/length, of the order asked for (0..2).
///   p = c + r e(phi), phi' = sweep, r' = dr (constant):
///   p' = dr e + r sweep n,   p'' = 2 dr sweep n - r sweep^2 e,   e = (cos, sin), n = (-sin, cos)
std::pair<double, double> circle_derivative(const ArcShape& arc, double u, int order) {
  const double dr = arc.radius_end_u - arc.radius_begin_u;
  const double r = arc.radius_begin_u + dr * u;
  const SinCos angle = exact_sincos(arc.angle_begin_rad + arc.sweep_rad * u);
  const double w = arc.sweep_rad;
  switch (order) {
    case 0:
      return {arc.center_first_u + r * angle.cos, arc.center_second_u + r * angle.sin};
    case 1:
      return {dr * angle.cos - r * w * angle.sin, dr * angle.sin + r * w * angle.cos};
    default:
      return {-2.0 * dr * w * angle.sin - r * w * w * angle.cos,
              2.0 * dr * w * angle.cos - r * w * w * angle.sin};
  }
}

/// Where an extreme of one circular coordinate lies near u: zero of its derivative, Newton with a fixed count.
double polish_extreme(const ArcShape& arc, double u, bool first) {
  for (int i = 0; i < 4; ++i) {
    const auto d1 = circle_derivative(arc, u, 1);
    const auto d2 = circle_derivative(arc, u, 2);
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
    const auto p = circle_derivative(arc, u, 0);
    position_u[static_cast<std::size_t>(arc.first_axis)] = p.first;
    position_u[static_cast<std::size_t>(arc.second_axis)] = p.second;
  }
}

void eval_tangent(const Path& path, std::size_t segment, double s_u, std::span<double> tangent) {
  const PathSegment& seg = path.segments[segment];
  if (seg.kind == SegmentKind::curve) {
    const PathCurve& curve = path.curve_of(segment);
    const LengthDerivatives x = curve.by_length(curve.t(s_u));
    std::copy_n(x.d1.begin(), path.axes(), tangent.begin());
    return;
  }
  const auto from = path.node(segment);
  const auto to = path.node(segment + 1);
  for (std::size_t j = 0; j < from.size(); ++j) tangent[j] = (to[j] - from[j]) / seg.length_u;
  if (seg.kind == SegmentKind::arc) {
    const ArcShape& arc = path.arc_of(segment);
    const auto d = circle_derivative(arc, std::clamp(s_u / seg.length_u, 0.0, 1.0), 1);
    tangent[static_cast<std::size_t>(arc.first_axis)] = d.first / seg.length_u;
    tangent[static_cast<std::size_t>(arc.second_axis)] = d.second / seg.length_u;
  }
}

void eval_curvature(const Path& path, std::size_t segment, double s_u, std::span<double> curvature_per_u) {
  const PathSegment& seg = path.segments[segment];
  std::fill_n(curvature_per_u.begin(), path.axes(), 0.0);
  if (seg.kind == SegmentKind::arc) {
    const ArcShape& arc = path.arc_of(segment);
    const auto d = circle_derivative(arc, std::clamp(s_u / seg.length_u, 0.0, 1.0), 2);
    const double scale = seg.length_u * seg.length_u;
    curvature_per_u[static_cast<std::size_t>(arc.first_axis)] = d.first / scale;
    curvature_per_u[static_cast<std::size_t>(arc.second_axis)] = d.second / scale;
  } else if (seg.kind == SegmentKind::curve) {
    const PathCurve& curve = path.curve_of(segment);
    const LengthDerivatives x = curve.by_length(curve.t(s_u));
    std::copy_n(x.d2.begin(), path.axes(), curvature_per_u.begin());
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
    const auto p = circle_derivative(arc, polish_extreme(arc, u, first), 0);
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
