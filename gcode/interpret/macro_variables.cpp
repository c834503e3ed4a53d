#include "gcode/interpret/macro_variables.h"

#include <fmt/format.h>

#include <algorithm>

namespace kadr::gcode {
namespace {

constexpr int kAxesOfBlock = kProgramAxes;

/// Axis of a position variable that begins at `first`, -1 if the number is outside.
int axis_from(int number, int first) {
  return number >= first && number < first + kAxesOfBlock ? number - first : -1;
}

double length_of_axis(const State& state, int axis, const AxisValues& values) {
  return state.to_program_units(axis, values[static_cast<std::size_t>(axis)]);
}

std::optional<double> position_variable(const State& state, int number) {
  using namespace macro_variable;
  if (const int axis = axis_from(number, kBlockEnd); axis >= 0)
    return length_of_axis(state, axis, state.to_program(state.position));
  if (const int axis = axis_from(number, kMachinePosition); axis >= 0)
    return length_of_axis(state, axis, state.tool_point());
  if (const int axis = axis_from(number, kWorkPosition); axis >= 0) {
    // the tool's length is not taken off
    AxisValues at = state.to_program(state.tool_point());
    for (std::size_t a = 0; a < kProgramAxes; ++a) at[a] += state.tool_offset[a];
    return length_of_axis(state, axis, at);
  }
  if (axis_from(number, kSkipPosition) >= 0) return state.parameters[static_cast<std::size_t>(number)];
  if (const int axis = axis_from(number, kToolOffset); axis >= 0)
    return length_of_axis(state, axis, state.tool_offset);
  if (axis_from(number, kExternalOffset) >= 0) return 0;
  return std::nullopt;
}

/// G codes in force, by group, and the words last given.
std::optional<double> modal_variable(const State& state, int number) {
  constexpr double kTenths = 10;
  switch (number) {
    case 4001:
      if (state.motion == Motion::none || state.motion == Motion::cycle) return std::nullopt;
      return motion_code(state) / kTenths;
    case 4002:
      return plane_code(state.plane) / kTenths;
    case 4003:
      return state.incremental ? 91 : 90;
    case 4005:
      return state.feed_mode == FeedMode::inverse_time       ? 93
             : state.feed_mode == FeedMode::units_per_minute ? 94
                                                             : 95;
    case 4006:
      return state.inches ? 20 : 21;
    case 4007:
      return state.compensation_code / kTenths;
    case 4008:
      return std::any_of(state.tool_offset.begin(), state.tool_offset.end(), [](double o) { return o != 0; })
                 ? 43
                 : 49;
    case 4009:
      return state.motion == Motion::cycle ? motion_code(state) / kTenths : 80;
    case 4010:
      return state.retract_to_start ? 98 : 99;
    case 4013:
      return state.constant_surface_speed ? 96 : 97;
    case 4014:
      if (state.work_system > 6) return std::nullopt;
      return code::g54 / kTenths + state.work_system - 1;
    case 4109:
      return state.feed_number;
    case 4119:
      return state.spindle_rpm;
    case 4120:
      return state.tool_selected;
    default:
      return std::nullopt;
  }
}

std::optional<double> tool_variable(const State& state, int number) {
  const std::optional<ToolVariable> variable = tool_variable_of(state.macros, number);
  if (!variable) return std::nullopt;
  const Tool* tool = state.tools.find(variable->tool);
  if (tool == nullptr) return 0;
  constexpr std::size_t kZ = 2;
  return (variable->diameter ? tool->diameter_mm : tool->offset[kZ]) / state.length_factor();
}

}  // namespace

void clear_macro_variables(State& state) {
  for (int number = 1; number <= macro_variable::kLast; ++number)
    if (is_macro_variable(number)) state.parameters[static_cast<std::size_t>(number)] = kVacant;
}

std::optional<ToolVariable> tool_variable_of(const MacroRules& rules, int number) {
  constexpr int kLengths = 2001, kDiameters = 2401, kTools = 200;
  if (number >= kLengths && number < kLengths + kTools) return ToolVariable{number - kLengths + 1, false};
  if (rules.diameters_in_offsets && number >= kDiameters && number < kDiameters + kTools)
    return ToolVariable{number - kDiameters + 1, true};
  return std::nullopt;
}

std::optional<WorkOffsetVariable> work_offset_variable_of(int number) {
  constexpr int kSystems = 6;
  const int behind = number - parameter::kWorkOffset;
  if (behind < 0 || behind >= kSystems * parameter::kWorkOffsetStride) return std::nullopt;
  const int axis = behind % parameter::kWorkOffsetStride;
  if (axis >= kProgramAxes) return std::nullopt;
  return WorkOffsetVariable{behind / parameter::kWorkOffsetStride + 1, axis};
}

std::optional<double> read_system_variable(const State& state, int number) {
  if (number == 0) return kVacant;
  if (is_input_variable(number)) return state.parameters[static_cast<std::size_t>(number)];
  if (const std::optional<double> modal = modal_variable(state, number)) return modal;
  if (const std::optional<double> length = tool_variable(state, number)) return length;
  if (const std::optional<WorkOffsetVariable> offset = work_offset_variable_of(number))
    return state.to_program_units(offset->axis, state.parameters[static_cast<std::size_t>(number)]);
  return position_variable(state, number);
}

bool tells_position(int number) {
  return axis_from(number, macro_variable::kBlockEnd) >= 0 ||
         axis_from(number, macro_variable::kMachinePosition) >= 0 ||
         axis_from(number, macro_variable::kWorkPosition) >= 0;
}

std::string system_variable_text(int number) {
  struct Range {
    int first, last;
    const char* text;
  };
  constexpr Range kRanges[] = {
      {34, 99, "is no variable of this controller"},
      {200, 499, "is no variable of this controller"},
      {1032, 1063, "is an input of the machine's controller, which kadr does not have"},
      {1064, 1099, "is no variable of this controller"},
      {2201, 2999, "is a part of a tool's offset that kadr's table does not hold"},
      {3001, 3002, "is a timer: no time passes while kadr reads a program, and G4 waits"},
      {3011, 3012, "is the date or the time of day"},
      {4001, 4999, "is a modal state that kadr does not keep"},
      {7001, 7960, "is a further work offset"},
  };
  for (const Range& range : kRanges)
    if (number >= range.first && number <= range.last) return fmt::format("#{} {}", number, range.text);
  return fmt::format("kadr does not have #{}", number);
}

}  // namespace kadr::gcode
