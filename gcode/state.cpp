#include "gcode/state.h"

#include <algorithm>

namespace kadr::gcode {

AxisValues State::to_machine(const AxisValues& program) const {
  AxisValues at;
  for (std::size_t a = 0; a < kProgramAxes; ++a) at[a] = program[a] + g92_offset[a];
  if (rotation_deg != 0) {
    const double x = at[0], y = at[1];
    at[0] = x * rotation_cos - y * rotation_sin;
    at[1] = x * rotation_sin + y * rotation_cos;
  }
  for (std::size_t a = 0; a < kProgramAxes; ++a) at[a] += work_offset[a] + tool_offset[a];
  return at;
}

AxisValues State::to_program(const AxisValues& machine) const {
  AxisValues at;
  for (std::size_t a = 0; a < kProgramAxes; ++a) at[a] = machine[a] - work_offset[a] - tool_offset[a];
  if (rotation_deg != 0) {
    const double x = at[0], y = at[1];
    at[0] = x * rotation_cos + y * rotation_sin;
    at[1] = y * rotation_cos - x * rotation_sin;
  }
  for (std::size_t a = 0; a < kProgramAxes; ++a) at[a] -= g92_offset[a];
  return at;
}

double read_parameter(const State& state, int index) {
  if (index == parameter::kToolNumber) return state.tool_in_spindle;
  if (index == parameter::kWorkSystem) return state.work_system;
  const int tool_axis = index - parameter::kToolOffset;
  if (tool_axis >= 0 && tool_axis < kProgramAxes) {
    return state.to_program_units(tool_axis, state.tool_offset[static_cast<std::size_t>(tool_axis)]);
  }
  const int axis = index - parameter::kPosition;
  if (axis >= 0 && axis < kProgramAxes) return state.program_position(axis);
  return state.parameters[static_cast<std::size_t>(index)];
}

const double* find_named(const State& state, std::int32_t name) {
  const auto at = static_cast<std::size_t>(name);
  if (is_global(state.names[name])) {
    return at < state.global_named.size() && state.global_named_set[at] ? &state.global_named[at] : nullptr;
  }
  for (const auto& [number, value] : state.levels.back().named) {
    if (number == name) return &value;
  }
  return nullptr;
}

void set_named(State& state, std::int32_t name, double value) {
  const auto at = static_cast<std::size_t>(name);
  if (is_global(state.names[name])) {
    if (state.global_named.size() <= at) {
      state.global_named.resize(at + 1, 0.0);
      state.global_named_set.resize(at + 1, false);
    }
    state.global_named[at] = value;
    state.global_named_set[at] = true;
    return;
  }
  for (auto& [number, old] : state.levels.back().named) {
    if (number != name) continue;
    old = value;
    return;
  }
  state.levels.back().named.emplace_back(name, value);
}

AxisValues read_axis_parameters(const State& state, int first) {
  AxisValues values;
  std::copy_n(state.parameters.begin() + first, kProgramAxes, values.begin());
  return values;
}

void write_axis_parameters(State& state, int first, const AxisValues& values) {
  std::copy(values.begin(), values.end(), state.parameters.begin() + first);
}

}  // namespace kadr::gcode
