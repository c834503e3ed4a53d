#include "emulator/interpolator/lattice/lattice.h"

#include <algorithm>
#include <variant>

#include "emulator/interpolator/lattice/steppers.h"

namespace kadr::interpolator::lattice {
namespace {

constexpr std::int64_t kMostLine = std::int64_t{1} << 60;
constexpr std::int64_t kMostPlane = std::int64_t{1} << 29;
constexpr std::int64_t kMostEvents = std::int64_t{1} << 40;

std::int64_t largest(const Point& p) {
  std::int64_t most = 0;
  for (const std::int64_t v : p) most = std::max(most, v == INT64_MIN ? INT64_MAX : magnitude(v));
  return most;
}

bool knows(const MethodEntry& m, const LineCurve& line) {
  return (line.axes == 2 ? m.plane_line : m.line) != nullptr;
}
MadeStepper make(const MethodEntry& m, const LineCurve& line, const MethodOptions& options) {
  return (line.axes == 2 ? m.plane_line : m.line)(line, options);
}

bool knows(const MethodEntry& m, const ArcCurve&) { return m.arc != nullptr; }
MadeStepper make(const MethodEntry& m, const ArcCurve& arc, const MethodOptions& options) {
  return m.arc(arc, options);
}

/// How far a curve given by its ends may go beyond them.
std::int64_t reach_of(const ImplicitCurve& curve) {
  return 1000 + 4 * std::max(largest({curve.begin.x, curve.begin.y}), largest({curve.end.x, curve.end.y}));
}

bool by_graph(const MethodEntry& m, const ImplicitCurve& curve) {
  return m.graph != nullptr && explicit_axis(curve.f) >= 0;
}
bool knows(const MethodEntry& m, const ImplicitCurve& curve) { return m.rule || by_graph(m, curve); }
MadeStepper make(const MethodEntry& m, const ImplicitCurve& curve, const MethodOptions& options) {
  if (by_graph(m, curve)) return m.graph(curve, options);
  return rule_curve(curve, *m.rule, reach_of(curve));
}

bool knows(const MethodEntry& m, const ParabolaCurve&) { return m.rule || m.parabola != nullptr; }
MadeStepper make(const MethodEntry& m, const ParabolaCurve& parabola, const MethodOptions& options) {
  if (m.parabola != nullptr) return m.parabola(parabola, options);
  return make(m, implicit_of(parabola), options);
}

bool is_conic(const BezierCurve& curve) {
  return curve.axes == 2 && curve.degree == 2 && curve.control[0] == Point{};
}
bool knows(const MethodEntry& m, const BezierCurve& curve) {
  return m.bezier != nullptr || (m.rule && is_conic(curve));
}
MadeStepper make(const MethodEntry& m, const BezierCurve& curve, const MethodOptions& options) {
  if (m.bezier != nullptr) return m.bezier(curve, options);
  // a Bezier lies among its control points
  return rule_curve(conic_of(curve), *m.rule,
                    2 + std::max(largest(curve.control[1]), largest(curve.control[2])));
}

/// Whether an arc's end is a node of the lattice's ring about the circle: |r_end - R| <= sqrt(2)/2.
bool on_circle(const ArcCurve& arc) {
  // |r^2 - R^2| <= sqrt(2)/2 (r + R) in integers, squared twice: 2 (r^2 - R^2)^2 <= r^2 + R^2 + 2 r R
  const Wide r2 = Wide{arc.begin.x} * arc.begin.x + Wide{arc.begin.y} * arc.begin.y;
  const Wide e2 = Wide{arc.end.x} * arc.end.x + Wide{arc.end.y} * arc.end.y;
  const Wide difference = e2 - r2;
  // 2^59 steps squared at most: the left side leaves 128 bits only where the end is far off
  if ((difference < 0 ? -difference : difference) > (Wide{1} << 32)) return false;
  const Wide rest = 2 * difference * difference - r2 - e2;
  return rest <= 0 || rest * rest <= 4 * r2 * e2;
}

Refusal check(const MethodEntry&, const LineCurve& line) {
  if (largest(line.delta) > kMostLine) return Refusal::range;
  return largest(line.delta) == 0 ? Refusal::no_length : Refusal::none;
}

Refusal check(const MethodEntry& m, const ArcCurve& arc) {
  if (std::max(largest({arc.begin.x, arc.begin.y}), largest({arc.end.x, arc.end.y})) > kMostPlane)
    return Refusal::range;
  if (arc.begin == PlaneNode{}) return Refusal::no_length;
  if (!on_circle(arc)) return Refusal::off_curve;
  if (m.method != Method::printed_half_step) return Refusal::none;
  const Signs s = signs_of(quadrant_of(arc.begin, arc.turn), arc.turn);
  const bool same_side = arc.begin.x * arc.end.x >= 0 && arc.begin.y * arc.end.y >= 0;
  const bool ahead =
      same_side && (arc.end.x - arc.begin.x) * s.x >= 0 && (arc.end.y - arc.begin.y) * s.y >= 0;
  return ahead && !(arc.end == arc.begin) ? Refusal::none : Refusal::one_quadrant;
}

Refusal check(const MethodEntry&, const ParabolaCurve& parabola) {
  if (std::max({magnitude(parabola.y_begin), magnitude(parabola.y_end), magnitude(parabola.p)}) > kMostPlane)
    return Refusal::range;
  if (parabola.p == 0 || parabola.y_begin == parabola.y_end) return Refusal::no_length;
  const auto reach = std::max(largest(begin_of(parabola)), largest(end_of(parabola)));
  return reach > kMostPlane ? Refusal::range : Refusal::none;
}

/// Whether v = -P(u)/c and its differences stay below 2^60 steps between the ends and as far beyond the
/// beginning as the differences are taken: then 60 fraction bits fit as well.
bool newton_fits(const ImplicitCurve& curve) {
  const bool y_of_x = explicit_axis(curve.f) == 1;
  const double u = static_cast<double>(y_of_x ? largest({curve.begin.x, curve.end.x})
                                              : largest({curve.begin.y, curve.end.y})) +
                   kMostExplicitDegree;
  double p = 0, c = 0;
  for (const Term& t : curve.f.terms()) {
    auto term = static_cast<double>(t.c);
    if ((y_of_x ? t.py : t.px) == 1) {
      c += term;
      continue;
    }
    for (int i = y_of_x ? t.px : t.py; i > 0; --i) term *= u;
    p += term < 0 ? -term : term;
  }
  // a difference of order k is at most 2^k times the largest value
  return p * 64 < 1.15e18 * (c < 0 ? -c : c);
}

Refusal check(const MethodEntry& m, const ImplicitCurve& curve) {
  const std::int64_t reach =
      std::max(largest({curve.begin.x, curve.begin.y}), largest({curve.end.x, curve.end.y}));
  if (reach > kMostPlane || !curve.f.fits(reach_of(curve))) return Refusal::range;
  if (by_graph(m, curve) && !newton_fits(curve)) return Refusal::range;
  return curve.f.degree() == 0 ? Refusal::no_length : Refusal::none;
}

Refusal check(const MethodEntry& m, const BezierCurve& curve) {
  std::int64_t most = 0;
  bool length = false;
  for (int i = 0; i <= curve.degree; ++i) {
    const Point& p = curve.control[static_cast<std::size_t>(i)];
    most = std::max(most, largest(p));
    length = length || p != curve.control[0];
  }
  const bool conic = m.bezier == nullptr;
  if (most > (conic ? kMostPlane : kMostEvents)) return Refusal::range;
  if (!length) return Refusal::no_length;
  if (!conic) return Refusal::none;
  // the part of a conic that is used lies among the control points
  const Point &p = curve.control[1], &q = curve.control[2];
  return Wide{q[1]} * p[0] == Wide{q[0]} * p[1] ? Refusal::in_line : Refusal::none;
}

}  // namespace

std::int64_t most_steps(const Curve& curve) {
  if (std::holds_alternative<LineCurve>(curve)) return kMostLine;
  if (std::holds_alternative<BezierCurve>(curve)) return kMostEvents;
  return kMostPlane;
}

bool knows(Method method, const Curve& curve) {
  return std::visit([&](const auto& c) { return knows(entry_of(method), c); }, curve);
}

Made make_stepper(const Curve& curve, Method method, const MethodOptions& options) {
  const MethodEntry& m = entry_of(method);
  return std::visit(
      [&](const auto& c) -> Made {
        if (!knows(m, c)) return {nullptr, Refusal::other_curve};
        if (const Refusal refusal = check(m, c); refusal != Refusal::none) return {nullptr, refusal};
        return {make(m, c, options), Refusal::none};
      },
      curve);
}

Trace run(Stepper& stepper, const Curve& curve, std::int64_t most_slots) {
  Trace trace;
  trace.axes = axes_of(curve);
  trace.begin = trace.end = begin_of(curve);
  trace.hash = 1469598103934665603ULL;
  Slot slot;
  while (static_cast<std::int64_t>(trace.slots.size()) < most_slots) {
    if (!stepper.next(slot)) {
      trace.complete = true;
      break;
    }
    bool any = false;
    for (std::size_t k = 0; k < static_cast<std::size_t>(trace.axes); ++k) {
      trace.end[k] += slot.step[k];
      any = any || slot.step[k] != 0;
      trace.hash = (trace.hash ^ static_cast<std::uint8_t>(slot.step[k])) * 1099511628211ULL;
    }
    trace.forced += slot.forced;
    trace.idle += !any;
    trace.slots.push_back(slot);
  }
  trace.end_reached = trace.end == end_of(curve);
  return trace;
}

}  // namespace kadr::interpolator::lattice
