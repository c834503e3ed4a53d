#include "emulator/interpolator/lattice/curve.h"

#include <algorithm>
#include <utility>

namespace kadr::interpolator::lattice {
namespace {

/// The node x nearest to y^2 / 2p; from a half upwards.
std::int64_t nearest_x(const ParabolaCurve& parabola, std::int64_t y) {
  const std::int64_t p2 = 2 * magnitude(parabola.p);
  const std::int64_t x = (2 * y * y + p2) / (2 * p2);
  return parabola.p > 0 ? x : -x;
}

Point point(PlaneNode node) { return {node.x, node.y}; }

}  // namespace

Polynomial::Polynomial(std::vector<Term> terms) : terms_(std::move(terms)) {
  for (const Term& t : terms_) degree_ = std::max(degree_, t.px + t.py);
}

Wide Polynomial::doubled(std::int64_t x2, std::int64_t y2) const {
  Wide sum = 0;
  for (const Term& t : terms_) {
    Wide term = t.c;
    for (int i = 0; i < t.px; ++i) term *= x2;
    for (int i = 0; i < t.py; ++i) term *= y2;
    for (int i = t.px + t.py; i < degree_; ++i) term *= 2;
    sum += term;
  }
  return sum;
}

double Polynomial::value(double x, double y) const {
  double sum = 0;
  for (const Term& t : terms_) {
    auto term = static_cast<double>(t.c);
    for (int i = 0; i < t.px; ++i) term *= x;
    for (int i = 0; i < t.py; ++i) term *= y;
    sum += term;
  }
  return sum;
}

Polynomial Polynomial::derivative_x() const {
  std::vector<Term> out;
  for (const Term& t : terms_)
    if (t.px > 0) out.push_back({t.c * t.px, t.px - 1, t.py});
  return Polynomial(std::move(out));
}

Polynomial Polynomial::derivative_y() const {
  std::vector<Term> out;
  for (const Term& t : terms_)
    if (t.py > 0) out.push_back({t.c * t.py, t.px, t.py - 1});
  return Polynomial(std::move(out));
}

bool Polynomial::fits(std::int64_t reach) const {
  const double most = 4.25e37;  // just below 2^125
  double sum = 0;
  for (const Term& t : terms_) {
    double term = static_cast<double>(t.c < 0 ? -t.c : t.c);
    for (int i = 0; i < t.px + t.py; ++i) term *= 2.0 * (static_cast<double>(reach) + 1.0);
    for (int i = t.px + t.py; i < degree_; ++i) term *= 2.0;
    sum += term;
  }
  return sum < most;
}

int explicit_axis(const Polynomial& f) {
  if (f.degree() > kMostExplicitDegree) return -1;
  for (const int v : {1, 0}) {
    Wide c = 0;
    bool plain = true;
    for (const Term& t : f.terms()) {
      const int own = v == 1 ? t.py : t.px, other = v == 1 ? t.px : t.py;
      if (own == 1) c += t.c;
      plain = plain && (own == 0 || (own == 1 && other == 0));
    }
    if (plain && c != 0) return v;
  }
  return -1;
}

ImplicitCurve ellipse(std::int64_t a, std::int64_t b, Turn turn) {
  return {Polynomial({{Wide{b} * b, 2, 0}, {Wide{a} * a, 0, 2}, {-Wide{a} * a * b * b, 0, 0}}),
          {a, 0},
          {a, 0},
          turn == Turn::ccw ? 1 : -1};
}

ImplicitCurve implicit_of(const ParabolaCurve& parabola) {
  const PlaneNode begin = {nearest_x(parabola, parabola.y_begin), parabola.y_begin};
  const PlaneNode end = {nearest_x(parabola, parabola.y_end), parabola.y_end};
  // F < 0 within the arms: to the left of one who comes down the arm of p > 0
  const bool down = parabola.y_end < parabola.y_begin;
  return {Polynomial({{1, 0, 2}, {-2 * parabola.p, 1, 0}}), begin, end, down == (parabola.p > 0) ? 1 : -1};
}

ImplicitCurve conic_of(const BezierCurve& curve) {
  const auto& c = curve.control;
  const std::int64_t b1 = 2 * (c[1][0] - c[0][0]), b2 = 2 * (c[1][1] - c[0][1]);
  const std::int64_t a1 = c[2][0] - c[0][0] - b1, a2 = c[2][1] - c[0][1] - b2;
  const Wide d = a2 * b1 - a1 * b2;
  // gradient at the beginning: D (b2, -b1); travel along b has it to its right where D > 0
  return {
      Polynomial({{a2 * a2, 2, 0}, {-2 * a1 * a2, 1, 1}, {a1 * a1, 0, 2}, {d * b2, 1, 0}, {-d * b1, 0, 1}}),
      {0, 0},
      {c[2][0] - c[0][0], c[2][1] - c[0][1]},
      d > 0 ? 1 : -1};
}

int axes_of(const Curve& curve) {
  if (const auto* line = std::get_if<LineCurve>(&curve)) return line->axes;
  if (const auto* bezier = std::get_if<BezierCurve>(&curve)) return bezier->axes;
  return 2;
}

Point begin_of(const Curve& curve) {
  if (const auto* arc = std::get_if<ArcCurve>(&curve)) return point(arc->begin);
  if (const auto* f = std::get_if<ImplicitCurve>(&curve)) return point(f->begin);
  if (const auto* bezier = std::get_if<BezierCurve>(&curve)) return bezier->control[0];
  if (const auto* p = std::get_if<ParabolaCurve>(&curve)) return {nearest_x(*p, p->y_begin), p->y_begin};
  return {};
}

Point end_of(const Curve& curve) {
  if (const auto* line = std::get_if<LineCurve>(&curve)) return line->delta;
  if (const auto* arc = std::get_if<ArcCurve>(&curve)) return point(arc->end);
  if (const auto* f = std::get_if<ImplicitCurve>(&curve)) return point(f->end);
  if (const auto* p = std::get_if<ParabolaCurve>(&curve)) return {nearest_x(*p, p->y_end), p->y_end};
  const auto& bezier = *std::get_if<BezierCurve>(&curve);
  return bezier.control[static_cast<std::size_t>(bezier.degree)];
}

}  // namespace kadr::interpolator::lattice
