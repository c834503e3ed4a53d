#include "gcode/interpret/interpreter.h"
#include "gcode/interpret/macro_variables.h"

/// M62 to M65, M67, M68: outputs, with the next motion or at once. M66: a wait for an input. #1000 and on of macro B: inputs.
namespace kadr::gcode {
namespace {

constexpr double kTimedOut = -1;  // #5399 then

}  // namespace

void Interpreter::inputs_and_outputs() {
  const int code = words_.m(MGroup::inputs);
  if (code == kNoCode) return;
  if (code == code::m66) return wait_input();
  const Span span = words_.span(*line_, MGroup::inputs);
  const OutputCode& output = *output_code(code);
  int number = 0;
  near_integer(words_.value(output.analog ? 'E' : 'P'), number);
  if (output.analog) return emit(span, AnalogOutput{number, words_.value('Q'), output.with_motion});
  emit(span, DigitalOutput{number, output.on, output.with_motion});
}

void Interpreter::wait_input() {
  InputWait wait;
  wait.analog = words_.has('E');
  near_integer(words_.value(wait.analog ? 'E' : 'P'), wait.number);
  int mode = 0;
  if (words_.has('L')) near_integer(words_.value('L'), mode);
  wait.mode = kWaitModes.at(mode).value_or(WaitMode::immediate);
  if (wait.mode != WaitMode::immediate) wait.timeout_s = words_.value('Q');
  emit(words_.span(*line_, MGroup::inputs), wait);
  const InputReading reading = read_input(wait);
  state_.parameters[parameter::kInput] = reading.reached ? reading.value : kTimedOut;
}

/// Without a machine to ask, every input reads 0.
InputReading Interpreter::read_input(const InputWait& wait) const {
  return options_.read_input && !silent_ ? options_.read_input(wait) : InputReading{true, 0};
}

void Interpreter::read_inputs(const Line& line) {
  for (const ExpressionNode& node : line.nodes) {
    if (node.kind != NodeKind::parameter) continue;
    const ExpressionNode& index = line.nodes[static_cast<std::size_t>(node.left)];
    int variable = 0;
    if (index.kind != NodeKind::number || !is_input_variable(index.value) ||
        !near_integer(index.value, variable))
      continue;
    InputWait wait;
    wait.number = variable - macro_variable::kInput;
    emit(line.span(node.own), wait);
    state_.parameters[static_cast<std::size_t>(variable)] = read_input(wait).value;
  }
}

}  // namespace kadr::gcode
