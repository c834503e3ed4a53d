#include "emulator/studies/teach/follow.h"

#include <algorithm>
#include <cmath>

#include "emulator/studies/teach/deviation.h"

namespace kadr::studies {
namespace {

namespace lattice = interpolator::lattice;

using lattice::Curve;
using lattice::Method;

/// 2^degree where a method tests F at halves of a step of a curve F = 0; else 1.
int scale_of(const Curve& curve) {
  if (const auto* implicit = std::get_if<lattice::ImplicitCurve>(&curve)) return 1 << implicit->f.degree();
  const bool conic = std::holds_alternative<lattice::ParabolaCurve>(curve) ||
                     std::holds_alternative<lattice::BezierCurve>(curve);
  return conic ? 4 : 1;
}

lattice::Columns columns_on(const lattice::MethodEntry& method, const Curve& curve, int axes) {
  if (std::holds_alternative<lattice::LineCurve>(curve))
    return axes == 2 ? method.plane_line_columns : method.line_columns;
  if (std::holds_alternative<lattice::ArcCurve>(curve)) return method.arc_columns;
  // half-crossings in t: there is no F
  if (std::holds_alternative<lattice::BezierCurve>(curve) && method.bezier != nullptr) return {"", "", ""};
  lattice::Columns columns = method.curve_columns;
  if (const auto* f = std::get_if<lattice::ImplicitCurve>(&curve);
      f != nullptr && method.graph != nullptr && explicit_axis(f->f) == 1)
    columns.value = "y";
  return columns;
}

/// What the columns of a method are called on a curve.
void name_columns(StepTable& table, const Curve& curve) {
  const lattice::MethodEntry& method = lattice::entry_of(table.method);
  const lattice::Columns columns = columns_on(method, curve, table.axes);
  const int scale = method.scaled ? scale_of(curve) : 1;
  const auto scaled = [&](std::string_view name) {
    return scale == 1 || name.empty() ? std::string(name) : std::to_string(scale) + std::string(name);
  };
  table.value_name = columns.value;
  table.tested_name = scaled(columns.tested);
  table.tested_y_name = scaled(columns.tested_y);
}

void add_leg(StepTable& table, const Curve& curve, const lattice::Trace& trace, const lattice::Point& origin,
             double& squares) {
  lattice::Point node = trace.begin;
  double t = std::holds_alternative<lattice::BezierCurve>(curve) && table.method == Method::crossing ? 0 : -1;
  for (std::size_t i = 0; i <= trace.slots.size(); ++i) {
    StepRow row;
    for (std::size_t k = 0; k < node.size(); ++k) row.node[k] = origin[k] + node[k];
    row.deviation_steps = deviation_steps(curve, node, t);
    table.worst_steps = std::max(table.worst_steps, std::fabs(row.deviation_steps));
    table.worst_square_steps = std::max(table.worst_square_steps, square_deviation_steps(curve, node));
    squares += row.deviation_steps * row.deviation_steps;
    if (i == trace.slots.size()) {
      // the curve itself continues from the last crossing to its end
      if (t >= 0) row.deviation_steps = deviation_steps(curve, node, 1);
      table.last = row;
      break;
    }
    row.slot = trace.slots[i];
    int steps = 0;
    for (std::size_t k = 0; k < node.size(); ++k) {
      node[k] += row.slot.step[k];
      steps += row.slot.step[k] != 0;
    }
    if (t >= 0) t = row.slot.parameter;
    table.pulses += steps;
    table.diagonals += steps > 1;
    table.rows.push_back(row);
  }
}

}  // namespace

Followed follow(const TeachCase& subject, Method method, const TeachOptions& options) {
  if (options.mode == TeachMode::point_to_point) method = Method::ptp;
  Followed out;
  StepTable& table = out.table;
  table.method = method;
  table.axes = subject.axes;
  table.hash = 1469598103934665603ULL;
  lattice::Point origin{};
  double squares = 0;
  std::size_t nodes = 0;
  table.end_reached = true;
  for (out.leg = 0; out.leg < subject.legs.size(); ++out.leg) {
    const Curve& curve = subject.legs[out.leg];
    const lattice::Made made = lattice::make_stepper(curve, method, options.method);
    out.refusal = made.refusal;
    if (!made.stepper) return out;
    const auto left = options.most_slots - static_cast<std::int64_t>(table.rows.size());
    const lattice::Trace trace = lattice::run(*made.stepper, curve, left);
    if (!trace.complete) return out;
    if (out.leg == 0) name_columns(table, curve);
    add_leg(table, curve, trace, origin, squares);
    nodes += trace.slots.size() + 1;
    table.forced += trace.forced;
    table.idle += trace.idle;
    table.hash = subject.legs.size() == 1 ? trace.hash : (table.hash ^ trace.hash) * 1099511628211ULL;
    const double length = curve_length_steps(curve, trace);
    if (method == Method::half_step || method == Method::crossing)
      for (const double share : crossing_shares(curve, trace))
        table.crossings_steps.push_back(table.length_steps + share * length);
    table.length_steps += length;
    table.end_reached = table.end_reached && trace.end_reached;
    const lattice::Point end = lattice::end_of(curve);
    for (std::size_t k = 0; k < end.size(); ++k) {
      table.end[k] = origin[k] + end[k];
      // the next leg begins where this one got to
      origin[k] = table.last.node[k];
    }
  }
  table.rms_steps = std::sqrt(squares / static_cast<double>(nodes));
  out.complete = true;
  return out;
}

}  // namespace kadr::studies
