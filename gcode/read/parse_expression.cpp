#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

#include "gcode/interpret/words.h"
#include "gcode/read/parser.h"

namespace kadr::gcode {
namespace {

struct NamedOperation {
  std::string_view name;
  Operation operation;
  int precedence;  ///< higher binds tighter; all are read from left to right
};

// ** before * so that the longer one is found first
constexpr std::array<NamedOperation, 15> kOperators = {{{"**", Operation::power, 5},
                                                        {"*", Operation::multiply, 4},
                                                        {"/", Operation::divide, 4},
                                                        {"MOD", Operation::modulo, 4},
                                                        {"+", Operation::add, 3},
                                                        {"-", Operation::subtract, 3},
                                                        {"EQ", Operation::equal, 2},
                                                        {"NE", Operation::not_equal, 2},
                                                        {"GT", Operation::greater, 2},
                                                        {"GE", Operation::greater_equal, 2},
                                                        {"LT", Operation::less, 2},
                                                        {"LE", Operation::less_equal, 2},
                                                        {"AND", Operation::logical_and, 1},
                                                        {"OR", Operation::logical_or, 1},
                                                        {"XOR", Operation::logical_xor, 1}}};

// AND multiplies, OR and XOR add; what compares comes last
constexpr std::array<NamedOperation, 14> kMacroOperators = {{{"*", Operation::multiply, 3},
                                                             {"/", Operation::divide, 3},
                                                             {"MOD", Operation::modulo, 3},
                                                             {"AND", Operation::logical_and, 3},
                                                             {"+", Operation::add, 2},
                                                             {"-", Operation::subtract, 2},
                                                             {"OR", Operation::logical_or, 2},
                                                             {"XOR", Operation::logical_xor, 2},
                                                             {"EQ", Operation::equal, 1},
                                                             {"NE", Operation::not_equal, 1},
                                                             {"GT", Operation::greater, 1},
                                                             {"GE", Operation::greater_equal, 1},
                                                             {"LT", Operation::less, 1},
                                                             {"LE", Operation::less_equal, 1}}};
constexpr std::array<NamedOperation, 2> kMacroFunctions = {
    {{"SQR", Operation::sqrt, 0}, {"RND", Operation::round, 0}}};

constexpr std::string_view kOperatorList = "+ - * / ** MOD EQ NE GT GE LT LE AND OR XOR";
constexpr std::string_view kMacroOperatorList = "+ - * / MOD EQ NE GT GE LT LE AND OR XOR";
constexpr std::string_view kFunctionList = "ABS ACOS ASIN ATAN COS EXP FIX FUP LN ROUND SIN SQRT TAN";
constexpr std::string_view kMacroFunctionList =
    "ABS ACOS ASIN ATAN COS EXP FIX FUP LN POW ROUND SIN SQRT TAN";

constexpr std::array<NamedOperation, 12> kFunctions = {{{"ABS", Operation::abs, 0},
                                                        {"ACOS", Operation::acos, 0},
                                                        {"ASIN", Operation::asin, 0},
                                                        {"COS", Operation::cos, 0},
                                                        {"EXP", Operation::exp, 0},
                                                        {"FIX", Operation::fix, 0},
                                                        {"FUP", Operation::fup, 0},
                                                        {"LN", Operation::ln, 0},
                                                        {"ROUND", Operation::round, 0},
                                                        {"SIN", Operation::sin, 0},
                                                        {"SQRT", Operation::sqrt, 0},
                                                        {"TAN", Operation::tan, 0}}};

}  // namespace

bool match(Cursor& cursor, std::string_view name, Bytes& bytes) {
  Cursor ahead = cursor;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (upper(ahead.peek()) != name[i]) return false;
    if (i == 0) bytes.begin = ahead.at();
    ahead.advance();
  }
  bytes.end = ahead.at();
  cursor = ahead;
  return true;
}

