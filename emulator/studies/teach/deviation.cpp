#include "emulator/studies/teach/deviation.h"

#include <algorithm>
#include <cmath>

namespace kadr::studies {
namespace {

namespace lattice = interpolator::lattice;

using lattice::Point;

constexpr int kFootSteps = 40;
constexpr int kHalvings = 50;

double real(std::int64_t v) { return static_cast<double>(v); }

double line_deviation(const lattice::LineCurve& line, const Point& node) {
  const auto& d = line.delta;
  if (line.axes == 2) {
    const double length = std::hypot(real(d[0]), real(d[1]));
    const auto f = lattice::Wide{d[0]} * node[1] - lattice::Wide{d[1]} * node[0];
    // the sign of F in coordinates that grow along the line
    const int sign = (d[0] < 0 ? -1 : 1) * (d[1] < 0 ? -1 : 1);
    return sign * static_cast<double>(f) / length;
  }
  double pp = 0, pd = 0, dd = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(line.axes); ++k) {
    pp += real(node[k]) * real(node[k]);
    pd += real(node[k]) * real(d[k]);
    dd += real(d[k]) * real(d[k]);
  }
  return std::sqrt(std::max(0.0, pp - pd * pd / dd));
}

double implicit_deviation(const lattice::Polynomial& f, const Point& node) {
  const double px = real(node[0]), py = real(node[1]);
  const Place q = foot_of(f, f.derivative_x(), f.derivative_y(), {px, py});
  const double distance = std::hypot(px - q.x, py - q.y);
  return f.value(px, py) < 0 ? -distance : distance;
}

double swept_rad(lattice::Turn turn, Place from, Place to) {
  const double cross = from.x * to.y - from.y * to.x, dot = from.x * to.x + from.y * to.y;
  const double angle = std::atan2(turn == lattice::Turn::ccw ? cross : -cross, dot);
  return angle < 0 ? angle + 2 * M_PI : angle;
}

/// The X or Y at which the curve crosses the side of the dual square that a slot leaves by.
template <class Value>
Place side_crossing(const Point& node, const lattice::Slot& slot, Value&& f) {
  const bool x_steps = slot.step[0] != 0;
  const double side = x_steps ? real(node[0]) + 0.5 * slot.step[0] : real(node[1]) + 0.5 * slot.step[1];
  const double middle = x_steps ? real(node[1]) : real(node[0]);
  const auto at = [&](double v) { return x_steps ? Place{side, v} : Place{v, side}; };
  double low = middle - 0.5, high = middle + 0.5;
  const double low_f = f(at(low));
  // a curve that clips a corner does not cross the side: use the nearer corner
  if ((low_f < 0) == (f(at(high)) < 0)) return std::fabs(low_f) < std::fabs(f(at(high))) ? at(low) : at(high);
  for (int i = 0; i < kHalvings; ++i) {
    const double half = 0.5 * (low + high);
    ((f(at(half)) < 0) == (low_f < 0) ? low : high) = half;
  }
  return at(0.5 * (low + high));
}

/// Path length at each slot's crossing, and at the end: the chords between crossings.
std::vector<double> chord_lengths(const lattice::Polynomial& f, const lattice::Trace& trace) {
  Point node = trace.begin;
  Place before{real(node[0]), real(node[1])};
  double s = 0;
  std::vector<double> out;
  const auto go = [&](Place to) {
    s += std::hypot(to.x - before.x, to.y - before.y);
    before = to;
    out.push_back(s);
  };
  for (const lattice::Slot& slot : trace.slots) {
    go(side_crossing(node, slot, [&](Place p) { return f.value(p.x, p.y); }));
    for (std::size_t k = 0; k < 2; ++k) node[k] += slot.step[k];
  }
  go({real(node[0]), real(node[1])});
  return out;
}

/// F of a curve that is followed by the sign of a polynomial.
lattice::Polynomial polynomial_of(const lattice::Curve& curve) { return *sign_polynomial(curve); }

}  // namespace

std::optional<lattice::Polynomial> sign_polynomial(const lattice::Curve& curve) {
  if (const auto* line = std::get_if<lattice::LineCurve>(&curve)) {
    if (line->axes != 2) return {};
    const auto &a = line->delta[0], &b = line->delta[1];
    // a y - b x in coordinates that grow along the line
    const int sign = (a < 0 ? -1 : 1) * (b < 0 ? -1 : 1);
    return lattice::Polynomial({{lattice::Wide{sign} * a, 0, 1}, {lattice::Wide{-sign} * b, 1, 0}});
  }
  if (const auto* arc = std::get_if<lattice::ArcCurve>(&curve)) {
    const lattice::Wide x = arc->begin.x, y = arc->begin.y;
    return lattice::Polynomial({{1, 2, 0}, {1, 0, 2}, {-x * x - y * y, 0, 0}});
  }
  if (const auto* parabola = std::get_if<lattice::ParabolaCurve>(&curve)) return implicit_of(*parabola).f;
  if (const auto* bezier = std::get_if<lattice::BezierCurve>(&curve)) {
    if (bezier->axes != 2 || bezier->degree != 2) return {};
    const Point &p = bezier->control[1], &q = bezier->control[2];
    if (lattice::Wide{q[1]} * p[0] == lattice::Wide{q[0]} * p[1]) return {};
    return conic_of(*bezier).f;
  }
  return std::get<lattice::ImplicitCurve>(curve).f;
}

Place foot_of(const lattice::Polynomial& f, const lattice::Polynomial& fx, const lattice::Polynomial& fy,
              Place from) {
  Place q = from;
  for (int i = 0; i < kFootSteps; ++i) {
    const double gx = fx.value(q.x, q.y), gy = fy.value(q.x, q.y), g2 = gx * gx + gy * gy;
    if (!(g2 > 0)) break;
    const double along = ((from.x - q.x) * -gy + (from.y - q.y) * gx) / g2, across = f.value(q.x, q.y) / g2;
    q = {q.x - across * gx - along * gy, q.y - across * gy + along * gx};
  }
  return q;
}

