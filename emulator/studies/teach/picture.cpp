#include "emulator/studies/teach/picture.h"

#include <cmath>

#include "emulator/interpolator/lattice/steppers.h"

namespace kadr::studies {
namespace {

namespace lattice = interpolator::lattice;

using lattice::Curve;
using lattice::Method;
using lattice::PlaneNode;
using lattice::TestedAt;

constexpr int kArcPlaces = 360, kBezierPlaces = 240;

double number(std::int64_t v) { return static_cast<double>(v); }

/// Directions of travel at a node; 1 where an axis rests.
struct Travel {
  std::int64_t x, y;
};

Travel travel_at(const Curve& curve, PlaneNode node) {
  if (const auto* line = std::get_if<lattice::LineCurve>(&curve))
    return {line->delta[0] < 0 ? -1 : 1, line->delta[1] < 0 ? -1 : 1};
  if (const auto* arc = std::get_if<lattice::ArcCurve>(&curve)) {
    const lattice::Signs s = lattice::signs_of(lattice::quadrant_of(node, arc->turn), arc->turn);
    return {s.x, s.y};
  }
  lattice::ImplicitCurve f{lattice::Polynomial({}), {}, {}, 1};
  if (const auto* parabola = std::get_if<lattice::ParabolaCurve>(&curve))
    f = implicit_of(*parabola);
  else if (const auto* bezier = std::get_if<lattice::BezierCurve>(&curve))
    f = conic_of(*bezier);
  else
    f = std::get<lattice::ImplicitCurve>(curve);
  const lattice::Ahead a = lattice::ahead_of(f.f.derivative_x(), f.f.derivative_y(), f.side, node);
  return {a.sx, a.sy};
}

/// F = 0 along the nodes of a path: the feet of the nodes and of the points between them.
std::vector<Place> feet(const lattice::Polynomial& f, const StepTable& table) {
  const lattice::Polynomial fx = f.derivative_x(), fy = f.derivative_y();
  const auto foot = [&](double x, double y) { return foot_of(f, fx, fy, {x, y}); };
  std::vector<Place> out;
  const auto add = [&](const lattice::Point& node) {
    const Place at = foot(number(node[0]), number(node[1]));
    if (!out.empty()) {
      const Place before = out.back();
      for (const double share : {0.25, 0.5, 0.75})
        out.push_back(foot(before.x + share * (at.x - before.x), before.y + share * (at.y - before.y)));
    }
    out.push_back(at);
  };
  for (const StepRow& row : table.rows) add(row.node);
  add(table.last.node);
  return out;
}

}  // namespace

std::vector<TestedPlace> tested_places(const Curve& curve, Method method, PlaneNode node) {
  if (!lattice::knows(method, curve) || !sign_polynomial(curve)) return {};
  const lattice::MethodEntry& entry = lattice::entry_of(method);
  // a method that shows no F of a line tests none
  if (std::holds_alternative<lattice::LineCurve>(curve) && entry.plane_line_columns.value.empty()) return {};
  const Travel s = travel_at(curve, node);
  const std::int64_t x2 = 2 * node.x, y2 = 2 * node.y;
  const TestedPlace beside_x{x2 + 2 * s.x, y2 + s.y}, beside_y{x2 + s.x, y2 + 2 * s.y};
  switch (entry.tested_at) {
    case TestedAt::nowhere:
      break;
    case TestedAt::node:
      return {{x2, y2}};
    case TestedAt::half_step:
      return {{x2 + s.x, y2 + s.y}};
    case TestedAt::beside_longer: {
      const auto& delta = std::get<lattice::LineCurve>(curve).delta;
      return {lattice::magnitude(delta[0]) >= lattice::magnitude(delta[1]) ? beside_x : beside_y};
    }
    case TestedAt::beside_both:
      return {beside_x, beside_y};
    case TestedAt::neighbours:
      return {{x2 + 2 * s.x, y2}, {x2, y2 + 2 * s.y}};
  }
  return {};
}

Place nearest_place(const Curve& curve, const lattice::Point& node, double t) {
  const Place at{number(node[0]), number(node[1])};
  if (const auto* bezier = std::get_if<lattice::BezierCurve>(&curve); bezier != nullptr && t >= 0) {
    const planner::BezierVector p = real_bezier(*bezier).position(t);
    return {p[0], p[1]};
  }
  const auto f = sign_polynomial(curve);
  return f ? foot_of(*f, f->derivative_x(), f->derivative_y(), at) : at;
}

std::vector<Place> curve_places(const Curve& curve, const StepTable& table) {
  std::vector<Place> out;
  if (const auto* line = std::get_if<lattice::LineCurve>(&curve))
    return {{0, 0}, {number(line->delta[0]), number(line->delta[1])}};
  if (const auto* arc = std::get_if<lattice::ArcCurve>(&curve)) {
    const double sweep = arc_sweep_rad(*arc) * (arc->turn == lattice::Turn::ccw ? 1 : -1);
    const double x = number(arc->begin.x), y = number(arc->begin.y);
    for (int i = 0; i <= kArcPlaces; ++i) {
      const double a = sweep * i / kArcPlaces, c = std::cos(a), s = std::sin(a);
      out.push_back({x * c - y * s, x * s + y * c});
    }
    return out;
  }
  if (const auto* bezier = std::get_if<lattice::BezierCurve>(&curve)) {
    const planner::Bezier b = real_bezier(*bezier);
    for (int i = 0; i <= kBezierPlaces; ++i) {
      const planner::BezierVector p = b.position(static_cast<double>(i) / kBezierPlaces);
      out.push_back({p[0], p[1]});
    }
    return out;
  }
  return feet(*sign_polynomial(curve), table);
}

std::vector<RosePoint> speed_rose(Method method, int directions, std::int64_t radius_steps) {
  std::vector<RosePoint> out;
  for (int i = 0; i < directions; ++i) {
    const double angle = 2 * M_PI * i / directions, r = number(radius_steps);
    lattice::LineCurve line{2, {std::llround(r * std::cos(angle)), std::llround(r * std::sin(angle))}};
    const lattice::Made made = lattice::make_stepper(line, method);
    RosePoint point{std::atan2(number(line.delta[1]), number(line.delta[0])), 0};
    lattice::Slot slot;
    std::int64_t slots = 0;
    while (made.stepper && made.stepper->next(slot)) ++slots;
    if (slots > 0) point.speed = std::hypot(number(line.delta[0]), number(line.delta[1])) / number(slots);
    out.push_back(point);
  }
  return out;
}

}  // namespace kadr::studies
