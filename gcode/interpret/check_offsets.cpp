#include <fmt/format.h>

#include <algorithm>

#include "gcode/constants.h"
#include "gcode/interpret/interpreter.h"

/// Checks whether these words of tools and offsets fit together and name existing tools.
namespace kadr::gcode {
namespace {

constexpr std::size_t kToolsListed = 12;  // of a table, in a message

std::string listed(const ToolTable& table) {
  if (table.tools.empty()) return "the tool table is empty";
  std::string list = "tools of the table:";
  for (std::size_t i = 0; i < std::min(table.tools.size(), kToolsListed); ++i)
    list += fmt::format("{} {}", i == 0 ? "" : ",", table.tools[i].number);
  if (table.tools.size() > kToolsListed)
    list += fmt::format(" and {} more", table.tools.size() - kToolsListed);
  return list;
}

}  // namespace

void Interpreter::check_axis_words() {
  const int nonmodal_code = words_.g(GGroup::nonmodal);
  const int motion_code = words_.g(GGroup::motion);
  const int tool_code = words_.g(GGroup::tool_length);
  const bool names_motion = motion_code != kNoCode && motion_code != code::g80;
  const bool nonmodal_takes = takes_axis_words(nonmodal_code);
  const bool tool_takes = tool_code == code::g43_1 || (tool_code == code::g43_2 && !words_.has('H'));
  if (nonmodal_takes && names_motion && !motion_sets_mode()) {
    error(
        problem(Code::axis_words_wanted_twice, g_span(GGroup::nonmodal),
                fmt::format("{} and {} both use the axis words", g_name(nonmodal_code), g_name(motion_code)),
                "write them on two lines"));
  } else if (tool_takes && words_.has_axis() && (nonmodal_takes || names_motion)) {
    report_.warning(problem(Code::axis_words_shared, g_span(GGroup::tool_length),
                            fmt::format("{} and {} both read the axis words of this line", g_name(tool_code),
                                        g_name(nonmodal_takes ? nonmodal_code : motion_code)),
                            "write them on two lines"));
  }
  if ((nonmodal_code == code::g92 || nonmodal_code == code::g52) && !words_.has_axis()) {
    error(problem(Code::word_missing, g_span(GGroup::nonmodal),
                  fmt::format("{} needs at least one axis word", g_name(nonmodal_code))));
  }
}

bool Interpreter::check_tool(char letter, double least) {
  if (!words_.has(letter)) return true;
  if (!check_whole(letter, least, kLargestTool)) return false;
  int number = 0;
  near_integer(words_.value(letter), number);
  // without a table every number is a tool, and values that depend on an earlier mistake are not checked
  const bool doubtful = (words_.doubtful & letter_bit(letter)) != 0;
  if (number == 0 || !options_.tools || doubtful || state_.tools.find(number) != nullptr) return true;
  Diagnostic d =
      problem(Code::tool_unknown, words_.span(*line_, letter), fmt::format("there is no tool {}", number));
  d.notes.push_back(listed(state_.tools));
  return error(std::move(d));
}

void Interpreter::check_tools() {
  check_tool('T', 0);
  const int length = words_.g(GGroup::tool_length);
  if (length == code::g43 || length == code::g43_2) check_tool('H', 0);
  if (length == code::g43_2 && words_.has('H') == words_.has_axis()) {
    error(problem(Code::tool_offset_unclear, g_span(GGroup::tool_length),
                  words_.has_axis() ? "both a tool (H) and axis words say what to add"
                                    : "neither a tool (H) nor an axis word says what to add"));
  }
  if (words_.m(MGroup::tool_change) == code::m61 && !words_.has('Q')) {
    error(problem(Code::word_missing, words_.span(*line_, MGroup::tool_change),
                  "M61 needs Q: the number of the tool in the spindle"));
  } else if (words_.m(MGroup::tool_change) == code::m61) {
    check_tool('Q', 0);
  }
}

void Interpreter::check_g10() {
  if (!require_word('L', GGroup::nonmodal, "0, 1, 2, 10, 11 or 20")) return;
  int l = -1;
  near_integer(words_.value('L'), l);
  switch (l) {
    case 0:
      if (state_.tool_in_spindle == 0) return;
      error(problem(Code::tool_table_busy, g_span(GGroup::nonmodal),
                    fmt::format("tool {} is in the spindle", state_.tool_in_spindle),
                    "put it away first: T0 M6"));
      return;
    case 1:
    case 10:
    case 11:
      return check_g10_tool(l);
    case 2:
    case 20:
      return check_g10_work_offset(l);
    default:
      error(problem(Code::word_out_of_range, words_.span(*line_, 'L'),
                    fmt::format("L is {}, allowed: 0, 1, 2, 10, 11 and 20", figure(words_.value('L')))));
  }
}

void Interpreter::check_g10_tool(int l) {
  if (!require_word('P', GGroup::nonmodal, "the number of the tool")) return;
  check_tool('P', 1);
  check_whole('Q', 0, kLargestOrientation);
  if ((words_.present & (kAxisBits | letter_bits("RIJQ"))) != 0) return;
  error(problem(Code::word_missing, g_span(GGroup::nonmodal),
                fmt::format("G10 L{} without axis words, R, I, J or Q would change nothing", l)));
}

void Interpreter::check_g10_work_offset(int l) {
  if (!require_word('P', GGroup::nonmodal, "the work system, 0 to 9")) return;
  check_whole('P', 0, kWorkSystems + rules_.further_systems);
  for (const char letter : {'I', 'J', 'R'}) {
    if (!words_.has(letter) || (letter == 'R' && l == 2)) continue;
    error(problem(Code::word_unused, words_.span(*line_, letter),
                  fmt::format("G10 L{} does not read {}", l, letter)));
  }
  if (!words_.has('Q')) return;
  report_.warning(problem(Code::word_unused, words_.span(*line_, 'Q'),
                          fmt::format("G10 L{} does not read Q: it has no effect", l)));
}

}  // namespace kadr::gcode
