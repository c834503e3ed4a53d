#include <fmt/format.h>

#include "gcode/interpret/interpreter.h"

namespace kadr::gcode {

void Interpreter::check_thread(int code) {
  const std::string name = g_name(code);
  const Span span = words_.g(GGroup::motion) == kNoCode ? action_span() : g_span(GGroup::motion);
  if (!words_.has_axis()) {
    error(problem(Code::word_missing, span, fmt::format("{} needs at least one axis word", name)));
  }
  if (!words_.has('K')) {
    error(problem(Code::word_missing, span,
                  fmt::format("{} needs K on each line: the travel per turn of the spindle", name)));
  }
  if (words_.has('F')) {
    error(problem(Code::thread_with_feed, words_.span(*line_, 'F'),
                  fmt::format("the feed of {} is K times the spindle's speed", name),
                  "write F on a line of its own"));
  }
  check_whole('$', 0, 0);
  if (words_.has('E')) {
    report_.warning(problem(Code::thread_unusual, words_.span(*line_, 'E'),
                            fmt::format("{} accepts E, but ignores it", name), "E is the taper of G76"));
  }
}

bool Interpreter::spindle_turns(int code) {
  if (state_.turning == Turning::stopped) {
    return error(problem(Code::thread_spindle_stopped, action_span(),
                         fmt::format("{} with the spindle stopped", g_name(code)),
                         "write M3 or M4 and S before it"));
  }
  warn_standing_spindle();
  return true;
}

void Interpreter::start_thread(double pitch_u_rev) {
  threading_ = true;
  thread_pitch_u_rev_ = pitch_u_rev;
  emit(action_span(), SyncStart{pitch_u_rev * state_.length_factor()});
}

void Interpreter::stop_thread() {
  threading_ = false;
  emit(action_span(), SyncStop{});
}

void Interpreter::warn_pitch(char letter) {
  const double pitch = words_.value(letter);
  if (pitch > 0) return;
  report_.warning(problem(Code::thread_unusual, words_.span(*line_, letter),
                          fmt::format("with a pitch of {} the tool does not move", figure(pitch))));
}

void Interpreter::thread() {
  const AxisValues end = target();
  if (!spindle_turns(code::g33)) return move_to(end);
  warn_pitch('K');
  start_thread(words_.value('K'));
  go_to(Rate::feed, end);
  stop_thread();
}

void Interpreter::rigid_tap() {
  const AxisValues wanted = target();
  const AxisValues from = state_.position;
  if (!spindle_turns(code::g33_1)) return;
  warn_pitch('K');
  // only X Y Z go down and come back; the other axes take their new position with the next move
  AxisValues bottom = from;
  for (std::size_t axis = 0; axis < 3; ++axis) bottom[axis] = wanted[axis];
  start_thread(words_.value('K'));
  RigidTap tap{straight_to(bottom)};
  if (words_.has('I') && words_.value('I') > 0) tap.retract_ratio = words_.value('I');
  set_feed(tap);
  move_to(bottom);
  emit(action_span(), tap);
  stop_thread();
  AxisValues after = wanted;
  for (std::size_t axis = 0; axis < 3; ++axis) after[axis] = from[axis];
  move_to(after);
}

}  // namespace kadr::gcode
