#include <fmt/format.h>

#include <algorithm>

#include "gcode/read/parser.h"

/// Lines and texts that a dialect has beside words: commands of a serial line, remarks, checksums.
namespace kadr::gcode {
namespace {

/// Of Marlin and RepRapFirmware: the rest of the line is a text or the name of a file.
constexpr int kTextCodes[] = {23, 28, 32, 33, 117, 118, 486, 928};

std::size_t first_not_blank(std::string_view text) {
  return std::min(text.find_first_not_of(" \t\r"), text.size());
}

}  // namespace

/// What the dialect makes of a whole line.
/// @param end  where the words of the line end
/// @return true if the line is done
bool Parser::take_dialect_line(Line& line, std::size_t& end) {
  const TextRules& text = rules_.text;
  if (text.controller_lines && controller_line(line)) return true;
  if (text.percent_remarks && percent_remark(line)) return true;
  if (text.checksums && !take_checksum(line, end)) return true;
  return text.line_characters > 0 && line.text.size() > text.line_characters && too_many_characters(line);
}

/// The whole line is a remark.
void Parser::remark(Line& line) {
  Item item;
  item.kind = ItemKind::line_comment;
  item.bytes = {0, static_cast<std::uint32_t>(line.text.size())};
  line.items.push_back(item);
}

/// $H, $X, $110=500, ? ! ~ of grbl.
bool Parser::controller_line(Line& line) {
  const std::size_t at = first_not_blank(line.text);
  if (at == line.text.size()) return false;
  const bool command = line.text[at] == '$';
  if (!command && line.text.find_first_not_of("?!~ \t\r", at) != std::string_view::npos) return false;
  remark(line);
  if (muted_) return true;
  const Span span = line.span({static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(line.text.size())});
  const std::string_view behind = line.text.substr(at);
  if (behind.substr(0, 3) == "$J=" || behind.substr(0, 3) == "$j=") {
    report_.warning(problem(Code::controller_line, span, "kadr runs no jog: the tool stays where it is",
                            "write the move as G1"));
  } else {
    report_.repeated_note(
        problem(Code::controller_line, span, fmt::format("skipped: not a part of the program")), "$");
  }
  return true;
}

/// "% text" of FluidNC; % alone and % before a comment keep their meaning.
bool Parser::percent_remark(Line& line) {
  const std::size_t at = first_not_blank(line.text);
  if (at == line.text.size() || line.text[at] != '%') return false;
  const std::size_t behind = line.text.find_first_not_of(" \t\r", at + 1);
  if (behind == std::string_view::npos || line.text[behind] == '(' || line.text[behind] == ';') return false;
  remark(line);
  return true;
}

/// N3 G1 X5*71: checks 71, and takes it off the line.
/// @return false if it does not fit: an error was reported
bool Parser::take_checksum(Line& line, std::size_t& end) {
  const std::size_t star = line.text.find_last_of('*');
  if (star == std::string_view::npos ||
      line.text.substr(0, star).find_first_of(";(") != std::string_view::npos)
    return true;
  std::size_t at = star + 1;
  int written = 0;
  for (; at < line.text.size() && is_digit(line.text[at]); ++at)
    written = std::min(10 * written + (line.text[at] - '0'), 1000);
  if (at == star + 1 || line.text.find_first_not_of(" \t\r", at) != std::string_view::npos) return true;
  unsigned fitting = 0;
  for (const char c : line.text.substr(0, star)) fitting ^= static_cast<unsigned char>(c);
  const auto place = static_cast<std::uint32_t>(star);
  if (static_cast<unsigned>(written) == fitting) {
    end = star;
    return true;
  }
  fail(Code::checksum_wrong, {place, static_cast<std::uint32_t>(at)},
       fmt::format("{} stands here, {} fits the line", written, fitting),
       "send the line again, or remove the checksum if the line was edited");
  leave_unread(line);
  return false;
}

/// Whether the line without blanks and comments is longer than the controller keeps.
bool Parser::too_many_characters(Line& line) {
  std::uint32_t count = 0;
  bool comment = false;
  for (const char c : line.text) {
    if (comment) {
      comment = c != ')';
    } else if (c == '(') {
      comment = true;
    } else if (c == ';') {
      break;
    } else if (c > ' ' && c != '/') {
      ++count;
    }
  }
  if (count <= rules_.text.line_characters) return false;
  fail(Code::dialect_refuses, {0, static_cast<std::uint32_t>(line.text.size())},
       fmt::format("{} takes {} characters of a line: here are {}, without blanks and comments", rules_.name,
                   rules_.text.line_characters, count),
       "write the words on two lines");
  leave_unread(line);
  return true;
}

/// M117 Hello: the rest of the line is a text. Its number ends at the first blank.
/// @param begin  of the M
bool Parser::take_text_code(std::uint32_t begin) {
  const std::string_view text = cursor_.text();
  std::size_t end = begin + 1;
  int number = 0;
  for (; end < text.size() && is_digit(text[end]) && number < 1000; ++end)
    number = 10 * number + (text[end] - '0');
  if (std::find(std::begin(kTextCodes), std::end(kTextCodes), number) == std::end(kTextCodes)) return false;
  Item word;
  word.letter = 'M';
  word.number = number;
  word.bytes = {begin, static_cast<std::uint32_t>(end)};
  line_->items.push_back(word);
  cursor_.go_to(word.bytes.end);
  if (cursor_.at_end()) return true;
  Item rest;
  rest.kind = ItemKind::line_comment;
  rest.bytes = {cursor_.at(), static_cast<std::uint32_t>(text.size())};
  line_->items.push_back(rest);
  cursor_.go_to(rest.bytes.end);
  return true;
}

/// A letter without a value in G28 X Y or M84 E: a flag.
bool Parser::bare_letter() {
  if (!rules_.text.bare_letters || !(cursor_.at_end() || is_letter(cursor_.peek()) || cursor_.peek() == ';'))
    return false;
  const auto takes_flags = [](const Item& item) {
    return item.kind == ItemKind::word && (item.letter == 'M' || (item.letter == 'G' && item.number >= 28));
  };
  return std::any_of(line_->items.begin(), line_->items.end(), takes_flags);
}

/// Reports a parameter, an expression or an O word where the controller has none.
bool Parser::expression_refused(std::uint32_t begin) {
  if (rules_.text.expressions) return false;
  const char c = line_->text[begin];
  const std::string_view what = c == '#'          ? "parameters"
                                : upper(c) == 'O' ? "O words: each line runs once"
                                                  : "expressions";
  fail(Code::dialect_refuses, {begin, begin + 1}, fmt::format("{} has no {}", rules_.name, what),
       "let the postprocessor write the values and lines themselves");
  return true;
}

}  // namespace kadr::gcode