std::int32_t ExpressionParser::value() {
  const char c = cursor_.peek();
  if (++depth_ > kMaxDepth) {
    return fail(Code::expression_too_deep, {cursor_.at(), cursor_.at() + 1},
                fmt::format("nested more than {} deep", kMaxDepth));
  }
  std::int32_t root = -1;
  if (is_digit(c) || c == '.') {
    root = number();
  } else if (c == '-' || c == '+') {
    Cursor ahead = cursor_;
    ahead.advance();
    const char next = ahead.peek();
    const bool plain = is_digit(next) || next == '.';
    root = plain ? number() : signed_value(c == '-' ? NodeKind::negate : NodeKind::plus);
  } else if (c == '[') {
    root = group();
  } else if (c == '#') {
    root = parameter();
  } else if (is_letter(c)) {
    root = function();
  } else {
    root = missing();
  }
  --depth_;
  return root;
}

/// Reports that no value begins here: nothing at all, or a character that looks like the sign of one.
std::int32_t ExpressionParser::missing() {
  const std::uint32_t at = cursor_.at();
  if (!foreign_here()) {
    return fail(Code::number_missing, {at, at + 1},
                "a number, #parameter, [expression] or function is missing here");
  }
  if (report_ != nullptr) report_->error(character_problem(line_, at));
  return -1;
}

bool ExpressionParser::foreign_here() {
  return !cursor_.at_end() && static_cast<unsigned char>(line_.text[cursor_.at()]) >= 0x80;
}

std::int32_t ExpressionParser::number() {
  ExpressionNode node;
  const NumberResult result = cursor_.read_number(node.value, node.own, in_pair_);
  if (result == NumberResult::good) return add(node);
  if (report_ != nullptr) report_->error(number_problem(line_, result, node.own, 0));
  return -1;
}

std::int32_t ExpressionParser::signed_value(NodeKind kind) {
  ExpressionNode node;
  node.kind = kind;
  node.own = {cursor_.at(), cursor_.at() + 1};
  cursor_.advance();
  node.left = value();
  return node.left < 0 ? -1 : add(node);
}

std::int32_t ExpressionParser::parameter() {
  ExpressionNode node;
  node.kind = NodeKind::parameter;
  node.own = {cursor_.at(), cursor_.at() + 1};
  cursor_.advance();
  if (cursor_.peek() == '<') {
    if (macros_) return refuse_name(node.own.begin);
    node.kind = NodeKind::named;
    node.left = name(node.own.begin);
    node.own.end = cursor_.at();
  } else {
    node.left = value();
  }
  return node.left < 0 ? -1 : add(node);
}

std::int32_t ExpressionParser::refuse_name(std::uint32_t sign) {
  return fail(Code::name_bad, {sign, cursor_.at() + 1}, "macro B has no named variables",
              "use a number: #100 to #199 are common to all programs");
}

std::int32_t ExpressionParser::name(std::uint32_t sign) {
  const std::uint32_t open = cursor_.at();
  const std::size_t close = line_.text.find('>', open);
  if (close == std::string_view::npos) {
    return fail(Code::name_not_closed, {sign, open + 1}, "no > closes this name");
  }
  const std::string_view written = line_.text.substr(open + 1, close - open - 1);
  const auto end = static_cast<std::uint32_t>(close) + 1;
  for (const char c : written) {
    const bool control = !is_blank(c) && (static_cast<unsigned char>(c) < 0x20 || c == 0x7F);
    if (c == '(' || control) {
      return fail(
          Code::name_bad, {sign, end},
          control ? "a control character in a name" : "( is not allowed in a name: a comment begins with it");
    }
  }
  cursor_.go_to(end);
  const std::int32_t number = names_.number(written);
  if (!names_[number].empty()) return number;
  return fail(Code::name_bad, {sign, end}, "a name without letters");
}

