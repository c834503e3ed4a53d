#include "emulator/interpolator/lattice/lattice.h"

#include <algorithm>
#include <array>

#include "emulator/interpolator/lattice/steppers.h"

namespace kadr::emulator::lattice {
namespace {

constexpr std::int64_t kMostLine = std::int64_t{1} << 60;
constexpr std::int64_t kMostPlane = std::int64_t{1} << 29;
constexpr std::int64_t kMostEvents = std::int64_t{1} << 40;

constexpr std::array<MethodEntry, machine::kStepMethods.size()> kTaught = {{
    {Method::classic, "F"},
    {Method::half_step, "F'"},
    {Method::diagonal, "V"},
    {Method::extra_points, "M1"},
    {Method::octant_midpoint, "M1"},
    {Method::dda, "Jx"},
    {Method::dda_preloaded, "Jx"},
    {Method::dda_sequential, "Jx"},
    {Method::dda_simultaneous, "Jx"},
    {Method::progression, "S"},
    {Method::chords, "V"},
    {Method::newton, "d0"},
    {Method::crossing, "F'"},
    {Method::ptp, "i"},
    {Method::printed_difference, "D"},
    {Method::printed_half_step, "D"},
    {Method::magnitudes, "D"},
}};

/// Where each method is among those taught.
constexpr auto kPlaceOf = [] {
  std::array<std::size_t, kTaught.size()> place{};
  place.fill(kTaught.size());
  for (std::size_t i = 0; i < kTaught.size(); ++i) place[static_cast<std::size_t>(kTaught[i].method)] = i;
  return place;
}();
static_assert(*std::max_element(kPlaceOf.begin(), kPlaceOf.end()) < kTaught.size(),
              "every method is taught, once");

std::int64_t largest(const Point& p) {
  std::int64_t most = 0;
  for (const std::int64_t v : p) most = std::max(most, v == INT64_MIN ? INT64_MAX : magnitude(v));
  return most;
}

MadeStepper make(const LineCurve& line, Method method, const MethodOptions& options) {
  const bool plane = line.axes == 2;
  switch (method) {
    case Method::classic:
      return classic_line(line);
    case Method::half_step:
    case Method::crossing:
      return half_step_line(line, options.tie_to_y);
    case Method::diagonal:
      return diagonal_line(line);
    case Method::dda:
      return dda_line(line, false);
    case Method::dda_preloaded:
      return dda_line(line, true);
    case Method::progression:
      return progression_line(line, options.fraction_bits);
    case Method::ptp:
      return point_to_point(line);
    case Method::extra_points:
      return plane ? extra_point_line(line) : nullptr;
    case Method::printed_difference:
      return plane ? printed_difference_line(line) : nullptr;
    case Method::magnitudes:
      return plane ? magnitude_line(line) : nullptr;
    case Method::octant_midpoint:
    case Method::dda_sequential:
    case Method::dda_simultaneous:
    case Method::chords:
    case Method::newton:
    case Method::printed_half_step:
      break;
  }
  return nullptr;
}

MadeStepper make(const ArcCurve& arc, Method method, const MethodOptions& options) {
  switch (method) {
    case Method::classic:
      return rule_arc(arc, ArcRule::classic);
    case Method::half_step:
    case Method::crossing:
      return rule_arc(arc, ArcRule::half_step);
    case Method::extra_points:
      return rule_arc(arc, ArcRule::extra_points);
    case Method::octant_midpoint:
      return rule_arc(arc, ArcRule::octant_midpoint);
    case Method::dda_sequential:
      return dda_arc(arc, true);
    case Method::dda_simultaneous:
      return dda_arc(arc, false);
    case Method::chords:
      return chord_arc(arc, options.chord_tolerance);
    case Method::printed_half_step:
      return printed_half_step_arc(arc);
    case Method::diagonal:
    case Method::dda:
    case Method::dda_preloaded:
    case Method::progression:
    case Method::ptp:
    case Method::newton:
    case Method::printed_difference:
    case Method::magnitudes:
      break;
  }
  return nullptr;
}

/// How far a curve given by its ends may go beyond them.
std::int64_t reach_of(const ImplicitCurve& curve) {
  return 1000 + 4 * std::max(largest({curve.begin.x, curve.begin.y}), largest({curve.end.x, curve.end.y}));
}

MadeStepper make_rule(const ImplicitCurve& curve, Method method, std::int64_t reach) {
  if (method == Method::classic) return rule_curve(curve, CurveRule::classic, reach);
  if (method == Method::half_step || method == Method::crossing)
    return rule_curve(curve, CurveRule::half_step, reach);
  if (method == Method::extra_points) return rule_curve(curve, CurveRule::extra_points, reach);
  return nullptr;
}

MadeStepper make(const ImplicitCurve& curve, Method method, const MethodOptions& options) {
  if (method == Method::newton) return newton_explicit(curve, options.fraction_bits);
  return make_rule(curve, method, reach_of(curve));
}

MadeStepper make(const ParabolaCurve& parabola, Method method, const MethodOptions& options) {
  if (method == Method::progression) return progression_parabola(parabola);
  if (method == Method::newton) return newton_parabola(parabola, options.fraction_bits);
  return make(implicit_of(parabola), method, options);
}

bool is_conic(const BezierCurve& curve) {
  return curve.axes == 2 && curve.degree == 2 && curve.control[0] == Point{};
}

MadeStepper make(const BezierCurve& curve, Method method, const MethodOptions&) {
  if (method == Method::crossing) return bezier_events(curve);
  // a Bezier lies among its control points
  return is_conic(curve) ? make_rule(conic_of(curve), method,
                                     2 + std::max(largest(curve.control[1]), largest(curve.control[2])))
                         : nullptr;
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

Refusal check(const LineCurve& line, Method) {
  if (largest(line.delta) > kMostLine) return Refusal::range;
  return largest(line.delta) == 0 ? Refusal::no_length : Refusal::none;
}

Refusal check(const ArcCurve& arc, Method method) {
  if (std::max(largest({arc.begin.x, arc.begin.y}), largest({arc.end.x, arc.end.y})) > kMostPlane)
    return Refusal::range;
  if (arc.begin == PlaneNode{}) return Refusal::no_length;
  if (!on_circle(arc)) return Refusal::off_curve;
  if (method != Method::printed_half_step) return Refusal::none;
  const Signs s = signs_of(quadrant_of(arc.begin, arc.turn), arc.turn);
  const bool same_side = arc.begin.x * arc.end.x >= 0 && arc.begin.y * arc.end.y >= 0;
  const bool ahead =
      same_side && (arc.end.x - arc.begin.x) * s.x >= 0 && (arc.end.y - arc.begin.y) * s.y >= 0;
  return ahead && !(arc.end == arc.begin) ? Refusal::none : Refusal::one_quadrant;
}

Refusal check(const ParabolaCurve& parabola, Method) {
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

Refusal check(const ImplicitCurve& curve, Method method) {
  const std::int64_t reach =
      std::max(largest({curve.begin.x, curve.begin.y}), largest({curve.end.x, curve.end.y}));
  if (reach > kMostPlane || !curve.f.fits(reach_of(curve))) return Refusal::range;
  if (method == Method::newton && !newton_fits(curve)) return Refusal::range;
  return curve.f.degree() == 0 ? Refusal::no_length : Refusal::none;
}

Refusal check(const BezierCurve& curve, Method method) {
  std::int64_t most = 0;
  bool length = false;
  for (int i = 0; i <= curve.degree; ++i) {
    const Point& p = curve.control[static_cast<std::size_t>(i)];
    most = std::max(most, largest(p));
    length = length || p != curve.control[0];
  }
  const bool conic = method != Method::crossing;
  if (most > (conic ? kMostPlane : kMostEvents)) return Refusal::range;
  if (!length) return Refusal::no_length;
  if (!conic) return Refusal::none;
  // the part of a conic that is used lies among the control points
  const Point &p = curve.control[1], &q = curve.control[2];
  return Wide{q[1]} * p[0] == Wide{q[0]} * p[1] ? Refusal::in_line : Refusal::none;
}

}  // namespace

std::span<const MethodEntry> methods() { return kTaught; }

std::optional<Method> method_of(std::string_view name) { return machine::kStepMethods.find(name); }

const MethodEntry& entry_of(Method method) { return kTaught[kPlaceOf[static_cast<std::size_t>(method)]]; }

std::int64_t most_steps(const Curve& curve) {
  if (std::holds_alternative<LineCurve>(curve)) return kMostLine;
  if (std::holds_alternative<BezierCurve>(curve)) return kMostEvents;
  return kMostPlane;
}

namespace {

bool follows_line(Method method, bool plane) {
  switch (method) {
    case Method::crossing:
    case Method::classic:
    case Method::half_step:
    case Method::diagonal:
    case Method::dda:
    case Method::dda_preloaded:
    case Method::progression:
    case Method::ptp:
      return true;
    case Method::extra_points:
    case Method::printed_difference:
    case Method::magnitudes:
      return plane;
    case Method::octant_midpoint:
    case Method::dda_sequential:
    case Method::dda_simultaneous:
    case Method::chords:
    case Method::newton:
    case Method::printed_half_step:
      return false;
  }
  return false;
}

}  // namespace

bool knows(Method method, const Curve& curve) {
  if (const auto* line = std::get_if<LineCurve>(&curve)) return follows_line(method, line->axes == 2);
  const bool rule = method == Method::classic || method == Method::half_step ||
                    method == Method::extra_points || method == Method::crossing;
  if (std::holds_alternative<ArcCurve>(curve))
    return rule || method == Method::octant_midpoint || method == Method::dda_sequential ||
           method == Method::dda_simultaneous || method == Method::chords ||
           method == Method::printed_half_step;
  if (std::holds_alternative<ParabolaCurve>(curve))
    return rule || method == Method::progression || method == Method::newton;
  if (const auto* bezier = std::get_if<BezierCurve>(&curve))
    return method == Method::crossing || (rule && is_conic(*bezier));
  return rule || (method == Method::newton && explicit_axis(std::get<ImplicitCurve>(curve).f) >= 0);
}

Made make_stepper(const Curve& curve, Method method, const MethodOptions& options) {
  if (!knows(method, curve)) return {nullptr, Refusal::other_curve};
  return std::visit(
      [&](const auto& c) -> Made {
        if (const Refusal refusal = check(c, method); refusal != Refusal::none) return {nullptr, refusal};
        return {make(c, method, options), Refusal::none};
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

}  // namespace kadr::emulator::lattice
