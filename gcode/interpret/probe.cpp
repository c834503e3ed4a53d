#include <fmt/format.h>

#include <cmath>

#include "gcode/constants.h"
#include "gcode/interpret/interpreter.h"
#include "gcode/measure.h"

namespace kadr::gcode {
namespace {

bool same_point(const AxisValues& a, const AxisValues& b) {
  for (std::size_t axis = 0; axis < kProgramAxes; ++axis)
    if (std::fabs(a[axis] - b[axis]) > kSamePoint_u) return false;
  return true;
}

}  // namespace

void Interpreter::probe() {
  const bool inverse = state_.feed_mode == FeedMode::inverse_time;
  const bool allowed = probe_allowed() && (inverse ? probe_feed_under_inverse_time() > 0 : feed_ready());
  const AxisValues end = target();
  const bool known = state_.uncertain.axes == 0 && words_.doubtful == 0;
  if (!allowed || !known) return move_to(end);
  if (same_point(state_.position, end)) {
    error(problem(Code::probe_too_short, action_span(), "the move ends where it begins",
                  "name a point on the other side of the surface"));
    return;
  }
  Probe probe{make_move(end)};
  probe.away = state_.probe_code == code::g38_4 || state_.probe_code == code::g38_5;
  probe.must_trip = state_.probe_code == code::g38_2 || state_.probe_code == code::g38_4;
  double travelled = 1;
  if (!find_contact(probe, travelled)) return move_to(end);
  measure_straight(state_.position, probe);
  if (inverse) {
    probe.feed_u_s = probe_feed_under_inverse_time() / kSecondsPerMinute;
  } else {
    set_feed(probe);
  }
  probe.length_u *= travelled;
  keep_probe_result(probe);
  move_to(probe.contact);
  emit(action_span(), probe);
}

/// As in LinuxCNC a probing move has no time of its own: it continues at the feed of the previous move, or at
/// the last F before G93.
/// @return mm/min, 0 if there is none: an error was reported
double Interpreter::probe_feed_under_inverse_time() {
  if (state_.feed_linear_mm_min > 0) return state_.feed_linear_mm_min;
  if (state_.feed_linear_mm_rev > 0) return state_.feed_linear_mm_rev;
  error(problem(Code::feed_missing, action_span(),
                "under G93 a probing move has the feed of the move before it", "write G94 and F before it"));
  return 0;
}

bool Interpreter::probe_allowed() {
  if (!words_.has_axis()) {
    return error(
        problem(Code::word_missing, action_span(),
                fmt::format("{} needs an axis word: the point to probe towards", g_name(state_.probe_code))));
  }
  if (state_.feed_mode == FeedMode::units_per_revolution) {
    return error(problem(Code::probe_feed_mode, action_span(), "G95 is in force here",
                         "write G94 and a feed before it"));
  }
  return true;
}

/// Finds where the probe changes on the way to its end, and at which fraction of the move.
/// @return false: an error was reported
bool Interpreter::find_contact(Probe& probe, double& travelled) {
  probe.contact = probe.end;
  if (!options_.stock) {
    if (passing_) return refuse_passed_probe();
    if (!probe_stock_told_) {
      report_.warning(problem(Code::probe_without_stock, action_span(),
                              "the probe meets the end of each move",
                              "give [stock] in the machine or scenario file"));
    }
    probe_stock_told_ = true;
    return true;
  }
  const StockPlane& stock = *options_.stock;
  const auto axis = static_cast<std::size_t>(stock.axis);
  // the tip meets the plane: the controlled point minus its tool offset
  const double plane_u = stock.position_u + state_.tool_offset[axis];
  const double from_u = state_.position[axis], to_u = probe.end[axis];
  const auto inside = [&](double at_u) { return stock.below ? at_u <= plane_u : at_u >= plane_u; };
  // a probe that has just lost contact is on the plane and does not touch it
  const bool just_left = probe_left_ && same_point(*probe_left_, state_.position);
  const bool touching = inside(from_u) && !just_left;
  if (touching != probe.away) return refuse_probe_start(probe, from_u - plane_u);
  probe.tripped = inside(to_u) != probe.away;
  if (probe.tripped) {
    travelled = (plane_u - from_u) / (to_u - from_u);
    for (std::size_t a = 0; a < kProgramAxes; ++a)
      probe.contact[a] = state_.position[a] + (probe.end[a] - state_.position[a]) * travelled;
    probe.contact[axis] = plane_u;
    return true;
  }
  if (!probe.must_trip) return true;
  const double left_mm = std::fabs(to_u - plane_u);
  Diagnostic d = problem(
      Code::probe_no_contact, action_span(),
      fmt::format("the move ends {} mm {} the stock", figure(left_mm), probe.away ? "inside" : "from"));
  d.notes.push_back(stock_text());
  d.help = probe.away ? "probe further away, or use G38.5 and look at #5070"
                      : "probe further, or use G38.3 and look at #5070";
  return error(std::move(d));
}

std::string Interpreter::stock_text() const {
  const StockPlane& stock = *options_.stock;
  const char letter = kAxisLetters[static_cast<std::size_t>(stock.axis)];
  return fmt::format("stock: {} {} {} mm (machine coordinates)", letter, stock.below ? "below" : "above",
                     figure(stock.position_u));
}

bool Interpreter::refuse_probe_start(const Probe& probe, double beyond_mm) {
  const std::string apart = figure(std::fabs(beyond_mm));
  Diagnostic d = problem(Code::probe_already_there, action_span(),
                         probe.away ? fmt::format("the probe is {} mm outside the stock", apart)
                                    : fmt::format("the probe is {} mm inside the stock", apart));
  d.notes.push_back(stock_text());
  d.help = probe.away ? "probe towards the stock first: G38.2" : "retract before probing: G0 or G38.4";
  return error(std::move(d));
}

/// #5061 .. #5069 in program coordinates and the units in force, #5070.
void Interpreter::keep_probe_result(const Probe& probe) {
  const AxisValues at = state_.to_program(probe.contact);
  for (int axis = 0; axis < kProgramAxes; ++axis) {
    state_.parameters[static_cast<std::size_t>(parameter::kProbe + axis)] =
        state_.to_program_units(axis, at[static_cast<std::size_t>(axis)]);
  }
  state_.parameters[parameter::kProbeTripped] = probe.tripped ? 1 : 0;
  probe_left_.reset();
  if (probe.away && probe.tripped) probe_left_ = probe.contact;
}

}  // namespace kadr::gcode
