#include "gcode/read/parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "machine/base/utf8.h"

namespace kadr::gcode {
namespace {

/// True if a plain number begins here: digit, point, or a sign before one.
bool begins_number(Cursor cursor) {
  char c = cursor.peek();
  if (c == '-' || c == '+') {
    cursor.advance();
    c = cursor.peek();
  }
  return is_digit(c) || c == '.';
}

/// True for * and digits up to the end of the line or a remark.
bool cursor_ends_in_digits(Cursor cursor) {
  cursor.advance();
  if (!is_digit(cursor.peek())) return false;
  while (is_digit(cursor.peek())) cursor.advance();
  return cursor.at_end() || cursor.peek() == ';';
}

}  // namespace

void Parser::parse(Line& line, std::size_t begin_at) {
  line_ = &line;
  line.items.clear();
  line.nodes.clear();
  line.failed = false;
  line.has_flow = false;
  line.only_settings = line.reads_inputs = false;
  line.macro_call = MacroCall::none;
  if (carriage_return_inside(line)) return;
  std::size_t end = line.text.size();
  if (looks_at_lines_ && take_dialect_line(line, end)) return;
  cursor_ = Cursor(line.text.substr(0, end), static_cast<std::uint32_t>(begin_at));
  if (begin_at > 0) {
    line.items.emplace_back();
    line.items.back().kind = ItemKind::byte_order_mark;
    line.items.back().bytes = {0, static_cast<std::uint32_t>(begin_at)};
  }
  for (;;) {
    const char c = cursor_.peek();
    if (c == '\0' && cursor_.at_end()) {
      if (rules_.macros.on) note_macro_line();
      break;
    }
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
  if (end == line.text.size()) return;
  line.items.emplace_back();
  line.items.back().kind = ItemKind::line_comment;
  line.items.back().bytes = {static_cast<std::uint32_t>(end), static_cast<std::uint32_t>(line.text.size())};
}

/// Reports a carriage return with more behind it: lines of an old Macintosh file, which must not become one block.
bool Parser::carriage_return_inside(Line& line) {
  const std::size_t at = line.text.find('\r');
  if (at == std::string_view::npos) return false;
  const std::size_t behind = line.text.find_first_not_of(" \t\r", at);
  if (behind == std::string_view::npos) return false;
  const auto returns = static_cast<std::size_t>(std::count(line.text.begin(), line.text.end(), '\r'));
  const auto place = static_cast<std::uint32_t>(at);
  leave_unread(line);
  if (muted_) return true;
  Diagnostic d =
      problem(Code::carriage_return, line.span({place, place + 1}), "it ends no line, and more follows",
              "save the file with line feeds: tr '\\r' '\\n' < part.ngc > part_lf.ngc");
  d.notes.push_back(fmt::format("carriage returns within this line: {}", returns));
  report_.last_error(std::move(d));
  return true;
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
  if (line_->has_flow && c != '(' && c != ';' && line_->flow.word != FlowWord::if_then) {
    return fail(Code::text_after_o_word, {cursor_.at(), static_cast<std::uint32_t>(line_->text.size())},
                "only a comment may follow an O word and its values");
  }
  if (line_->has_flow && !rules_.macros.then_runs_words && c != '(' && c != ';' && c != '#') {
    return fail(Code::macro_statement, {cursor_.at(), static_cast<std::uint32_t>(line_->text.size())},
                "only a setting may follow THEN",
                "write IF [condition] GOTO n, around what the condition decides");
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
  if (letter == 'O') return !expression_refused(begin) && parse_o_word();
  if (letter == 'M' && rules_.text.text_codes && take_text_code(begin)) return true;
  double number = 0;
  if (cursor_.read_plain_number(number)) {
    Item& word = line_->items.emplace_back();
    word.letter = letter;
    word.number = number;
    word.bytes = {begin, cursor_.at()};
    return true;
  }
  if (rules_.macros.on && is_letter(cursor_.peek()) && begins_control(begin)) return parse_control(begin);
  Item item;
  item.letter = letter;
  if (begins_number(cursor_)) {
    const NumberResult result = cursor_.read_number(item.number, item.bytes);
    if (result != NumberResult::good) {
      if (!muted_) report_.error(number_problem(*line_, result, item.bytes, letter));
      return false;
    }
  } else if (bare_letter()) {
    item.bytes = {begin, begin + 1};
    line_->items.push_back(item);
    return true;
  } else {
    if (cursor_.at_end()) {
      return fail(Code::number_missing, {begin, begin + 1}, fmt::format("{} has no value", letter));
    }
    if (expression_refused(cursor_.at())) return false;
    item.first = static_cast<std::int32_t>(line_->nodes.size());
    item.value = expression().value();
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
  if (expression_refused(begin)) return false;
  cursor_.advance();
  item.first = static_cast<std::int32_t>(line_->nodes.size());
  if (cursor_.peek() == '<' && rules_.macros.on) {
    expression().refuse_name(begin);
  } else if (cursor_.peek() == '<') {
    item.name = expression().name(begin);
  } else {
    item.target = expression().value();
  }
  if (item.target < 0 && item.name < 0) return false;
  if (cursor_.peek() != '=') {
    return fail(Code::equals_missing, {begin, cursor_.at()}, "no = follows this parameter",
                "a parameter alone does nothing; write #5=1.25, or put a word letter before it");
  }
  item.equals = cursor_.at();
  cursor_.advance();
  item.value = rules_.macros.on ? expression().right_side() : expression().value();
  if (item.value < 0) return false;
  item.bytes = {begin, cursor_.at()};
  line_->items.push_back(item);
  return true;
}

ExpressionParser Parser::expression() {
  return {*line_, cursor_, names_, muted_ ? nullptr : &report_, rules_.macros.on};
}

bool Parser::parse_comment() {
  const std::uint32_t begin = cursor_.at();
  const std::string_view text = line_->text;
  for (std::uint32_t at = begin + 1; at < text.size(); ++at) {
    if (text[at] == '(' && !rules_.text.comment_ends_at_first) {
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
  if (rules_.text.comment_ends_at_first) return parse_line_comment();
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
  if (line_->text[at] == ',') return corner_or_comma(at);
  if (line_->text[at] == '*' && cursor_ends_in_digits(cursor_)) {
    return fail(Code::bad_character, {at, static_cast<std::uint32_t>(line_->text.size())},
                "a checksum, as hosts of printers send it",
                "remove * and the digits behind it from every line");
  }
  if (!muted_) report_.error(character_problem(*line_, at));
  return false;
}

/// A comma outside a number: ,C and ,R put a chamfer or a rounding at the end of a Fanuc block.
bool Parser::corner_or_comma(std::uint32_t at) {
  Cursor ahead(line_->text, at + 1);
  const char letter = upper(ahead.peek());
  if (rules_.text.corners && (letter == 'R' || letter == 'C'))
    return parse_corner(at, letter, ahead.at() + 1);
  if (letter != 'C' && letter != 'R' && letter != 'A')
    return fail(Code::bad_character, {at, at + 1}, ", is not allowed here",
                "blanks or nothing stand between words");
  const std::string_view name = letter == 'C'   ? "a chamfer at the corner"
                                : letter == 'R' ? "a rounding of the corner"
                                                : "the angle of the line";
  return fail(Code::word_not_run, {at, ahead.at() + 1},
              fmt::format("kadr does not run ,{}: {}", letter, name),
              letter == 'A' ? "write the end point of the move" : "write the corner as a move of its own");
}

/// ,R5 and ,C5
bool Parser::parse_corner(std::uint32_t at, char letter, std::uint32_t behind) {
  cursor_.go_to(behind);
  Item item;
  item.letter = letter == 'R' ? kCornerRadius : kCornerChamfer;
  if (begins_number(cursor_)) {
    Bytes bytes;
    const NumberResult result = cursor_.read_number(item.number, bytes);
    if (result != NumberResult::good) {
      if (!muted_) report_.error(number_problem(*line_, result, bytes, letter));
      return false;
    }
  } else {
    if (cursor_.at_end())
      return fail(Code::number_missing, {at, behind}, fmt::format(",{} has no value", letter));
    item.first = static_cast<std::int32_t>(line_->nodes.size());
    item.value = ExpressionParser(*line_, cursor_, names_, muted_ ? nullptr : &report_).value();
    if (item.value < 0) return false;
  }
  item.bytes = {at, cursor_.at()};
  line_->items.push_back(item);
  return true;
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
      while (end < line.text.size() && is_blank(line.text[end])) ++end;
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
