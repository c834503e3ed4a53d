#include <fmt/format.h>

#include "gcode/interpret/interpreter.h"

namespace kadr::gcode {

void Interpreter::spindle() {
  const int code = words_.m(MGroup::spindle);
  if (code == kNoCode) return;
  if (code == code::m19) return orient_spindle();
  turn_spindle(code == code::m3   ? Turning::clockwise
               : code == code::m4 ? Turning::counterclockwise
                                  : Turning::stopped,
               words_.span(*line_, MGroup::spindle));
  take_time(code, words_.span(*line_, MGroup::spindle));
}

void Interpreter::turn_spindle(Turning turning, Span span) {
  state_.turning = turning;
  const double speed_rpm = mean_spindle_rpm(state_.position, state_.position);
  switch (turning) {
    case Turning::clockwise:
      return emit(span, SpindleClockwise{speed_rpm});
    case Turning::counterclockwise:
      return emit(span, SpindleCounterclockwise{speed_rpm});
    case Turning::stopped:
      return emit(span, SpindleStop{});
  }
}

void Interpreter::orient_spindle() {
  state_.turning = Turning::stopped;
  SpindleOrientation orientation;
  if (words_.has('R')) orientation = {words_.value('R'), 0};
  if (words_.has('P')) near_integer(words_.value('P'), orientation.direction);
  emit(words_.span(*line_, MGroup::spindle), SpindleStop{orientation});
  take_time(code::m19, words_.span(*line_, MGroup::spindle));
}

void Interpreter::coolant() {
  const int code = words_.m(MGroup::coolant);
  if (code == kNoCode) return;
  const Span span = words_.span(*line_, MGroup::coolant);
  if (code == code::m7) emit(span, MistOn{});
  if (code == code::m8) emit(span, FloodOn{});
  if (code == code::m9) {
    emit(span, MistOff{});
    emit(span, FloodOff{});
  }
  state_.mist = code == code::m7 || (state_.mist && code != code::m9);
  state_.flood = code == code::m8 || (state_.flood && code != code::m9);
  take_time(code, span);
}

void Interpreter::overrides() {
  const int code = words_.m(MGroup::overrides);
  if (code == code::m52 || code == code::m53) return warn_without_effect();
  if (code == kNoCode) return;
  const bool enable =
      code == code::m48 || (code != code::m49 && !(words_.has('P') && words_.value('P') == 0));
  if (code != code::m51) enable_feed_override(enable);
  if (code != code::m50) enable_speed_override(enable);
}

void Interpreter::enable_feed_override(bool enabled) {
  state_.feed_override = enabled;
  emit(override_span(), FeedOverride{enabled});
}

void Interpreter::enable_speed_override(bool enabled) {
  state_.speed_override = enabled;
  emit(override_span(), SpeedOverride{enabled});
}

/// The M code of the line, or the whole line where a cycle or the end of the program switches overrides.
Span Interpreter::override_span() const {
  return words_.m(MGroup::overrides) == kNoCode ? line_span() : words_.span(*line_, MGroup::overrides);
}

void Interpreter::dwell() {
  if (words_.g(GGroup::nonmodal) != code::g4) return;
  emit(g_span(GGroup::nonmodal), Dwell{words_.value('P')});
}

/// A word or setting on the line of M98 P L or M99, none: null.
const Item* Interpreter::words_beside_call() const {
  for (const Item& item : line_->items) {
    if (item.kind == ItemKind::setting) return &item;
    if (item.kind != ItemKind::word || item.letter == 'N' || item.letter == 'P' || item.letter == 'L')
      continue;
    if (line_->span(item.bytes).column != words_.span(*line_, MGroup::call).column) return &item;
  }
  return nullptr;
}

/// LinuxCNC runs only the call of a line that begins with M98.
bool Interpreter::calls_only() const {
  return words_.m(MGroup::call) == code::m98 && !rules_.call_shares_line;
}

void Interpreter::call() {
  const int code = words_.m(MGroup::call);
  if (code == kNoCode) return;
  CallRequest request;
  request.returns = code == code::m99;
  request.place = words_.span(*line_, MGroup::call);
  request.alone = !words_beside_call();
  request.to_line = code == code::m97 || (request.returns && words_.has('P'));
  int whole = 0;
  if (words_.has('P') && near_integer(words_.value('P'), whole)) {
    // with L, all of P is the number
    const SubprogramCall meant =
        words_.has('L') ? SubprogramCall{whole} : subprogram_call(options_.dialect, whole);
    request.number = meant.number;
    request.repeats = meant.repeats;
  }
  if (words_.has('L') && near_integer(words_.value('L'), whole))
    request.repeats = static_cast<std::uint64_t>(whole);
  call_ = request;
}

void Interpreter::stop() {
  const int code = words_.m(MGroup::stop);
  if (code == kNoCode) return;
  const Span span = words_.span(*line_, MGroup::stop);
  switch (code) {
    case code::m1:
      emit(span, OptionalStop{});
      break;
    case code::m2:
    case code::m30:
      end_program(span);
      break;
    default:
      emit(span, ProgramStop{});
      break;  // M0, and M60 for a machine without pallets
  }
}

void Interpreter::end_program(Span span) {
  state_.feed_mode = FeedMode::units_per_minute;
  emit(span, SetFeedMode{state_.feed_mode});
  emit(span, SetFeedRate{});
  if (!state_.feed_override) enable_feed_override(true);
  if (!state_.speed_override) enable_speed_override(true);
  turn_spindle(Turning::stopped, span);
  if (state_.mist) emit(span, MistOff{});
  if (state_.flood) emit(span, FloodOff{});
  finish(span);
}

}  // namespace kadr::gcode
