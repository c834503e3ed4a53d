#include "gcode/interpreter.h"

namespace kadr::gcode {
namespace {

constexpr std::uint32_t kAllAxes = (1U << kProgramAxes) - 1;

}  // namespace

void Interpreter::nonmodal() {
  switch (words_.g(GGroup::nonmodal)) {
    case 100:
      set_work_offset();
      break;
    case 280:
      go_to_reference(parameter::kG28);
      break;
    case 281:
      write_axis_parameters(state_, parameter::kG28, state_.position);
      break;
    case 300:
      go_to_reference(parameter::kG30);
      break;
    case 301:
      write_axis_parameters(state_, parameter::kG30, state_.position);
      break;
    case 520:
      set_local_offset();
      break;
    case 920:
      set_g92();
      break;
    case 921:
      state_.g92_offset = {};
      write_axis_parameters(state_, parameter::kG92, {});
      state_.parameters[parameter::kG92Active] = 0;
      break;
    case 922:
      state_.g92_offset = {};
      state_.parameters[parameter::kG92Active] = 0;
      break;
    case 923:
      state_.g92_offset = read_axis_parameters(state_, parameter::kG92);
      state_.parameters[parameter::kG92Active] = 1;
      break;
    default:
      break;
  }
}

void Interpreter::go_to_reference(int parameters) {
  // first the point that the axis words name, then those axes (all, if none is named) on to the reference
  Block block = make_block(BlockKind::traverse, action_span());
  const bool named = words_.has_axis();
  const AxisValues by = target();
  if (named && !silent_) advice_.way_to_reference(state_.position, by, action_span());
  move_to(by);
  block.end = state_.position;
  emit(block);
  const AxisValues reference = read_axis_parameters(state_, parameters);
  for (int axis = 0; axis < kProgramAxes; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const bool exists = (axes_on_machine_ & letter_bit(kAxisLetters[a])) != 0;
    if (!exists || (named && !words_.has(kAxisLetters[a]))) continue;
    state_.position[a] = reference[a];
    state_.uncertain.axes &= ~(1U << axis);
  }
  block.end = state_.position;
  emit(block);
}

void Interpreter::set_work_offset() {
  int system = 0;
  near_integer(words_.value('P'), system);
  if (system == 0) system = state_.work_system;
  const int first = parameter::kWorkOffset + (system - 1) * parameter::kWorkOffsetStride;
  AxisValues offset = read_axis_parameters(state_, first);
  const AxisValues here = state_.to_program(state_.position);
  for (int axis = 0; axis < kProgramAxes; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (!words_.has(kAxisLetters[a])) continue;
    const double value = state_.to_base_units(axis, words_.value(kAxisLetters[a]));
    offset[a] = words_.value('L') == 20 ? state_.work_offset[a] + here[a] - value : value;
  }
  write_axis_parameters(state_, first, offset);
  if (system == state_.work_system) refresh_offsets();
}

void Interpreter::set_local_offset() {}

void Interpreter::set_g92() {
  const AxisValues here = state_.to_program(state_.position);
  for (int axis = 0; axis < kProgramAxes; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (!words_.has(kAxisLetters[a])) continue;
    const double value = state_.to_base_units(axis, words_.value(kAxisLetters[a]));
    state_.g92_offset[a] += here[a] - value;
  }
  write_axis_parameters(state_, parameter::kG92, state_.g92_offset);
  state_.parameters[parameter::kG92Active] = 1;
  // an offset measured from an unknown position is itself unknown
  if ((state_.uncertain.axes & kAllAxes) != 0) state_.uncertain.axes = kAllAxes;
}

void Interpreter::refresh_offsets() {
  state_.work_offset = read_axis_parameters(
      state_, parameter::kWorkOffset + (state_.work_system - 1) * parameter::kWorkOffsetStride);
}

}  // namespace kadr::gcode
