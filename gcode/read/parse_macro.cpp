#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "gcode/interpret/words.h"
#include "gcode/read/parser.h"

/// Statements of macro B: IF, WHILE, GOTO, DO and END, at the beginning of a line.
namespace kadr::gcode {
namespace {

struct ControlName {
  std::string_view name;
  FlowWord word;  ///< IF is if_then and WHILE is while_do until what follows is read
};
constexpr std::array<ControlName, 5> kControls = {{
    {"IF", FlowWord::if_then},
    {"WHILE", FlowWord::while_do},
    {"GOTO", FlowWord::go_to},
    {"DO", FlowWord::do_loop},
    {"END", FlowWord::end_do},
}};
constexpr std::array<std::string_view, 9> kNotRun = {"ENDIF", "ELSE",  "THEN",  "DPRNT", "BPRNT",
                                                     "POPEN", "PCLOS", "SETVN", "CASE"};
constexpr double kLargestSequenceNumber = 99'999'999;
constexpr int kLoops = 3;

/// G65, G66 or G67 as a plain number.
MacroCall call_of(const Item& item) {
  if (item.kind != ItemKind::word || item.letter != 'G' || item.value >= 0) return MacroCall::none;
  if (item.number == 65) return MacroCall::once;
  if (item.number == 66) return MacroCall::modal;
  return item.number == 67 ? MacroCall::cancel : MacroCall::none;
}

bool is_input_number(const Line& line, std::int32_t node) {
  const ExpressionNode& number = line.nodes[static_cast<std::size_t>(node)];
  return number.kind == NodeKind::number && is_input_variable(number.value);
}

}  // namespace

/// Whether a statement begins at the letter at `begin`, and no word.
bool Parser::begins_control(std::uint32_t begin) const {
  const auto here = [&](std::string_view name) {
    Cursor cursor(line_->text, begin);
    Bytes bytes;
    return match(cursor, name, bytes);
  };
  return std::any_of(kControls.begin(), kControls.end(),
                     [&](const ControlName& c) { return here(c.name); }) ||
         std::any_of(kNotRun.begin(), kNotRun.end(), here);
}

bool Parser::parse_control(std::uint32_t begin) {
  cursor_.go_to(begin);
  Bytes bytes;
  for (const std::string_view name : kNotRun) {
    if (match(cursor_, name, bytes))
      return fail(Code::word_not_run, bytes, fmt::format("kadr does not run {} here", name));
  }
  if (!control_place(begin)) return false;
  line_->has_flow = true;
  FlowStatement& flow = line_->flow;
  flow = {};
  const auto nodes = static_cast<std::int32_t>(line_->nodes.size());
  const std::size_t before = line_->items.size();
  for (const ControlName& control : kControls) {
    if (!match(cursor_, control.name, flow.keyword)) continue;
    flow.word = control.word;
    break;
  }
  const bool good = flow.word == FlowWord::go_to ? parse_target(flow)
                    : flow.word == FlowWord::if_then || flow.word == FlowWord::while_do
                        ? parse_condition(flow) && parse_behind_condition(flow)
                        : parse_loop_number(flow);
  if (!good) {
    line_->items.resize(before);
    return false;
  }
  Item item;
  item.kind = ItemKind::control;
  item.bytes = {begin, cursor_.at()};
  item.first = nodes;
  line_->items.insert(line_->items.begin() + static_cast<std::ptrdiff_t>(before), item);
  return true;
}

/// Only N, / and comments may stand before a statement.
bool Parser::control_place(std::uint32_t begin) {
  for (const Item& item : line_->items) {
    const bool may_stand_before = (item.kind == ItemKind::word && item.letter == 'N') ||
                                  item.kind == ItemKind::block_delete || item.kind == ItemKind::comment ||
                                  item.kind == ItemKind::byte_order_mark;
    if (may_stand_before) continue;
    return fail(Code::macro_statement, {begin, begin + 1}, "the statement does not begin its line",
                "write it on a line of its own");
  }
  return true;
}

bool Parser::parse_condition(FlowStatement& flow) {
  flow.first = static_cast<std::int32_t>(line_->nodes.size());
  if (cursor_.peek() != '[') {
    return fail(Code::macro_statement, flow.keyword, "a condition in [ ] must follow",
                "write for example IF [#1 EQ 0] GOTO 20");
  }
  const std::int32_t root = expression().group();
  if (root < 0) return false;
  flow.arguments.push_back(root);
  return true;
}

bool Parser::parse_behind_condition(FlowStatement& flow) {
  if (flow.word == FlowWord::while_do) {
    if (match(cursor_, "DO", flow.second)) return parse_loop_number(flow);
    return fail(Code::macro_statement, flow.keyword, "no DO follows the condition",
                "write WHILE [condition] DO1, and END1 behind what is repeated");
  }
  if (match(cursor_, "GOTO", flow.second)) {
    flow.word = FlowWord::if_go_to;
    return parse_target(flow);
  }
  if (match(cursor_, "THEN", flow.second)) {
    if (!cursor_.at_end()) return true;
    return fail(Code::macro_statement, flow.second, "nothing follows THEN", "write THEN #1=0, or GOTO n");
  }
  return fail(Code::macro_statement, flow.keyword, "neither GOTO nor THEN follows the condition",
              "write IF [condition] GOTO n, or IF [condition] THEN #1=0");
}

/// n of GOTO n, or #1 or [expression].
bool Parser::parse_target(FlowStatement& flow) {
  if (!cursor_.begins_digit()) {
    flow.label_first = static_cast<std::int32_t>(line_->nodes.size());
    const char c = cursor_.peek();
    if (c != '#' && c != '[') {
      return fail(Code::macro_statement, flow.second.end > 0 ? flow.second : flow.keyword,
                  "GOTO needs a sequence number", "write GOTO 20, GOTO #1 or GOTO [#1+10]");
    }
    flow.label_root = expression().value();
    return flow.label_root >= 0;
  }
  double number = 0;
  const NumberResult result = cursor_.read_number(number, flow.label);
  if (result != NumberResult::good) {
    if (!muted_) report_.error(number_problem(*line_, result, flow.label, 0));
    return false;
  }
  if (number != std::floor(number) || number > kLargestSequenceNumber) {
    return fail(Code::macro_statement, flow.label, "a sequence number is a whole number",
                fmt::format("allowed: 0 to {:.0f}", kLargestSequenceNumber));
  }
  flow.number = static_cast<std::int32_t>(number);
  return true;
}

/// 1, 2 or 3 of DO and END.
bool Parser::parse_loop_number(FlowStatement& flow) {
  const Bytes keyword = flow.second.end > 0 ? flow.second : flow.keyword;
  const char c = cursor_.peek();
  Cursor ahead = cursor_;
  if (c >= '1' && c <= '0' + kLoops) ahead.advance();
  if (ahead.at() == cursor_.at() || ahead.begins_digit()) {
    return fail(Code::macro_statement, keyword, fmt::format("a number from 1 to {} must follow", kLoops),
                "write DO1 ... END1; loops inside each other have different numbers");
  }
  flow.label = {cursor_.at(), cursor_.at() + 1};
  flow.number = c - '0';
  cursor_ = ahead;
  return true;
}

/// What the whole line is: a macro call, or nothing but settings; and whether it reads inputs.
void Parser::note_macro_line() {
  bool settings = false;
  bool other = false;
  for (const Item& item : line_->items) {
    if (line_->macro_call == MacroCall::none) line_->macro_call = call_of(item);
    settings = settings || item.kind == ItemKind::setting;
    const bool passive =
        item.kind == ItemKind::setting || item.kind == ItemKind::control ||
        item.kind == ItemKind::block_delete || item.kind == ItemKind::byte_order_mark ||
        (item.kind == ItemKind::word && item.letter == 'N' && item.value < 0) ||
        (item.kind == ItemKind::comment && active_comment(line_->slice(item.bytes)).command.empty());
    other = other || !passive;
  }
  line_->only_settings = settings && !other;
  line_->reads_inputs =
      std::any_of(line_->nodes.begin(), line_->nodes.end(), [&](const ExpressionNode& node) {
        return node.kind == NodeKind::parameter && is_input_number(*line_, node.left);
      });
}

}  // namespace kadr::gcode
