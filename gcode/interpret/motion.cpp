#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gcode/constants.h"
#include "gcode/interpret/interpreter.h"
#include "gcode/measure.h"

namespace kadr::gcode {
namespace {

constexpr double kLeastInverseFeed = 0.1;  // #<_feed> of a very slow move under G93, per minute

}  // namespace

Motion Interpreter::motion_of_line() const {
  switch (words_.g(GGroup::motion)) {
    case code::g0:
      return Motion::traverse;
    case code::g1:
      return Motion::feed;
    case code::g2:
      return Motion::arc_clockwise;
    case code::g3:
      return Motion::arc_counterclockwise;
    case code::g5:
      return Motion::cubic_spline;
    case code::g5_1:
      return Motion::quadratic_spline;
    case code::g5_2:
      return Motion::nurbs;
    case code::g33:
      return Motion::thread;
    case code::g33_1:
      return Motion::rigid_tap;
    case code::g38_2:
    case code::g38_3:
    case code::g38_4:
    case code::g38_5:
    case code::g31:
      return Motion::probe;
    case code::g76:
      return Motion::thread_cycle;
    case code::g5_3:
    case code::g80:
      return Motion::none;
    case kNoCode:
      return state_.motion;
    default:
      return Motion::cycle;
  }
}

bool Interpreter::axis_words_taken() const {
  if (takes_axis_words(words_.g(GGroup::nonmodal))) return true;
  const int tool_length = words_.g(GGroup::tool_length);
  return tool_length == code::g43_1 || tool_length == code::g43_2;
}

bool Interpreter::moves() const {
  const int code = words_.g(GGroup::motion);
  if (code != kNoCode) return code != code::g80 && code != code::g5_3 && !motion_sets_mode();
  if (axis_words_taken()) return false;
  return words_.has_axis() || (is_arc(state_.motion) && (words_.present & letter_bits("IJK")) != 0);
}

/// Whether the motion code of the line moves nothing: G0 beside G28, G2 without words, where a dialect has it so.
bool Interpreter::motion_sets_mode() const {
  const int code = words_.g(GGroup::nonmodal);
  if (rules_.home_beside_motion && (code == code::g28 || code == code::g30)) return true;
  constexpr std::uint32_t kArcBits = kAxisBits | letter_bits("IJKRP@^");
  return rules_.bare_arc_sets_mode && is_arc(motion_of_line()) && (words_.present & kArcBits) == 0;
}

void Interpreter::motion() {
  if (rules_.text.corners) move_from_ = state_.position;
  const int code = words_.g(GGroup::motion);
  if (code != kNoCode) {
    if (nurbs_.open && code != code::g5_2 && code != code::g5_3) drop_nurbs(g_span(GGroup::motion));
    if (code == code::g5 || code == code::g5_1) {
      if ((words_.present & letter_bits("@^")) != 0 && !resolve_polar()) return;
      return spline(motion_of_line());
    }
    take_motion(code);
    if (code == code::g5_3) return end_nurbs();
  }
  if (!moves()) return;
  if ((words_.present & letter_bits("@^")) != 0 && !resolve_polar()) return;
  if (state_.uncertain.motion) return move_to(target());
  switch (state_.motion) {
    case Motion::none:
    case Motion::cubic_spline:  // hold for their line only
    case Motion::quadratic_spline:
      return;
    case Motion::traverse:
    case Motion::feed:
      return straight(state_.motion);
    case Motion::arc_clockwise:
    case Motion::arc_counterclockwise:
      return arc(state_.motion);
    case Motion::nurbs:
      return add_nurbs_point();
    case Motion::thread:
      return thread();
    case Motion::rigid_tap:
      return rigid_tap();
    case Motion::probe:
      return probe();
    case Motion::thread_cycle:
      return thread_cycle();
    case Motion::cycle:
      return cycle();
  }
}

void Interpreter::take_motion(int code) {
  state_.motion = motion_of_line();
  state_.uncertain.motion = false;
  if (state_.motion == Motion::traverse || state_.motion == Motion::feed || is_arc(state_.motion))
    state_.group_1 = state_.motion;
  if (state_.motion == Motion::cycle) {
    state_.cycle.code = code;
    return;
  }
  state_.cycle.in_sequence = false;
  if (state_.motion == Motion::probe) state_.probe_code = code;
}

AxisValues Interpreter::target() const {
  const bool machine_coordinates = words_.g(GGroup::nonmodal) == code::g53;
  AxisValues wanted = state_.position;
  if (machine_coordinates || state_.rotation_deg == 0) {
    // each axis for itself
    for (int axis = 0; axis < kProgramAxes; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      if (!words_.has(kAxisLetters[a])) continue;
      const double value = state_.to_base_units(axis, words_.value(kAxisLetters[a]));
      if (machine_coordinates) {
        wanted[a] = state_.incremental ? wanted[a] + value : value;
      } else {
        wanted[a] = state_.axis_to_machine(
            a, state_.incremental ? state_.axis_to_program(a, wanted[a]) + value : value);
      }
    }
  } else if (words_.has_axis()) {
    AxisValues program = state_.to_program(wanted);
    for (int axis = 0; axis < kProgramAxes; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      if (!words_.has(kAxisLetters[a])) continue;
      const double value = state_.to_base_units(axis, words_.value(kAxisLetters[a]));
      program[a] = state_.incremental ? program[a] + value : value;
    }
    wanted = state_.to_machine(program);
  }
  return near_position(wanted);
}

void Interpreter::move_to(const AxisValues& end) {
  state_.position = end;
  if (state_.uncertain.axes == 0 && words_.doubtful == 0) return;
  for (int axis = 0; axis < kProgramAxes; ++axis) {
    const std::uint32_t letter = letter_bit(kAxisLetters[static_cast<std::size_t>(axis)]);
    if ((words_.present & letter) == 0) continue;
    if ((words_.doubtful & letter) != 0) {
      state_.uncertain.axes |= 1U << axis;
    } else if (!state_.incremental) {
      state_.uncertain.axes &= ~(1U << axis);
    }
  }
}

void Interpreter::straight(Motion motion) {
  const bool at_feed = motion == Motion::feed || rules_.rapid_at_feed_mm_min > 0;
  const Rate rate = at_feed ? Rate::feed : Rate::rapid;
  state_.straight_move_due = false;
  const bool ready = rate == Rate::rapid || feed_ready();
  Move move = straight_to(target());
  if (ready && rate == Rate::feed) set_feed(move);
  move_to(move.end);
  if (ready) emit_straight(rate, move);
}

void Interpreter::go(Rate rate, const AxisValues& program) {
  go_to(rate, near_position(state_.to_machine(program)));
}

void Interpreter::go_to(Rate rate, const AxisValues& end) {
  Move move = straight_to(end);
  if (rate == Rate::feed) set_feed(move);
  move_to(end);
  emit_straight(rate, move);
}

/// A move under the modes in force, without length and feed.
Move Interpreter::make_move(const AxisValues& end) const {
  Move move;
  move.end = end;
  move.path_mode = state_.path_mode;
  move.path_tolerance_mm = state_.path_tolerance_mm;
  move.feed_override_enabled = state_.feed_override;
  return move;
}

/// A straight move from the present position, without feed.
Move Interpreter::straight_to(const AxisValues& end) {
  Move move = make_move(end);
  measure_straight(state_.position, move);
  last_move_end_ = end;
  return move;
}

void Interpreter::emit_straight(Rate rate, const Move& move) {
  switch (rate) {
    case Rate::rapid:
      return emit(action_span(), Traverse{move});
    case Rate::feed:
      return emit(action_span(), Feed{move});
  }
}

AxisValues Interpreter::near_position(const AxisValues& wanted) const {
  AxisValues end = state_.position;
  for (std::size_t a = 0; a < kProgramAxes; ++a) {
    if (std::fabs(wanted[a] - end[a]) > kSamePoint_u) end[a] = wanted[a];
  }
  return end;
}

bool Interpreter::feed_ready() {
  if (state_.feed_mode == FeedMode::inverse_time) {
    if (!words_.has('F')) {
      return error(problem(Code::inverse_feed_missing, action_span(), "no F on this line",
                           "under G93 each feed move needs its own F: 60 divided by its seconds"));
    }
    if (words_.value('F') > 0) return true;
    return error(
        problem(Code::feed_zero, words_.span(*line_, 'F'), "F0 under G93: the move would never end"));
  }
  if (state_.feed_linear_mm_min > 0) return true;
  if (state_.feed_linear_mm_rev > 0) return feed_per_turn_ready();
  const Span span = action_span();
  if (state_.uncertain.feed) return false;
  state_.uncertain.feed = true;
  const bool per_turn = state_.feed_mode == FeedMode::units_per_revolution;
  const std::string help =
      fmt::format("write F and the feed in units per {}", per_turn ? "turn of the spindle" : "minute");
  if (state_.feed_given) return error(problem(Code::feed_zero, span, "the feed in force here is F0"));
  if (state_.feed_cleared) {
    return error(
        problem(Code::feed_cleared, span, fmt::format("no F since {}", per_turn ? "G95" : "G94"), help));
  }
  return error(problem(Code::feed_missing, span, "no F has been given before this move", help));
}

void Interpreter::set_feed(Move& move) {
  const bool rotary = move.feed_length == FeedLength::rotary;
  if (threading_ || state_.feed_mode == FeedMode::units_per_revolution) return follow_spindle(move);
  if (state_.feed_mode == FeedMode::inverse_time) {
    move.duration_s = kSecondsPerMinute / words_.value('F');
    move.feed_u_s = move.length_u / move.duration_s;
    // a probing move, which has no time of its own, continues at this feed
    state_.feed_linear_mm_min = state_.feed_rotary_deg_min = move.feed_u_s * kSecondsPerMinute;
    const double length = rotary ? move.length_u : move.length_u / state_.length_factor();
    state_.feed_number = std::max(kLeastInverseFeed, length * words_.value('F'));
    return;
  }
  const double per_minute = rotary ? state_.feed_rotary_deg_min : state_.feed_linear_mm_min;
  move.feed_u_s = per_minute / kSecondsPerMinute;
}

Span Interpreter::action_span() const {
  const Span span = words_.motion_span(*line_);
  return span.length > 1 ? span : line_span();
}

}  // namespace kadr::gcode