planner::Bezier real_bezier(const lattice::BezierCurve& curve) {
  std::vector<planner::BezierVector> control;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(curve.degree); ++i) {
    control.emplace_back();
    for (std::size_t k = 0; k < control[i].size(); ++k) control[i][k] = real(curve.control[i][k]);
  }
  return planner::Bezier(curve.axes, control);
}

double arc_sweep_rad(const lattice::ArcCurve& arc) {
  if (arc.begin == arc.end) return 2 * M_PI;
  return swept_rad(arc.turn, {real(arc.begin.x), real(arc.begin.y)}, {real(arc.end.x), real(arc.end.y)});
}

double deviation_steps(const lattice::Curve& curve, const Point& node, double t) {
  if (const auto* line = std::get_if<lattice::LineCurve>(&curve)) return line_deviation(*line, node);
  if (const auto* arc = std::get_if<lattice::ArcCurve>(&curve))
    return std::hypot(real(node[0]), real(node[1])) - std::hypot(real(arc->begin.x), real(arc->begin.y));
  if (const auto* bezier = std::get_if<lattice::BezierCurve>(&curve)) {
    if (t < 0) return implicit_deviation(polynomial_of(curve), node);
    planner::BezierVector d = real_bezier(*bezier).position(t);
    for (std::size_t k = 0; k < d.size(); ++k) d[k] -= real(node[k]);
    return planner::norm(d);
  }
  return implicit_deviation(polynomial_of(curve), node);
}

double square_deviation_steps(const lattice::Curve& curve, const Point& node) {
  if (const auto* line = std::get_if<lattice::LineCurve>(&curve)) {
    if (line->axes != 2) return -1;
    const double a = std::fabs(real(line->delta[0])), b = std::fabs(real(line->delta[1]));
    return std::fabs(line_deviation(*line, node)) * std::hypot(a, b) / (a + b);
  }
  const auto* arc = std::get_if<lattice::ArcCurve>(&curve);
  if (arc == nullptr) return -1;
  // the smallest square about the node that touches the circle
  const double q = real(arc->begin.x) * real(arc->begin.x) + real(arc->begin.y) * real(arc->begin.y);
  const double x = std::fabs(real(node[0])), y = std::fabs(real(node[1]));
  double low = 0, high = 2 * std::sqrt(q) + 2;
  for (int i = 0; i < kHalvings; ++i) {
    const double r = 0.5 * (low + high), u = std::max(x - r, 0.0), v = std::max(y - r, 0.0);
    const bool touches = x * x + y * y >= q ? u * u + v * v <= q : (x + r) * (x + r) + (y + r) * (y + r) >= q;
    (touches ? high : low) = r;
  }
  return high;
}

double curve_length_steps(const lattice::Curve& curve, const lattice::Trace& trace) {
  if (const auto* line = std::get_if<lattice::LineCurve>(&curve)) {
    double dd = 0;
    for (const std::int64_t d : line->delta) dd += real(d) * real(d);
    return std::sqrt(dd);
  }
  if (const auto* arc = std::get_if<lattice::ArcCurve>(&curve))
    return std::hypot(real(arc->begin.x), real(arc->begin.y)) * arc_sweep_rad(*arc);
  if (const auto* bezier = std::get_if<lattice::BezierCurve>(&curve))
    return planner::ArcLength(real_bezier(*bezier)).length_u();
  return chord_lengths(polynomial_of(curve), trace).back();
}

std::vector<double> crossing_shares(const lattice::Curve& curve, const lattice::Trace& trace) {
  std::vector<double> out;
  Point done{}, node = trace.begin;
  if (const auto* line = std::get_if<lattice::LineCurve>(&curve)) {
    for (const lattice::Slot& slot : trace.slots) {
      std::size_t k = 0;
      while (slot.step[k] == 0) ++k;
      out.push_back((real(done[k]) + 0.5) / std::fabs(real(line->delta[k])));
      ++done[k];
    }
    return out;
  }
  if (const auto* arc = std::get_if<lattice::ArcCurve>(&curve)) {
    const double r2 = real(arc->begin.x) * real(arc->begin.x) + real(arc->begin.y) * real(arc->begin.y);
    const double sweep = arc_sweep_rad(*arc);
    double done_rad = 0;
    Place before{real(arc->begin.x), real(arc->begin.y)};
    for (const lattice::Slot& slot : trace.slots) {
      const Place at = side_crossing(node, slot, [&](Place p) { return p.x * p.x + p.y * p.y - r2; });
      for (std::size_t k = 0; k < 2; ++k) node[k] += slot.step[k];
      // from crossing to crossing it is less than half a turn
      const double angle = swept_rad(arc->turn, before, at);
      done_rad += angle < M_PI ? angle : 0;
      before = at;
      out.push_back(std::min(done_rad / sweep, 1.0));
    }
    return out;
  }
  const auto* bezier = std::get_if<lattice::BezierCurve>(&curve);
  if (bezier != nullptr && !trace.slots.empty() && trace.slots.front().parameter >= 0) {
    const planner::ArcLength arc(real_bezier(*bezier));
    for (const lattice::Slot& slot : trace.slots) out.push_back(arc.s_u(slot.parameter) / arc.length_u());
    return out;
  }
  const std::vector<double> s = chord_lengths(polynomial_of(curve), trace);
  for (std::size_t i = 0; i + 1 < s.size(); ++i) out.push_back(s[i] / s.back());
  return out;
}

}  // namespace kadr::studies
