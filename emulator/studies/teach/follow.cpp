#include "emulator/studies/teach/follow.h"

#include <algorithm>
#include <cmath>

#include "emulator/studies/teach/deviation.h"

namespace kadr::emulator {
namespace {

using lattice::Curve;
using lattice::Method;

/// The column names of a method on a curve.
void name_columns(StepTable& table, const Curve& curve) {
  const bool line = std::holds_alternative<lattice::LineCurve>(curve);
  const bool arc = std::holds_alternative<lattice::ArcCurve>(curve);
  const bool bezier = std::holds_alternative<lattice::BezierCurve>(curve);
  table.value_name = "F";
  table.tested_name = std::string(lattice::entry_of(table.method).tested);
  switch (table.method) {
    case Method::half_step:
    case Method::crossing:
      table.tested_name = line ? "G=2F'" : arc ? "N=F'-1/2" : std::string("F'");
      if (line && table.axes != 2) {
        table.value_name = "";
        table.tested_name = "2i+1";
      }
      if (bezier && table.method == Method::crossing) table.value_name = table.tested_name = "";
      break;
    case Method::classic:
      table.tested_name = line && table.axes != 2 ? "2i" : "";
      if (line && table.axes != 2) table.value_name = "";
      break;
    case Method::diagonal:
      if (table.axes != 2) table.value_name = table.tested_name = "";
      break;
    case Method::extra_points:
    case Method::octant_midpoint:
      table.tested_name = line ? "2 M1" : "4 M1";
      table.tested_y_name = line ? "2 M2" : "4 M2";
      break;
    case Method::dda:
    case Method::dda_preloaded:
    case Method::dda_sequential:
    case Method::dda_simultaneous:
      table.value_name = "";
      table.tested_y_name = "Jy";
      break;
    case Method::newton:
      table.value_name = "x";
      if (const auto* f = std::get_if<lattice::ImplicitCurve>(&curve);
          f != nullptr && explicit_axis(f->f) == 1)
        table.value_name = "y";
      table.tested_y_name = "d1";
      break;
    case Method::progression:
      if (line) table.value_name = "";
      table.tested_name = line ? "S" : "N=F'-1/4";
      break;
    case Method::chords:
    case Method::ptp:
      table.value_name = table.tested_name = "";
      break;
    case Method::printed_difference:
    case Method::printed_half_step:
    case Method::magnitudes:
      break;
  }
}

void scale_names(StepTable& table, const Curve& curve) {
  int degree = 0;
  if (const auto* implicit = std::get_if<lattice::ImplicitCurve>(&curve)) degree = implicit->f.degree();
  if (std::holds_alternative<lattice::ParabolaCurve>(curve) ||
      std::holds_alternative<lattice::BezierCurve>(curve))
    degree = 2;
  if (degree == 0 || table.method == Method::progression || table.method == Method::newton) return;
  const std::string scale = std::to_string(1 << degree);
  if (table.tested_name == "F'") table.tested_name = scale + "F'";
  if (table.method == Method::extra_points) {
    table.tested_name = scale + " M1";
    table.tested_y_name = scale + " M2";
  }
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
    if (out.leg == 0) {
      name_columns(table, curve);
      scale_names(table, curve);
    }
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

}  // namespace kadr::emulator
