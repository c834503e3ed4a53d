#include <fmt/format.h>

#include "gcode/constants.h"
#include "gcode/interpret/interpreter.h"

/// Tools: T, M6, M61, G43 G43.1 G43.2 G49, and G10 L1 L10 L11, which write the tool table.
namespace kadr::gcode {
namespace {

/// "tools 1, 2, 5"
std::string listed(const std::set<int>& tools) {
  constexpr std::size_t kMost = 20;
  std::string list = tools.size() == 1 ? "tool" : "tools";
  std::size_t count = 0;
  for (const int tool : tools) {
    if (count == kMost) return list + fmt::format(" and {} more", tools.size() - kMost);
    list += fmt::format("{} {}", count++ == 0 ? "" : ",", tool);
  }
  return list;
}

}  // namespace

void Interpreter::select_tool() {
  if (!words_.has('T')) return;
  near_integer(words_.value('T'), state_.tool_selected);
  emit(words_.span(*line_, 'T'), SelectTool{state_.tool_selected});
}

void Interpreter::change_tool() {
  const int code = words_.m(MGroup::tool_change);
  if (code == kNoCode) return;
  const Span span = words_.span(*line_, MGroup::tool_change);
  if (code == code::m61) {
    near_integer(words_.value('Q'), state_.tool_in_spindle);
    return emit(span, SetToolNumber{state_.tool_in_spindle});
  }
  turn_spindle(Turning::stopped, span);
  state_.tool_in_spindle = state_.tool_selected;
  take_real_position();
  emit(span, ChangeTool{state_.tool_in_spindle});
}

/// At a tool change the controller asks the machine for its position: off the contour if no move came since
/// G40, and where a tap outside G17 has led it.
void Interpreter::take_real_position() {
  if (state_.compensating()) return;
  if (compensation_.active()) {
    state_.position = compensation_.last_end();
    compensation_.leave();
  } else if (tapped_at_ && *tapped_at_ == state_.position) {
    state_.position = last_move_end_;
  }
}

void Interpreter::tool_length() {
  const int code = words_.g(GGroup::tool_length);
  if (code == kNoCode) return;
  advice_.length_named();
  // G43 takes the tool's offset, G43.2 adds it; axis words replace under G43.1, add under G43.2
  if (code == code::g43 || code == code::g49) state_.tool_offset = {};
  const bool by_number = words_.has('H');
  if (code == code::g43 || (code == code::g43_2 && by_number)) {
    int number = 0;
    if (by_number) near_integer(words_.value('H'), number);
    if (const Tool* tool = length_of_tool(number)) {
      for (std::size_t a = 0; a < kProgramAxes; ++a) state_.tool_offset[a] += tool->offset[a];
    }
    return;
  }
  for (int axis = 0; axis < kProgramAxes; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (code == code::g49 || !words_.has(kAxisLetters[a])) continue;
    const double value = state_.to_base_units(axis, words_.value(kAxisLetters[a]));
    state_.tool_offset[a] = code == code::g43_1 ? value : state_.tool_offset[a] + value;
  }
}

const Tool* Interpreter::length_of_tool(int number) {
  const Tool* tool = state_.find_tool(number);
  const int wanted = number == 0 ? state_.tool_in_spindle : number;
  if (tool != nullptr || wanted == 0 || silent_) return tool;
  // check() has refused tools that a table does not have
  Diagnostic d = problem(
      Code::tool_length_unknown, words_.has('H') ? words_.span(*line_, 'H') : g_span(GGroup::tool_length),
      fmt::format("length of tool {} taken as 0", wanted),
      "name a tool table, --tools TABLE.tbl, or give the length itself: G43.1 Z and the length");
  d.notes.emplace_back("no tool table has been given; positions are those of a tool without length");
  unknown_lengths_.insert(wanted);
  report_.repeated_warning(std::move(d), static_cast<double>(unknown_lengths_.size()),
                           listed(unknown_lengths_));
  return nullptr;
}

void Interpreter::set_tool_table() {
  int number = 0, l = 0;
  near_integer(words_.value('P'), number);
  near_integer(words_.value('L'), l);
  Tool* tool = state_.tools.find(number);
  if (tool == nullptr) {
    // without a table every tool may be created
    state_.tools.tools.push_back({});
    tool = &state_.tools.tools.back();
    tool->number = tool->pocket = number;
  }
  if (l == 1) {
    for (int axis = 0; axis < kProgramAxes; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      if (words_.has(kAxisLetters[a]))
        tool->offset[a] = state_.to_base_units(axis, words_.value(kAxisLetters[a]));
    }
  } else {
    tool->offset = measured_tool_offset(tool->offset, l == 11);
  }
  if (words_.has('R')) tool->diameter_mm = 2 * words_.value('R') * state_.length_factor();
  if (words_.has('I')) tool->front_angle_deg = words_.value('I');
  if (words_.has('J')) tool->back_angle_deg = words_.value('J');
  if (words_.has('Q')) near_integer(words_.value('Q'), tool->orientation);
}

AxisValues Interpreter::measured_tool_offset(AxisValues offset, bool in_fixture) const {
  // the offset with which the current point would read the values of the axis words, in the work system in
  // force, or in G59.3 without G92:
  //   tool = machine - work - R (program + g92)
  // X and Y mix under a rotation: of the two components in the work system only the named ones change
  constexpr int kFixtureSystem = 9;
  State frame = state_;
  if (in_fixture) {
    frame.use_work_system(kFixtureSystem);
    frame.g92_offset = {};
  }
  AxisValues vector;
  for (std::size_t a = 0; a < kProgramAxes; ++a) vector[a] = state_.position[a] - frame.work_offset[a];
  vector = frame.rotated_back(vector);
  AxisValues turned = frame.rotated_back(offset);
  for (int axis = 0; axis < kProgramAxes; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (!words_.has(kAxisLetters[a])) continue;
    const double value = state_.to_base_units(axis, words_.value(kAxisLetters[a]));
    turned[a] = vector[a] - frame.g92_offset[a] - value;
  }
  if (!words_.has('X') && !words_.has('Y')) {
    turned[kX] = offset[kX];
    turned[kY] = offset[kY];
    return turned;
  }
  return frame.rotated(turned);
}

}  // namespace kadr::gcode