std::int32_t ExpressionParser::exists(ExpressionNode node) {
  const auto refuse = [&] {
    return fail(Code::argument_missing, node.own, "EXISTS takes one parameter",
                "write EXISTS[#<name>] or EXISTS[#5]");
  };
  if (cursor_.peek() != '[') return refuse();
  cursor_.advance();
  if (cursor_.peek() != '#') return refuse();
  const std::uint32_t sign = cursor_.at();
  cursor_.advance();
  node.kind = NodeKind::exists;
  if (cursor_.peek() == '<') {
    node.kind = NodeKind::exists_named;
    node.left = name(sign);
  } else {
    node.left = value();
  }
  if (node.left < 0) return -1;
  node.own.end = node.kind == NodeKind::exists ? sign + 1 : cursor_.at();
  if (cursor_.peek() != ']') return fail(Code::bracket_not_closed, node.own, "no ] closes this bracket");
  node.closing = {cursor_.at(), cursor_.at() + 1};
  cursor_.advance();
  return add(node);
}

std::int32_t ExpressionParser::group() {
  ExpressionNode node;
  node.kind = NodeKind::group;
  node.own = {cursor_.at(), cursor_.at() + 1};
  cursor_.advance();
  const bool around = std::exchange(in_pair_, false);
  node.left = chain(1, Within::bracket);
  in_pair_ = around;
  if (node.left < 0) return -1;
  if (cursor_.peek() != ']') return fail(Code::bracket_not_closed, node.own, "no ] closes this bracket");
  node.closing = {cursor_.at(), cursor_.at() + 1};
  cursor_.advance();
  return add(node);
}

std::int32_t ExpressionParser::function() {
  ExpressionNode node;
  node.kind = NodeKind::function;
  const Cursor before = cursor_;
  const auto find = [&](const auto& functions) {
    for (const NamedOperation& f : functions) {
      if (!match(cursor_, f.name, node.own)) continue;
      node.operation = f.operation;
      return true;
    }
    return false;
  };
  if (!macros_ && match(cursor_, "EXISTS", node.own)) return exists(node);
  if (match(cursor_, "ATAN", node.own) || (macros_ && match(cursor_, "ATN", node.own))) {
    node.kind = NodeKind::atan;
  } else if (macros_ && match(cursor_, "POW", node.own)) {
    node.kind = NodeKind::power;
  } else if (!find(kFunctions) && !(macros_ && find(kMacroFunctions))) {
    return macros_ && refuse_macro_function(node) ? -1 : unknown_name("function");
  }
  if (is_letter(cursor_.peek())) {  // SINE, COSH: a name that only begins like a function
    cursor_ = before;
    return unknown_name("function");
  }
  if (cursor_.peek() != '[') return fail(Code::argument_missing, node.own, "an argument in [ ] must follow");
  if (macros_ && node.kind != NodeKind::function) return pair(node);
  node.left = group();
  if (node.left < 0) return -1;
  if (node.kind == NodeKind::atan) {
    if (cursor_.peek() != '/') {
      return fail(Code::argument_missing, node.own, "ATAN takes two arguments", "write ATAN[y]/[x]");
    }
    node.closing = {cursor_.at(), cursor_.at() + 1};
    cursor_.advance();
    if (cursor_.peek() != '[') {
      return fail(Code::argument_missing, node.own, "ATAN takes two arguments", "write ATAN[y]/[x]");
    }
    node.right = group();
    if (node.right < 0) return -1;
  }
  return add(node);
}

