#include "gcode/interpret/corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "gcode/compensation/offset_corner.h"
#include "gcode/measure.h"

namespace kadr::gcode {
namespace {

constexpr double kCornerSlack_mm = 1e-6;  // a corner may take a whole move
constexpr double kCornerParallel = 1e-9;  // sine of an angle that is none

/// A line or an arc in its plane.
struct Curve {
  PlanePoint from = {}, to = {};
  bool arc = false;
  PlanePoint center = {};
  double radius_mm = 0;
  double turning = 0;  ///< of an arc: +1 counter-clockwise, -1 clockwise

  PlaneVector direction(PlanePoint at) const {
    return arc ? turned(unit(at - center), turning) : unit(to - from);
  }
  double sweep_rad(PlanePoint begin, PlanePoint end) const {
    return arc_sweep_rad(begin, end, center, turning < 0, 1);
  }
};

PlanePoint plane_point(const AxisValues& values, const PlaneAxes& axes) {
  return {values[static_cast<std::size_t>(axes.first)], values[static_cast<std::size_t>(axes.second)]};
}

Curve curve_of(const Block& block, const AxisValues& start, const PlaneAxes& axes) {
  Curve curve{.from = plane_point(start, axes), .to = plane_point(move_of(block)->end, axes)};
  if (const Arc* arc = std::get_if<Arc>(&block.action)) {
    curve.arc = true;
    curve.center = {arc->center_first_mm, arc->center_second_mm};
    curve.radius_mm = length(curve.from - curve.center);
    curve.turning = arc->turns > 0 ? 1 : -1;
  }
  return curve;
}

double cross_product(PlaneVector a, PlaneVector b) {
  return a.first_mm * b.second_mm - a.second_mm * b.first_mm;
}

/// The points that lie `distance_mm` to the left of both lines or arcs (right if negative), as far as there are any.
std::array<std::optional<PlanePoint>, 2> meetings(const Curve& a, const Curve& b, double distance_mm) {
  const auto circle = [&](const Curve& c) {
    return OffsetCircle{c.center, c.radius_mm - c.turning * distance_mm, false, false};
  };
  if (!a.arc && !b.arc) {
    const PlaneVector u = a.direction(a.to), v = b.direction(b.from);
    const double sine = cross_product(u, v);
    // from the corner along the first line, so that the point is as far from the second
    const PlanePoint on_first = a.to + distance_mm * turned(u, 1),
                     on_second = b.from + distance_mm * turned(v, 1);
    const double along_mm = cross_product(on_second - on_first, v) / sine;
    return {on_first + along_mm * u, std::nullopt};
  }
  if (a.arc && b.arc) {
    OffsetCircle one = circle(a);
    const OffsetCircle other = circle(b);
    one.inside = true;  // which side of the line of centres
    OffsetCircle turned_round = one;
    turned_round.inside = false;
    if (one.radius_mm <= 0 || other.radius_mm <= 0) return {};
    return {cross(one, other), cross(turned_round, other)};
  }
  const Curve& line = a.arc ? b : a;
  const OffsetCircle round = circle(a.arc ? a : b);
  if (round.radius_mm <= 0) return {};
  const PlaneVector u = line.direction(line.from);
  const PlanePoint on_line = line.from + distance_mm * turned(u, 1);
  const double height_mm = dot(round.center - on_line, turned(u, 1));
  return {cross(u, height_mm, round, true), cross(u, height_mm, round, false)};
}

/// Where a circle about `center` touches the curve.
PlanePoint touching(const Curve& curve, PlanePoint center) {
  if (curve.arc) return curve.center + curve.radius_mm * unit(center - curve.center);
  const PlaneVector u = curve.direction(curve.from);
  return curve.from + dot(center - curve.from, u) * u;
}

/// Whether the point lies between the ends of the curve.
bool lies_on(const Curve& curve, PlanePoint point) {
  const double slack_mm = kCornerSlack_mm;
  if (length(point - curve.from) <= slack_mm || length(point - curve.to) <= slack_mm) return true;
  if (curve.arc) return curve.sweep_rad(curve.from, point) <= curve.sweep_rad(curve.from, curve.to);
  const double along_mm = dot(point - curve.from, curve.direction(curve.from));
  return along_mm >= 0 && along_mm <= length(curve.to - curve.from);
}

/// Measures a move that now begins or ends elsewhere.
void measure_again(Block& block, const AxisValues& start, const PlaneAxes& axes) {
  if (Arc* arc = std::get_if<Arc>(&block.action)) {
    const Curve curve = curve_of(block, start, axes);
    measure_arc(curve.sweep_rad(curve.from, curve.to), curve.radius_mm, 0, *arc);
    return;
  }
  measure_straight(start, *move_of(block));
}

bool only_in_plane(const AxisValues& from, const AxisValues& to, const PlaneAxes& axes) {
  for (std::size_t a = 0; a < kProgramAxes; ++a) {
    const bool of_plane =
        a == static_cast<std::size_t>(axes.first) || a == static_cast<std::size_t>(axes.second);
    if (!of_plane && from[a] != to[a]) return false;
  }
  return true;
}

}  // namespace

CornerFault make_corner(const CornerWish& wish, Plane plane, const AxisValues& start, const Block& first,
                        const Block& second, CornerMoves& made) {
  const PlaneAxes axes = plane_axes(plane);
  const AxisValues at = move_of(first)->end;
  const Curve a = curve_of(first, start, axes), b = curve_of(second, at, axes);
  if (!only_in_plane(start, at, axes) || !only_in_plane(at, move_of(second)->end, axes))
    return CornerFault::other_axis;
  const PlaneVector u = a.direction(a.to), v = b.direction(b.from);
  const double sine = cross_product(u, v);
  if (std::fabs(sine) < kCornerParallel)
    return dot(u, v) > 0 ? CornerFault::straight : CornerFault::too_large;
  if (!wish.rounded && (a.arc || b.arc)) return CornerFault::chamfer_arc;

  PlanePoint center, begin, end;
  if (wish.rounded) {
    const double side = sine > 0 ? 1 : -1;
    const auto centers = meetings(a, b, side * wish.size_mm);
    double nearest_mm = INFINITY;
    for (const std::optional<PlanePoint>& found : centers) {
      if (!found || length(*found - a.to) >= nearest_mm) continue;
      nearest_mm = length(*found - a.to);
      center = *found;
    }
    if (nearest_mm == INFINITY) return CornerFault::too_large;
    begin = touching(a, center);
    end = touching(b, center);
  } else {
    begin = a.to - wish.size_mm * u;
    end = b.from + wish.size_mm * v;
  }
  if (!lies_on(a, begin) || !lies_on(b, end)) return CornerFault::too_large;

  const auto moved_to = [&](AxisValues values, PlanePoint point) {
    values[static_cast<std::size_t>(axes.first)] = point.first_mm;
    values[static_cast<std::size_t>(axes.second)] = point.second_mm;
    return values;
  };
  made.first = first;
  move_of(made.first)->end = moved_to(at, begin);
  measure_again(made.first, start, axes);
  made.corner_end = moved_to(at, end);
  // at the feed of the first move
  Arc round{*move_of(first)};
  round.end = made.corner_end;
  round.plane = plane;
  round.center_first_mm = center.first_mm;
  round.center_second_mm = center.second_mm;
  round.turns = sine > 0 ? 1 : -1;
  made.corner = Block{wish.span, wish.rounded ? Action{round} : Action{Feed{round}}};
  measure_again(made.corner, move_of(made.first)->end, axes);
  made.second = second;
  measure_again(made.second, made.corner_end, axes);
  return CornerFault::none;
}

}  // namespace kadr::gcode
