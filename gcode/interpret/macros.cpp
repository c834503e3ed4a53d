#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "gcode/interpret/interpreter.h"
#include "gcode/interpret/macro_variables.h"
#include "gcode/interpret/message.h"

/// Macro B: settings of variables, G65 and G66. How the variables read: macro_variables.cpp.
namespace kadr::gcode {
namespace {

constexpr double kLargestMacroCall = 1e9;
constexpr double kLargestArgument = 1e9;

struct ArgumentLetter {
  char letter;
  int variable;
};
constexpr ArgumentLetter kArguments[] = {{'A', 1},  {'B', 2},  {'C', 3},  {'D', 7},  {'E', 8},  {'F', 9},
                                         {'H', 11}, {'M', 13}, {'Q', 17}, {'R', 18}, {'S', 19}, {'T', 20},
                                         {'U', 21}, {'V', 22}, {'W', 23}, {'X', 24}, {'Y', 25}, {'Z', 26}};
constexpr int kFirstOfSets = 4;  // I of the first set; J and K follow
constexpr int kSetSize = 3;
constexpr int kMostSets = 10;

}  // namespace

void Interpreter::assign(const Line& line) {
  line_ = &line;
  started_ = worded_ = true;
  for (const Item& item : line.items) {
    if (item.kind != ItemKind::setting) continue;
    double value = 0, index = 0;
    const bool known = evaluator_.evaluate(line, item.first, item.target, state_, &report_, index) &&
                       evaluator_.evaluate(line, item.target + 1, item.value, state_, &report_, value);
    int number = 0;
    if (known && index >= 0 && index <= macro_variable::kLast) {
      number = static_cast<int>(index);
      if (number == index && is_macro_variable(number)) {
        state_.parameters[static_cast<std::size_t>(number)] = value;
        continue;
      }
    }
    const Span place = line.span({item.bytes.begin, item.equals});
    if (known && near_integer(index, number) && number >= 0) {
      set_macro_variable(number, value, place);
    } else if (known) {
      error(problem(Code::parameter_range, place, "no number of a variable"));
    }
    if (!known) state_.uncertain.parameters = true;
    if (ended_) return;
  }
}

void Interpreter::set_macro_variable(int number, double value, Span place) {
  using namespace macro_variable;
  if (is_macro_variable(number)) {
    state_.parameters[static_cast<std::size_t>(number)] = value;
    return;
  }
  const double amount = is_vacant(value) ? 0 : value;
  if (number == kAlarm || number == kStop) return stop_with_message(amount, place, number == kAlarm);
  if (number == kSingleBlock || number == kHoldAndOverride) {
    return report_.warning(problem(
        Code::word_without_effect, place,
        fmt::format("#{} changes nothing here: single block, hold and override act as ever", number)));
  }
  if (number >= kOutput && number <= kOutputLast)
    return emit(place, DigitalOutput{number - kOutput, amount != 0, false});
  if (set_tool_variable(number, amount, place)) return;
  if (const std::optional<WorkOffsetVariable> offset = work_offset_variable_of(number)) {
    state_.parameters[static_cast<std::size_t>(number)] = state_.to_base_units(offset->axis, amount);
    if (offset->system == state_.work_system && state_.compensating()) {
      error(
          problem(Code::compensation_conflict, place,
                  fmt::format("#{} moves the zero point in force while cutter compensation is on", number)));
      return;
    }
    // in force from the next line on
    if (offset->system == state_.work_system) state_.use_work_system(offset->system);
    return;
  }
  refuse_variable(number, place);
}

void Interpreter::refuse_variable(int number, Span place) {
  if (number == 0 || read_system_variable(state_, number)) {
    error(problem(
        Code::parameter_read_only, place,
        number == 0 ? "#0 is always vacant" : fmt::format("#{} tells the state of the controller", number)));
  } else {
    error(problem(Code::system_variable, place, system_variable_text(number)));
  }
}

/// #2001=: the length of a tool in the table. In force with the next G43.
bool Interpreter::set_tool_variable(int number, double value, Span place) {
  const std::optional<ToolVariable> variable = tool_variable_of(state_.macros, number);
  if (!variable) return false;
  Tool* tool = state_.tools.find(variable->tool);
  if (tool == nullptr && options_.tools) {
    error(problem(Code::tool_unknown, place, fmt::format("T{} is not in the tool table", variable->tool)));
    return true;
  }
  if (tool == nullptr) {
    // without a table every tool may be created
    state_.tools.tools.push_back({});
    tool = &state_.tools.tools.back();
    tool->number = tool->pocket = variable->tool;
  }
  (variable->diameter ? tool->diameter_mm : tool->offset[kZ]) = value * state_.length_factor();
  return true;
}

/// The text of the first comment on the line.
std::string Interpreter::remark_of_line() const {
  for (const Item& item : line_->items) {
    if (item.kind != ItemKind::comment) continue;
    std::string_view text = line_->slice(item.bytes);
    text.remove_prefix(1);
    text.remove_suffix(1);
    return valid_text(text);
  }
  return {};
}

/// #3000=1 (text) and #3006=1 (text).
void Interpreter::stop_with_message(double value, Span place, bool alarm) {
  std::string text = remark_of_line();
  if (alarm) {
    return abort_program(fmt::format("alarm {}{}{}", value, text.empty() ? "" : ", ", text), place);
  }
  if (!text.empty()) {
    if (!message_allowed(place, text.size())) return;
    emit(place, Message{std::move(text)});
  }
  emit(place, ProgramStop{});
}

void Interpreter::macro_call(const Line& line) {
  line_ = &line;
  started_ = worded_ = true;
  CallRequest request;
  request.macro = true;
  request.number = -1;
  request.arguments.assign(kMacroLocals, kVacant);
  const std::size_t errors = report_.errors();
  if (!macro_words(line, request) || report_.errors() > errors) return lose_track();
  if (request.number < 0) {
    error(problem(Code::word_missing, request.place,
                  fmt::format("{} needs P: the number of the macro", line.slice(line.items.front().bytes))));
    return lose_track();
  }
  if (line.macro_call == MacroCall::once) {
    call_ = std::move(request);
    return;
  }
  modal_call_ = std::move(request);
  modal_level_ = state_.levels.size();
}

/// Reads the words of G65 or G66: P, L and arguments.
bool Interpreter::macro_words(const Line& line, CallRequest& request) {
  int set = -1;
  for (const Item& item : line.items) {
    if (item.kind == ItemKind::setting) {
      error(problem(Code::macro_argument, line.span(item.bytes), "a setting on the line of a macro call"));
      continue;
    }
    if (item.kind != ItemKind::word || item.letter == 'N') continue;
    const Span place = line.span(item.bytes);
    double value = item.number;
    if (item.value >= 0 && !evaluator_.evaluate(line, item.first, item.value, state_, &report_, value))
      return false;
    if (item.value >= 0 && evaluator_.doubtful()) return false;
    const bool call = item.letter == 'G' && item.value < 0 && (item.number == 65 || item.number == 66);
    if (call && request.place.line == 0) {
      request.place = place;
    } else if (item.letter == 'P' || item.letter == 'L') {
      int whole = 0;
      if (is_vacant(value)) continue;
      if (!near_integer(value, whole) || whole < 0 || whole > kLargestMacroCall) {
        error(problem(Code::word_not_whole, place, fmt::format("{} is {}", item.letter, figure(value))));
      } else if (item.letter == 'P') {
        request.number = whole;
      } else {
        request.repeats = static_cast<std::uint64_t>(whole);
      }
    } else if (!macro_argument(line, item, value, set, request)) {
      error(problem(Code::macro_argument, place, fmt::format("{} is no argument", item.letter)));
    }
  }
  return true;
}

/// I, J and K count in sets: each one that does not come behind the one before begins the next set.
/// @param set  3 · (number of the set) + place in the set of the last I, J or K; -1: none
bool Interpreter::macro_argument(const Line& line, const Item& item, double value, int& set,
                                 CallRequest& request) {
  if (!is_vacant(value) && !(std::fabs(value) <= kLargestArgument)) {
    error(problem(Code::value_too_large, line.span(item.bytes),
                  fmt::format("{} is {:.6g}", item.letter, value)));
    return true;
  }
  int variable = 0;
  if (item.letter >= 'I' && item.letter <= 'K') {
    const int place = item.letter - 'I';
    const int next =
        set < 0 ? place : set - set % kSetSize + place + (place <= set % kSetSize ? kSetSize : 0);
    if (next >= kSetSize * kMostSets) return false;
    set = next;
    variable = kFirstOfSets + set;
  } else {
    const auto known = std::find_if(std::begin(kArguments), std::end(kArguments),
                                    [&](const ArgumentLetter& a) { return a.letter == item.letter; });
    if (known == std::end(kArguments)) return false;
    variable = known->variable;
  }
  request.arguments[static_cast<std::size_t>(variable) - 1] = value;
  return true;
}

std::optional<CallRequest> Interpreter::modal_call_due() {
  if (!modal_call_ || call_ || ended_ || state_.levels.size() != modal_level_) return std::nullopt;
  const bool moved = words_.any && !words_.percent && words_.has_axis() && moves() && !axis_words_taken();
  return moved ? modal_call_ : std::nullopt;
}

}  // namespace kadr::gcode