/// ATAN[y]/[x], ATAN[y,x], ATAN[a] and POW[base,exponent] of macro B.
std::int32_t ExpressionParser::pair(ExpressionNode node) {
  ExpressionNode brackets;
  brackets.kind = NodeKind::group;
  brackets.own = {cursor_.at(), cursor_.at() + 1};
  cursor_.advance();
  const bool around = std::exchange(in_pair_, true);
  node.left = chain(1, Within::bracket);
  if (node.left >= 0 && cursor_.peek() == ',') {
    ExpressionNode comma;
    comma.kind = NodeKind::comma;
    comma.own = {cursor_.at(), cursor_.at() + 1};
    cursor_.advance();
    node.right = chain(1, Within::bracket);
    if (node.right >= 0)
      add(comma);
    else
      node.left = -1;
  }
  in_pair_ = around;
  if (node.left < 0) return -1;
  if (cursor_.peek() != ']') return fail(Code::bracket_not_closed, brackets.own, "no ] closes this bracket");
  brackets.closing = {cursor_.at(), cursor_.at() + 1};
  cursor_.advance();
  brackets.left = node.left;
  const std::int32_t inside = add(brackets);
  if (node.right >= 0) return add(node);
  if (node.kind == NodeKind::power)
    return fail(Code::argument_missing, node.own, "POW takes two arguments", "write POW[base,exponent]");
  node.left = inside;
  if (cursor_.peek() == '/') {
    Cursor ahead = cursor_;
    ahead.advance();
    if (ahead.peek() == '[') {
      node.closing = {cursor_.at(), cursor_.at() + 1};
      cursor_ = ahead;
      node.right = group();
      return node.right < 0 ? -1 : add(node);
    }
  }
  node.kind = NodeKind::function;
  node.operation = Operation::atan;
  return add(node);
}

/// BIN, BCD and ADP depend on how a controller keeps its numbers.
bool ExpressionParser::refuse_macro_function(ExpressionNode& node) {
  for (const std::string_view name : {"BIN", "BCD", "ADP"}) {
    if (!match(cursor_, name, node.own)) continue;
    fail(Code::word_not_run, node.own, fmt::format("kadr does not run {}", name));
    return true;
  }
  return false;
}

std::int32_t ExpressionParser::chain(int lowest_precedence, Within within) {
  std::int32_t left = value();
  while (left >= 0) {
    const char c = cursor_.peek();
    if (c == ']' || cursor_.at_end() || (in_pair_ && c == ',')) return left;
    const Cursor before = cursor_;
    ExpressionNode node;
    node.kind = NodeKind::binary;
    int precedence = 0;
    if (!read_operator(node.operation, node.own, precedence))
      return within == Within::line ? left : unknown_name("operator");
    if (precedence < lowest_precedence) {
      cursor_ = before;
      return left;
    }
    node.left = left;
    node.right = chain(precedence + 1, within);
    if (node.right < 0) return -1;
    left = add(node);
  }
  return left;
}

bool ExpressionParser::read_operator(Operation& operation, Bytes& bytes, int& precedence) {
  const auto find = [&](const auto& operators) {
    for (const NamedOperation& o : operators) {
      if (!match(cursor_, o.name, bytes)) continue;
      operation = o.operation;
      precedence = o.precedence;
      return true;
    }
    return false;
  };
  return macros_ ? find(kMacroOperators) : find(kOperators);
}

std::int32_t ExpressionParser::unknown_name(const char* expected) {
  const char c = cursor_.peek();
  if (foreign_here()) return missing();
  Bytes bytes{cursor_.at(), cursor_.at() + 1};
  if (!is_letter(c)) {
    return fail(Code::operator_expected, bytes, "an operator or ] is expected here",
                fmt::format("operators: {}", macros_ ? kMacroOperatorList : kOperatorList));
  }
  while (bytes.end < line_.text.size() && is_letter(line_.text[bytes.end])) ++bytes.end;
  if (bytes.end - bytes.begin == 1 && expected[0] == 'f') {
    return fail(Code::number_missing, bytes, "a value is missing before this letter");
  }
  return fail(Code::unknown_name, bytes, fmt::format("there is no {} of this name", expected),
              expected[0] == 'f'
                  ? fmt::format("functions: {}", macros_ ? kMacroFunctionList : kFunctionList)
                  : fmt::format("operators: {}", macros_ ? kMacroOperatorList : kOperatorList));
}

std::int32_t ExpressionParser::add(const ExpressionNode& node) {
  line_.nodes.push_back(node);
  return static_cast<std::int32_t>(line_.nodes.size()) - 1;
}

std::int32_t ExpressionParser::fail(Code code, Bytes bytes, std::string label, std::string help) {
  if (report_ != nullptr) report_->error(problem(code, line_.span(bytes), std::move(label), std::move(help)));
  return -1;
}

}  // namespace kadr::gcode
