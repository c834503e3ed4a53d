#include "gcode/interpret/state.h"

#include <algorithm>
#include <cmath>

#include "gcode/constants.h"
#include "machine/base/numbers.h"

namespace kadr::gcode {
namespace {

constexpr double kQuarterTurn_deg = 90;

}  // namespace

AxisValues State::to_machine(const AxisValues& program) const {
  AxisValues at;
  for (std::size_t a = 0; a < kProgramAxes; ++a) at[a] = program[a] + g92_offset[a];
  at = rotated(at);
  for (std::size_t a = 0; a < kProgramAxes; ++a) at[a] += work_offset[a] + tool_offset[a];
  return at;
}

AxisValues State::to_program(const AxisValues& machine) const {
  AxisValues at;
  for (std::size_t a = 0; a < kProgramAxes; ++a) at[a] = machine[a] - work_offset[a] - tool_offset[a];
  at = rotated_back(at);
  for (std::size_t a = 0; a < kProgramAxes; ++a) at[a] -= g92_offset[a];
  return at;
}

AxisValues State::tool_point() const {
  AxisValues at = position;
  for (std::size_t a = 0; a < kProgramAxes; ++a) at[a] += tool_shift[a];
  return at;
}

AxisValues State::rotated(AxisValues vector) const {
  if (rotation_deg == 0) return vector;
  const double x = vector[0], y = vector[1];
  vector[0] = x * rotation_cos - y * rotation_sin;
  vector[1] = x * rotation_sin + y * rotation_cos;
  return vector;
}

AxisValues State::rotated_back(AxisValues vector) const {
  if (rotation_deg == 0) return vector;
  const double x = vector[0], y = vector[1];
  vector[0] = x * rotation_cos + y * rotation_sin;
  vector[1] = y * rotation_cos - x * rotation_sin;
  return vector;
}

void State::set_rotation(double degrees) {
  rotation_deg = degrees;
  // quarter turns are exact
  const double quarters = degrees / kQuarterTurn_deg;
  const double whole = std::floor(quarters + 0.5);
  if (quarters == whole) {
    static constexpr double kCosines[] = {1, 0, -1, 0};
    const auto turn = static_cast<std::size_t>(whole - 4 * std::floor(whole / 4));
    rotation_cos = kCosines[turn];
    rotation_sin = kCosines[(turn + 3) % 4];
    return;
  }
  const SinCos turned = exact_sincos(std::fmod(degrees, kFullTurn_deg) * kRadiansPerDegree);
  rotation_cos = turned.cos;
  rotation_sin = turned.sin;
}

void State::use_work_system(int system) {
  work_system = system;
  work_offset = work_zero(system);
  const bool further = system > kWorkSystems;
  set_rotation(further ? 0 : parameters[static_cast<std::size_t>(work_rotation_parameter(system))]);
}

AxisValues State::work_zero(int system) const {
  if (system <= kWorkSystems) return read_axis_parameters(*this, work_offset_parameter(system));
  const auto at = static_cast<std::size_t>(system - kWorkSystems - 1);
  return at < further_offsets.size() ? further_offsets[at] : AxisValues{};
}

void State::set_work_zero(int system, const AxisValues& zero) {
  if (system <= kWorkSystems) return write_axis_parameters(*this, work_offset_parameter(system), zero);
  const auto at = static_cast<std::size_t>(system - kWorkSystems - 1);
  if (further_offsets.size() <= at) further_offsets.resize(at + 1);
  further_offsets[at] = zero;
}

int motion_code(const State& state) {
  switch (state.motion) {
    case Motion::none:
      return code::g80;
    case Motion::traverse:
      return code::g0;
    case Motion::feed:
      return code::g1;
    case Motion::arc_clockwise:
      return code::g2;
    case Motion::arc_counterclockwise:
      return code::g3;
    case Motion::cubic_spline:
      return code::g5;
    case Motion::quadratic_spline:
      return code::g5_1;
    case Motion::nurbs:
      return code::g5_2;
    case Motion::thread:
      return code::g33;
    case Motion::rigid_tap:
      return code::g33_1;
    case Motion::thread_cycle:
      return code::g76;
    case Motion::probe:
      return state.probe_code;
    case Motion::cycle:
      return state.cycle.code;
  }
  return code::g80;
}

namespace {

/// Parameters 5400 to 5413, in mm and degrees.
double tool_parameter(const State& state, int index) {
  if (index == parameter::kToolNumber) return state.tool_in_spindle;
  const Tool* tool = state.find_tool(0);
  if (tool == nullptr) return 0;
  switch (index) {
    case parameter::kToolDiameter:
      return tool->diameter_mm;
    case parameter::kToolFrontAngle:
      return tool->front_angle_deg;
    case parameter::kToolBackAngle:
      return tool->back_angle_deg;
    case parameter::kToolOrientation:
      return tool->orientation;
    default:
      return tool->offset[static_cast<std::size_t>(index - parameter::kToolOffset)];
  }
}

}  // namespace

double read_parameter(const State& state, int index) {
  if (parameter::is_read_only(index)) {
    if (index == parameter::kWorkSystem) return state.work_system;
    if (index <= parameter::kMachineLast) {
      const int axis = index - parameter::kMachine;
      return state.to_program_units(axis, state.tool_point()[static_cast<std::size_t>(axis)]);
    }
    if (index <= parameter::kAppliedLast) {
      const int axis = index - parameter::kApplied;
      return state.to_program_units(axis, state.tool_offset[static_cast<std::size_t>(axis)]);
    }
    if (index <= parameter::kToolLast) return tool_parameter(state, index);
    return state.program_position(index - parameter::kPosition);
  }
  return state.parameters[static_cast<std::size_t>(index)];
}

const double* find_named(const State& state, std::int32_t name) {
  const auto at = static_cast<std::size_t>(name);
  if (is_global(state.names[name])) {
    return at < state.global_named.size() && state.global_named_set[at] ? &state.global_named[at] : nullptr;
  }
  const auto& named = state.levels.back().named;
  const auto it = named.find(name);
  return it == named.end() ? nullptr : &it->second;
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
  state.levels.back().named.insert_or_assign(name, value);
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
