#include "gcode/read/parser.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "machine/base/utf8.h"

namespace kadr::gcode {
namespace {

/// Letters that look like Latin ones and come from another keyboard layout.
char latin_twin(char32_t c) {
  constexpr std::array<std::pair<char32_t, char>, 20> kTwins = {
      {{U'А', 'A'}, {U'В', 'B'}, {U'С', 'C'}, {U'Е', 'E'}, {U'Н', 'H'}, {U'К', 'K'}, {U'М', 'M'},
       {U'О', 'O'}, {U'Р', 'P'}, {U'Т', 'T'}, {U'Х', 'X'}, {U'У', 'Y'}, {U'а', 'A'}, {U'с', 'C'},
       {U'е', 'E'}, {U'к', 'K'}, {U'м', 'M'}, {U'р', 'P'}, {U'х', 'X'}, {U'у', 'Y'}}};
  for (const auto& [twin, latin] : kTwins) {
    if (twin == c) return latin;
  }
  return 0;
}

/// True if a plain number begins here: digit, point, or a sign before one.
bool begins_number(Cursor cursor) {
  char c = cursor.peek();
  if (c == '-' || c == '+') {
    cursor.advance();
    c = cursor.peek();
  }
  return is_digit(c) || c == '.';
}

}  // namespace

void Parser::parse(Line& line, std::size_t begin_at) {
  line_ = &line;
  line.items.clear();
  line.nodes.clear();
  line.failed = false;
  line.has_flow = false;
  cursor_ = Cursor(line.text, static_cast<std::uint32_t>(begin_at));
  if (begin_at > 0) {
    line.items.emplace_back();
    line.items.back().kind = ItemKind::byte_order_mark;
    line.items.back().bytes = {0, static_cast<std::uint32_t>(begin_at)};
  }
  for (;;) {
    const char c = cursor_.peek();
    if (c == '\0' && cursor_.at_end()) return;
    std::uint32_t begin = cursor_.at();
    const std::size_t nodes = line.nodes.size();
    const std::size_t items = line.items.size();
    if (!parse_item(c)) {
      line.nodes.resize(nodes);
      if (line.items.size() > items) begin = line.items.back().bytes.end;
      Item rest;
      rest.kind = ItemKind::unread;
      rest.bytes = {begin, static_cast<std::uint32_t>(line.text.size())};
      line.items.push_back(rest);
      line.failed = true;
      return;
    }
  }
}

void Parser::leave_unread(Line& line) {
  line.items.clear();
  line.nodes.clear();
  line.has_flow = false;
  line.failed = true;
  line.items.emplace_back();
  line.items.back().kind = ItemKind::unread;
  line.items.back().bytes = {0, static_cast<std::uint32_t>(line.text.size())};
}

bool Parser::parse_item(char c) {
  if (line_->has_flow && c != '(' && c != ';') {
    return fail(Code::text_after_o_word, {cursor_.at(), static_cast<std::uint32_t>(line_->text.size())},
                "only a comment may follow an O word and its values");
  }
  if (is_letter(c)) return parse_word(upper(c));
  switch (c) {
    case '(':
      return parse_comment();
    case ';':
      return parse_line_comment();
    case '#':
      return parse_setting();
    case '%':
      return parse_percent();
    case '/':
      if (!line_->items.empty() && line_->items.back().kind != ItemKind::byte_order_mark)
        return bad_character();
      line_->items.emplace_back();
      line_->items.back().kind = ItemKind::block_delete;
      line_->items.back().bytes = {cursor_.at(), cursor_.at() + 1};
      cursor_.advance();
      return true;
    case '@':
    case '^':
    case '$':
      return parse_word(c);
    default:
      return bad_character();
  }
}

bool Parser::parse_word(char letter) {
  const std::uint32_t begin = cursor_.at();
  cursor_.advance();
  if (letter == 'O') return parse_o_word();
  double number = 0;
  if (cursor_.read_plain_number(number)) {
    Item& word = line_->items.emplace_back();
    word.letter = letter;
    word.number = number;
    word.bytes = {begin, cursor_.at()};
    return true;
  }
  Item item;
  item.letter = letter;
  if (begins_number(cursor_)) {
    const NumberResult result = cursor_.read_number(item.number, item.bytes);
    if (result != NumberResult::good) {
      if (!muted_) report_.error(number_problem(*line_, result, item.bytes, letter));
      return false;
    }
  } else {
    if (cursor_.at_end()) {
      return fail(Code::number_missing, {begin, begin + 1}, fmt::format("{} has no value", letter));
    }
    item.first = static_cast<std::int32_t>(line_->nodes.size());
    item.value = ExpressionParser(*line_, cursor_, names_, muted_ ? nullptr : &report_).value();
    if (item.value < 0) return false;
  }
  item.bytes = {begin, cursor_.at()};
  line_->items.push_back(item);
  return true;
}

bool Parser::parse_setting() {
  Item item;
  item.kind = ItemKind::setting;
  const std::uint32_t begin = cursor_.at();
  cursor_.advance();
  item.first = static_cast<std::int32_t>(line_->nodes.size());
  if (cursor_.peek() == '<') {
    item.name = ExpressionParser(*line_, cursor_, names_, muted_ ? nullptr : &report_).name(begin);
  } else {
    item.target = ExpressionParser(*line_, cursor_, names_, muted_ ? nullptr : &report_).value();
  }
  if (item.target < 0 && item.name < 0) return false;
  if (cursor_.peek() != '=') {
    return fail(Code::equals_missing, {begin, cursor_.at()}, "no = follows this parameter",
                "a parameter alone does nothing; write #5=1.25, or put a word letter before it");
  }
  item.equals = cursor_.at();
  cursor_.advance();
  item.value = ExpressionParser(*line_, cursor_, names_, muted_ ? nullptr : &report_).value();
  if (item.value < 0) return false;
  item.bytes = {begin, cursor_.at()};
  line_->items.push_back(item);
  return true;
}

bool Parser::parse_comment() {
  const std::uint32_t begin = cursor_.at();
  const std::string_view text = line_->text;
  for (std::uint32_t at = begin + 1; at < text.size(); ++at) {
    if (text[at] == '(') {
      return fail(Code::comment_nested, {at, at + 1}, "a comment within a comment",
                  "a comment ends at the first ) and may not contain (");
    }
    if (text[at] != ')') continue;
    Item item;
    item.kind = ItemKind::comment;
    item.bytes = {begin, at + 1};
    line_->items.push_back(item);
    cursor_.go_to(at + 1);
    check_encoding(item.bytes);
    return true;
  }
  return fail(Code::comment_not_closed, {begin, begin + 1}, "no ) follows on this line");
}

bool Parser::parse_line_comment() {
  Item item;
  item.kind = ItemKind::line_comment;
  item.bytes = {cursor_.at(), static_cast<std::uint32_t>(line_->text.size())};
  line_->items.push_back(item);
  cursor_.go_to(item.bytes.end);
  check_encoding(item.bytes);
  return true;
}

bool Parser::parse_percent() {
  for (const Item& item : line_->items) {
    if (item.kind != ItemKind::comment && item.kind != ItemKind::byte_order_mark) return bad_character();
  }
  Item item;
  item.kind = ItemKind::percent;
  item.bytes = {cursor_.at(), cursor_.at() + 1};
  line_->items.push_back(item);
  cursor_.advance();
  // only comments may follow
  Cursor ahead = cursor_;
  for (char next = ahead.peek(); next == '('; next = ahead.peek()) {
    const std::size_t end = line_->text.find(')', ahead.at());
    if (end == std::string_view::npos) return true;  // reported where the comment is read
    ahead.go_to(static_cast<std::uint32_t>(end) + 1);
  }
  if (ahead.at_end() || ahead.peek() == ';') return true;
  return fail(Code::text_after_percent, {ahead.at(), static_cast<std::uint32_t>(line_->text.size())},
              "% has a line to itself");
}

void Parser::check_encoding(Bytes bytes) {
  if (encoding_told_ || muted_) return;
  const std::string_view text = line_->slice(bytes);
  for (std::size_t at = 0; at < text.size();) {
    if (static_cast<unsigned char>(text[at]) < 0x80) {
      ++at;
      continue;
    }
    const CodePoint point = decode_utf8(text, at);
    if (point.bytes == 1) {
      const auto place = bytes.begin + static_cast<std::uint32_t>(at);
      report_.warning(problem(Code::not_utf8, line_->span({place, place + 1}),
                              fmt::format("byte 0x{:02X} is not UTF-8", static_cast<unsigned char>(text[at])),
                              "comments in cp1251 are common: convert the file with "
                              "`iconv -f cp1251 -t utf-8`; the motion does not depend on it"));
      encoding_told_ = true;
      return;
    }
    at += point.bytes;
  }
}

bool Parser::bad_character() {
  const std::uint32_t at = cursor_.at();
  const auto byte = static_cast<unsigned char>(line_->text[at]);
  if (byte >= 0x80) {
    const CodePoint point = decode_utf8(line_->text, at);
    const Bytes bytes{at, at + static_cast<std::uint32_t>(point.bytes)};
    if (point.bytes == 1) {
      return fail(Code::bad_character, bytes, fmt::format("byte 0x{:02X} is not UTF-8", byte),
                  "if the file is in cp1251, convert it with `iconv -f cp1251 -t utf-8`");
    }
    const std::string number = fmt::format("U+{:04X}", static_cast<std::uint32_t>(point.value));
    if (const char twin = latin_twin(point.value)) {
      return fail(Code::bad_character, bytes, fmt::format("this is a Cyrillic letter ({})", number),
                  fmt::format("type a Latin {}", twin));
    }
    return fail(Code::bad_character, bytes, fmt::format("{} is not allowed here", number));
  }
  if (byte < 0x20 || byte == 0x7F) {
    return fail(Code::bad_character, {at, at + 1}, fmt::format("control character 0x{:02X}", byte));
  }
  return fail(Code::bad_character, {at, at + 1}, fmt::format("{} is not allowed here", line_->text[at]));
}

bool Parser::fail(Code code, Bytes bytes, std::string label, std::string help) {
  if (!muted_) report_.error(problem(code, line_->span(bytes), std::move(label), std::move(help)));
  return false;
}

Diagnostic number_problem(const Line& line, NumberResult result, Bytes bytes, char letter) {
  switch (result) {
    case NumberResult::second_point:
      return problem(Code::bad_number, line.span(bytes), "a second decimal point");
    case NumberResult::decimal_comma: {
      std::string written(line.slice(bytes));
      written.back() = '.';
      std::uint32_t end = bytes.end;
      while (end < line.text.size() && is_digit(line.text[end])) written += line.text[end++];
      return problem(Code::decimal_comma, line.span({bytes.end - 1, bytes.end}), "a comma inside a number",
                     fmt::format("the decimal mark is a point: write {}{}",
                                 letter ? std::string(1, letter) : "", written));
    }
    case NumberResult::good:
    case NumberResult::no_digits:
      break;
  }
  return problem(Code::bad_number, line.span(bytes), "there is no digit here");
}

}  // namespace kadr::gcode
