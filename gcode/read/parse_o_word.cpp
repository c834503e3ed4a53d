#include <fmt/format.h>

#include <array>
#include <cmath>

#include "gcode/read/parser.h"

namespace kadr::gcode {
namespace {

enum class Arguments : std::uint8_t { none, one, perhaps_one, any };

struct Keyword {
  std::string_view name;
  FlowWord word;
  Arguments arguments;
};

// where one begins like another, the longer one is first
constexpr std::array<Keyword, 15> kKeywords = {{
    {"SUB", FlowWord::sub, Arguments::none},
    {"ENDSUB", FlowWord::end_sub, Arguments::perhaps_one},
    {"CALL", FlowWord::call, Arguments::any},
    {"RETURN", FlowWord::return_from, Arguments::perhaps_one},
    {"IF", FlowWord::if_true, Arguments::one},
    {"ELSEIF", FlowWord::else_if, Arguments::one},
    {"ELSE", FlowWord::otherwise, Arguments::none},
    {"ENDIF", FlowWord::end_if, Arguments::none},
    {"WHILE", FlowWord::while_true, Arguments::one},
    {"ENDWHILE", FlowWord::end_while, Arguments::none},
    {"DO", FlowWord::do_once, Arguments::none},
    {"REPEAT", FlowWord::repeat, Arguments::one},
    {"ENDREPEAT", FlowWord::end_repeat, Arguments::none},
    {"BREAK", FlowWord::break_loop, Arguments::none},
    {"CONTINUE", FlowWord::continue_loop, Arguments::none},
}};

constexpr std::size_t kMostArguments = 30;
constexpr std::string_view kKeywordList =
    "sub endsub call return if elseif else endif while endwhile do repeat endrepeat break continue";
constexpr double kLargestLabel = 1e9;

Arguments arguments_of(FlowWord word) {
  for (const Keyword& keyword : kKeywords) {
    if (keyword.word == word) return keyword.arguments;
  }
  return Arguments::none;
}

}  // namespace

bool Parser::parse_o_word() {
  const std::uint32_t begin = cursor_.at() - 1;
  const std::size_t before = line_->items.size();
  bool numbered = false;
  for (const Item& item : line_->items) {
    if (item.kind == ItemKind::word && item.letter == 'N') {
      if (numbered) {
        line_->has_flow = true;
        return fail(Code::line_number_place, item.bytes, "N is not the first word",
                    "a line number comes first on its line");
      }
      numbered = true;
      continue;
    }
    const bool may_stand_before = item.kind == ItemKind::block_delete || item.kind == ItemKind::comment ||
                                  item.kind == ItemKind::byte_order_mark;
    if (may_stand_before) continue;
    return fail(Code::o_word_place, {begin, begin + 1}, "O is not the first word",
                "an O word has a line to itself; if a zero was meant, write 0");
  }
  line_->has_flow = true;
  FlowStatement& flow = line_->flow;
  flow.arguments.clear();
  flow.keyword = flow.second = {};
  flow.number = -1;
  flow.first = flow.label_first = flow.label_root = flow.name = -1;
  flow.label = {begin, begin + 1};
  const auto nodes = static_cast<std::int32_t>(line_->nodes.size());
  if (!parse_label(flow)) return false;
  const char next = cursor_.peek();
  if (cursor_.at_end() || next == '(' || next == ';') {
    flow.word = FlowWord::label;
  } else {
    bool known = false;
    for (const Keyword& keyword : kKeywords) {
      if (!match(cursor_, keyword.name, flow.keyword)) continue;
      flow.word = keyword.word;
      known = true;
      break;
    }
    if (!known) {
      const std::uint32_t at = cursor_.at();
      std::uint32_t end = at;
      while (end < line_->text.size() && is_letter(line_->text[end])) ++end;
      return fail(Code::o_keyword_unknown, {at, end > at ? end : at + 1}, "not a keyword of an O word",
                  fmt::format("keywords: {}", kKeywordList));
    }
    if (!parse_arguments(flow)) {
      line_->items.resize(before);
      return false;
    }
  }
  Item item;
  item.kind = ItemKind::o_word;
  item.letter = 'O';
  item.bytes = {begin, cursor_.at()};
  item.first = nodes;
  // comments between its values come after it
  line_->items.insert(line_->items.begin() + static_cast<std::ptrdiff_t>(before), item);
  return true;
}

bool Parser::parse_label(FlowStatement& flow) {
  ExpressionParser expression = this->expression();
  const char c = cursor_.peek();
  if (c == '<') {
    flow.name = expression.name(flow.label.begin);
    flow.label.end = cursor_.at();
    return flow.name >= 0;
  }
  if (!is_digit(c)) {
    if (c != '[' && c != '#') {
      return fail(Code::o_label_missing, flow.label, "O needs a label",
                  "write O100, O<name>, or O[expression] in a call");
    }
    flow.label_first = static_cast<std::int32_t>(line_->nodes.size());
    flow.label_root = expression.value();
    flow.label.end = cursor_.at();
    return flow.label_root >= 0;
  }
  double number = 0;
  Bytes bytes;
  const NumberResult result = cursor_.read_number(number, bytes);
  if (result != NumberResult::good) {
    if (!muted_) report_.error(number_problem(*line_, result, bytes, 'O'));
    return false;
  }
  flow.label.end = cursor_.at();
  if (number != std::floor(number) || number > kLargestLabel) {
    return fail(Code::o_label_missing, flow.label, "a label is a whole number",
                fmt::format("allowed: 0 to {:.0f}, or a name: O<name>", kLargestLabel));
  }
  flow.name = names_.number(fmt::format("{:.0f}", number));
  return true;
}

bool Parser::parse_arguments(FlowStatement& flow) {
  const Arguments wanted = arguments_of(flow.word);
  ExpressionParser expression = this->expression();
  flow.first = static_cast<std::int32_t>(line_->nodes.size());
  const std::size_t most = wanted == Arguments::any ? kMostArguments : wanted == Arguments::none ? 0 : 1;
  for (;;) {
    // the controller drops comments before it reads the line
    while (cursor_.peek() == '(')
      if (!parse_comment()) return false;
    if (cursor_.peek() != '[') break;
    const std::uint32_t at = cursor_.at();
    if (flow.arguments.size() == most) {
      return fail(Code::o_arguments, {at, static_cast<std::uint32_t>(line_->text.size())},
                  most == 0 ? "this O word takes no value"
                            : fmt::format("value {} of this O word, allowed {}", most + 1, most),
                  flow.word == FlowWord::sub ? "the values of its call are #1, #2, ..." : "");
    }
    const std::int32_t root = expression.group();
    if (root < 0) return false;
    flow.arguments.push_back(root);
  }
  if (wanted == Arguments::one && flow.arguments.empty()) {
    return fail(Code::o_arguments, flow.keyword, "a value in [ ] must follow",
                "write for example O100 while [#1 LT 10]");
  }
  return true;
}

}  // namespace kadr::gcode
