#include <fmt/format.h>

#include "gcode/constants.h"
#include "gcode/interpret/interpreter.h"

/// Checks whether these words of outputs, inputs, spindle and modal state fit together.
namespace kadr::gcode {
namespace {

constexpr double kLargestChannel = 9999;
constexpr double kLastWaitMode = kWaitModes.size() - 1;
constexpr double kLastOrientWay = 2;  // P of M19: 0 the shorter way, 1 clockwise, 2 counter-clockwise

}  // namespace

void Interpreter::check_functions() {
  if (words_.m(MGroup::inputs) != kNoCode) check_inputs();
  // one spindle: $0, and $-1, which means all
  if (words_.has('$') && (words_.has('S') || words_.m(MGroup::spindle) != kNoCode)) check_whole('$', -1, 0);
  if (words_.m(MGroup::spindle) == code::m19) check_orientation();
  const int spindle_code = words_.m(MGroup::spindle);
  const int state_code = words_.m(MGroup::modal_state);
  if (spindle_code == kNoCode || state_code == kNoCode) return;
  error(problem(Code::modal_conflict, words_.span(*line_, MGroup::modal_state),
                fmt::format("M{} and M{} exclude each other on one line", spindle_code, state_code)));
}

void Interpreter::check_orientation() {
  if (words_.has('R') && !(words_.value('R') >= 0 && words_.value('R') <= kFullTurn_deg)) {
    error(problem(Code::word_out_of_range, words_.span(*line_, 'R'),
                  fmt::format("M19 R{}: allowed: 0 to 360 degrees", figure(words_.value('R')))));
  }
  check_whole('P', 0, kLastOrientWay);
  if (words_.has('Q') && !(words_.value('Q') > 0)) {
    error(problem(Code::word_out_of_range, words_.span(*line_, 'Q'),
                  fmt::format("M19 waits {} s, allowed above 0", figure(words_.value('Q')))));
  }
}

void Interpreter::check_inputs() {
  const int code = words_.m(MGroup::inputs);
  const Span span = words_.span(*line_, MGroup::inputs);
  if (code == code::m66) return check_wait();
  const std::string name = fmt::format("M{}", code);
  if (output_code(code)->analog) {
    require_words({{'E', "the number of the output"}, {'Q', "its value"}}, span, name);
    check_whole('E', 0, kLargestChannel);
  } else {
    require_words({{'P', "the number of the output"}}, span, name);
    check_whole('P', 0, kLargestChannel);
  }
}

void Interpreter::check_wait() {
  const Span span = words_.span(*line_, MGroup::inputs);
  if (words_.has('P') == words_.has('E')) {
    error(problem(Code::input_unclear, span,
                  words_.has('P') ? "both P (digital) and E (analog) name an input"
                                  : "neither P (digital) nor E (analog) names an input"));
    return;
  }
  check_whole('P', 0, kLargestChannel);
  check_whole('E', 0, kLargestChannel);
  if (!words_.has('L') || !check_whole('L', 0, kLastWaitMode)) return;
  const bool waits = words_.value('L') > 0.5;
  if (waits && words_.has('E')) {
    error(problem(Code::input_unclear, words_.span(*line_, 'L'),
                  "an analog input can only be read at once: L0"));
  } else if (waits && !(words_.has('Q') && words_.value('Q') > 0)) {
    error(problem(Code::input_unclear, words_.span(*line_, 'L'),
                  "a wait needs Q above 0: the seconds after which it gives up"));
  }
}

}  // namespace kadr::gcode
