#include "gcode/interpret/interpreter.h"

/// M62 to M65, M67, M68: outputs, with the next motion or at once. M66: a wait for an input.
namespace kadr::gcode {
namespace {

constexpr double kTimedOut = -1;  // #5399 then

}  // namespace

void Interpreter::inputs_and_outputs() {
  const int code = words_.m(MGroup::inputs);
  if (code == kNoCode) return;
  if (code == 66) return wait_input();
  const bool analog = code >= 67;
  Block block = make_block(analog ? BlockKind::analog_output : BlockKind::digital_output,
                           words_.span(*line_, MGroup::inputs));
  near_integer(words_.value(analog ? 'E' : 'P'), block.number);
  block.with_motion = code == 62 || code == 63 || code == 67;
  block.on = code == 62 || code == 64;
  if (analog) block.value = words_.value('Q');
  emit(block);
}

void Interpreter::wait_input() {
  Block block = make_block(BlockKind::wait_input, words_.span(*line_, MGroup::inputs));
  InputWait& wait = block.wait;
  wait.analog = words_.has('E');
  near_integer(words_.value(wait.analog ? 'E' : 'P'), wait.number);
  int mode = 0;
  if (words_.has('L')) near_integer(words_.value('L'), mode);
  wait.mode = kWaitModes.at(mode).value_or(WaitMode::immediate);
  if (wait.mode != WaitMode::immediate) wait.timeout_s = words_.value('Q');
  emit(block);
  // without a machine to ask, every input reads 0
  InputReading reading{true, 0};
  if (options_.read_input && !silent_) reading = options_.read_input(wait);
  state_.parameters[parameter::kInput] = reading.reached ? reading.value : kTimedOut;
}

}  // namespace kadr::gcode
