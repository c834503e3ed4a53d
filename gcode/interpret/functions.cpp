#include "gcode/interpret/interpreter.h"

namespace kadr::gcode {

void Interpreter::spindle() {
  const int code = words_.m(MGroup::spindle);
  if (code == kNoCode) return;
  if (code == 19) return orient_spindle();
  turn_spindle(code == 3   ? Turning::clockwise
               : code == 4 ? Turning::counterclockwise
                           : Turning::stopped,
               words_.span(*line_, MGroup::spindle));
}

void Interpreter::turn_spindle(Turning turning, Span span) {
  state_.turning = turning;
  Block block = make_block(turning == Turning::clockwise          ? BlockKind::spindle_clockwise
                           : turning == Turning::counterclockwise ? BlockKind::spindle_counterclockwise
                                                                  : BlockKind::spindle_stop,
                           span);
  block.value = mean_spindle_rpm(state_.position, state_.position);
  emit(block);
}

void Interpreter::orient_spindle() {
  state_.turning = Turning::stopped;
  Block block = make_block(BlockKind::spindle_stop, words_.span(*line_, MGroup::spindle));
  block.on = true;
  block.value = words_.has('R') ? words_.value('R') : 0;
  int way = words_.has('R') ? 0 : -1;
  if (words_.has('P')) near_integer(words_.value('P'), way);
  block.number = way;
  emit(block);
}

void Interpreter::coolant() {
  const int code = words_.m(MGroup::coolant);
  if (code == kNoCode) return;
  const Span span = words_.span(*line_, MGroup::coolant);
  if (code == 7) simple_block(BlockKind::mist_on, span);
  if (code == 8) simple_block(BlockKind::flood_on, span);
  if (code == 9) {
    simple_block(BlockKind::mist_off, span);
    simple_block(BlockKind::flood_off, span);
  }
  state_.mist = code == 7 || (state_.mist && code != 9);
  state_.flood = code == 8 || (state_.flood && code != 9);
}

void Interpreter::overrides() {
  const int code = words_.m(MGroup::overrides);
  if (code == kNoCode || code == 52 || code == 53) return;  // adaptive feed and feed hold are the operator's
  const bool enable = code == 48 || (code != 49 && !(words_.has('P') && words_.value('P') == 0));
  if (code != 51) override_block(BlockKind::feed_override, enable);
  if (code != 50) override_block(BlockKind::speed_override, enable);
}

void Interpreter::override_block(BlockKind kind, bool enabled) {
  (kind == BlockKind::feed_override ? state_.feed_override : state_.speed_override) = enabled;
  const int code = words_.m(MGroup::overrides);
  Block block = make_block(kind, code == kNoCode ? line_span() : words_.span(*line_, MGroup::overrides));
  block.number = enabled ? 1 : 0;
  emit(block);
}

void Interpreter::take_dwell_words() {
  const DwellWord* taken = nullptr;
  double dwell_s = 0;
  for (const DwellWord& word : dwell_words(options_.dialect)) {
    if (!words_.has(word.letter)) continue;
    if (taken == nullptr) {
      taken = &word;
      dwell_s = words_.value(word.letter) * word.unit_s;
      words_.stand_in('P', word.letter);
    }
    if (word.letter != 'P') words_.remove(word.letter);
  }
  if (taken != nullptr) words_.set('P', dwell_s);
}

void Interpreter::dwell() {
  if (words_.g(GGroup::nonmodal) != 40) return;
  Block block = make_block(BlockKind::dwell, g_span(GGroup::nonmodal));
  block.dwell_s = words_.value('P');
  emit(block);
}

/// A word or setting beside M98 P L or M99, none: null.
const Item* Interpreter::words_beside_call() const {
  for (const Item& item : line_->items) {
    if (item.kind == ItemKind::setting) return &item;
    if (item.kind != ItemKind::word || item.letter == 'N' || item.letter == 'P' || item.letter == 'L')
      continue;
    if (line_->span(item.bytes).column != words_.span(*line_, MGroup::call).column) return &item;
  }
  return nullptr;
}

/// LinuxCNC runs nothing of a line that begins with M98 but the call.
bool Interpreter::calls_only() const {
  return words_.m(MGroup::call) == 98 && options_.dialect != Dialect::fanuc;
}

void Interpreter::call() {
  const int code = words_.m(MGroup::call);
  if (code == kNoCode) return;
  CallRequest request;
  request.returns = code == 99;
  request.place = words_.span(*line_, MGroup::call);
  request.alone = !words_beside_call();
  int whole = 0;
  if (words_.has('P') && near_integer(words_.value('P'), whole)) {
    // beside L, all of P is the number
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
    case 1:
      simple_block(BlockKind::optional_stop, span);
      break;
    case 2:
    case 30:
      end_program(span);
      break;
    default:
      simple_block(BlockKind::program_stop, span);
      break;  // M0, and M60 for a machine without pallets
  }
}

void Interpreter::end_program(Span span) {
  state_.feed_mode = FeedMode::units_per_minute;
  simple_block(BlockKind::set_feed_mode, span);
  simple_block(BlockKind::set_feed_rate, span);
  if (!state_.feed_override) override_block(BlockKind::feed_override, true);
  if (!state_.speed_override) override_block(BlockKind::speed_override, true);
  turn_spindle(Turning::stopped, span);
  if (state_.mist) simple_block(BlockKind::mist_off, span);
  if (state_.flood) simple_block(BlockKind::flood_off, span);
  finish(span);
}

}  // namespace kadr::gcode
