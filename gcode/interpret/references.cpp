#include <fmt/format.h>

#include <utility>

#include "gcode/constants.h"
#include "gcode/interpret/interpreter.h"

namespace kadr::gcode {
namespace {

constexpr std::uint32_t kAllAxes = (1U << kProgramAxes) - 1;
constexpr std::uint32_t kXYAxes = 3;

}  // namespace

void Interpreter::nonmodal() {
  switch (words_.g(GGroup::nonmodal)) {
    case code::g10:
      set_offsets();
      break;
    case code::g28:
      go_to_reference(parameter::kG28);
      break;
    case code::g28_1:
      write_axis_parameters(state_, parameter::kG28, state_.position);
      break;
    case code::g30:
      go_to_reference(parameter::kG30);
      break;
    case code::g30_1:
      write_axis_parameters(state_, parameter::kG30, state_.position);
      break;
    case code::g52:
    case code::g92:
      set_g92(words_.g(GGroup::nonmodal) == code::g52);
      break;
    default:
      break;
  }
  set_g92_state();
}

void Interpreter::set_g92_state() {
  switch (words_.g(GGroup::g92_state)) {
    case code::g92_1:
      state_.g92_offset = {};
      write_axis_parameters(state_, parameter::kG92, {});
      state_.parameters[parameter::kG92Active] = 0;
      break;
    case code::g92_2:
      state_.g92_offset = {};
      state_.parameters[parameter::kG92Active] = 0;
      break;
    case code::g92_3:
      state_.g92_offset = read_axis_parameters(state_, parameter::kG92);
      state_.parameters[parameter::kG92Active] = 1;
      break;
    default:
      break;
  }
}

void Interpreter::go_to_reference(int parameters) {
  // first the point that the axis words name, then those axes (all, if none is named) on to the reference:
  // along the axes of the work system, which may be rotated
  const bool named = words_.has_axis();
  const AxisValues by = rules_.homes_directly ? state_.position : target();
  if (named && !silent_) advice_.way_to_reference(state_.position, by, action_span());
  move_to(by);
  if (!rules_.homes_directly) emit(action_span(), Traverse{make_move(state_.position)});
  AxisValues end = state_.position;
  const AxisValues reference = read_axis_parameters(state_, parameters);
  const bool turned = named && state_.rotation_deg != 0 && (words_.has('X') || words_.has('Y'));
  if (turned) end = state_.to_program(end);
  const AxisValues goal = turned ? state_.to_program(reference) : reference;
  for (int axis = 0; axis < kProgramAxes; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const bool exists = (axes_on_machine_ & letter_bit(kAxisLetters[a])) != 0;
    if (!exists || (named && !words_.has(kAxisLetters[a]))) continue;
    end[a] = goal[a];
    state_.uncertain.axes &= ~(1U << axis);
  }
  state_.position = turned ? state_.to_machine(end) : end;
  emit(action_span(), Traverse{make_move(state_.position)});
}

void Interpreter::set_offsets() {
  int l = 0;
  near_integer(words_.value('L'), l);
  if (l == 2 || l == 20) return set_work_offset();
  // L0 reads the table again, in which G10 has changed nothing that the file does not have
  if (l != 0) set_tool_table();
}

void Interpreter::set_work_offset() {
  int system = 0, l = 0;
  near_integer(words_.value('P'), system);
  near_integer(words_.value('L'), l);
  if (system == 0) system = state_.work_system;
  if (words_.has('R')) {
    state_.parameters[static_cast<std::size_t>(work_rotation_parameter(system))] = words_.value('R');
    if (system == state_.work_system) turn_under_g92(words_.value('R'));
  }
  AxisValues zero = state_.work_zero(system);
  if (l == 20) {
    zero = measured_work_offset(system);
  } else {
    for (int axis = 0; axis < kProgramAxes; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      if (!words_.has(kAxisLetters[a])) continue;
      zero[a] = state_.to_base_units(axis, words_.value(kAxisLetters[a]));
    }
  }
  state_.set_work_zero(system, zero);
  if (system == state_.work_system) state_.use_work_system(system);
}

void Interpreter::turn_under_g92(double rotation_deg) {
  // RS-274/NGC ignores G92 when it converts the current point to the turned system:
  //   program' = R'^-1 R program   instead of   R'^-1 R (program + g92) - g92
  // so it assumes the tool to be off by the turned difference until a move names both X and Y
  AxisValues g92{};
  g92[kX] = state_.g92_offset[kX];
  g92[kY] = state_.g92_offset[kY];
  if ((g92[kX] == 0 && g92[kY] == 0) || rotation_deg == state_.rotation_deg) return;
  const AxisValues turned_before = state_.rotated(g92);
  State after = state_;
  after.set_rotation(rotation_deg);
  const AxisValues turned_after = after.rotated(g92);
  const double dx = turned_after[kX] - turned_before[kX], dy = turned_after[kY] - turned_before[kY];
  state_.position[kX] += dx;
  state_.position[kY] += dy;
  if (silent_) return;
  Diagnostic d = problem(Code::rotation_under_g92, words_.span(*line_, 'R'),
                         fmt::format("the controller assumes X and Y {} and {} mm off where the tool is",
                                     figure(dx), figure(dy)),
                         "cancel G92 and G52 first (G92.1), or name both X and Y in the next move");
  report_.warning(std::move(d));
}

AxisValues Interpreter::measured_work_offset(int system) {
  // the offset with which the current point reads the values of the axis words in that system; an axis that
  // is not named keeps the value that it reads there
  const int in_force = state_.work_system;
  state_.use_work_system(system);
  AxisValues program = state_.to_program(state_.position);
  AxisValues offset = state_.work_offset;
  std::uint32_t changed = 0;
  for (int axis = 0; axis < kProgramAxes; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (!words_.has(kAxisLetters[a])) continue;
    program[a] = state_.to_base_units(axis, words_.value(kAxisLetters[a]));
    changed |= 1U << axis;
  }
  // under a rotation X and Y of the offset depend on both words
  if (state_.rotation_deg != 0 && (changed & kXYAxes) != 0) changed |= kXYAxes;
  const AxisValues there = state_.to_machine(program);
  for (std::size_t a = 0; a < kProgramAxes; ++a) {
    if ((changed >> a & 1U) != 0) offset[a] += state_.position[a] - there[a];
  }
  state_.use_work_system(in_force);
  return offset;
}

void Interpreter::set_g92(bool local) {
  // G92: the current point is here; G52: the zero point is there
  const AxisValues here = state_.to_program(state_.position);
  for (int axis = 0; axis < kProgramAxes; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (!words_.has(kAxisLetters[a])) continue;
    const double value = state_.to_base_units(axis, words_.value(kAxisLetters[a]));
    state_.g92_offset[a] = local ? value : state_.g92_offset[a] + here[a] - value;
  }
  write_axis_parameters(state_, parameter::kG92, state_.g92_offset);
  state_.parameters[parameter::kG92Active] = 1;
  // an offset measured from an unknown position is itself unknown
  if (!local && (state_.uncertain.axes & kAllAxes) != 0) state_.uncertain.axes = kAllAxes;
}

}  // namespace kadr::gcode
