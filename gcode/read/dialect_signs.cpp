#include "gcode/read/dialect_signs.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "gcode/read/report.h"
#include "gcode/read/scanner.h"

namespace kadr::gcode {
namespace {

constexpr std::size_t kMostSignLines = 2000;
constexpr std::size_t kMostSignColumns = 200;  // of a line

/// Capital letters without blanks, comments and line number: "N10 g1 x1 (a) ; b" is "G1X1".
std::string plain_words(std::string_view line) {
  std::string out;
  bool comment = false;
  for (const char c : line.substr(0, kMostSignColumns)) {
    if (comment) {
      comment = c != ')';
    } else if (c == ';') {
      break;
    } else if (c == '(') {
      comment = true;
    } else if (!is_blank(c)) {
      out += upper(c);
    }
  }
  if (out.size() < 2 || out.front() != 'N' || !is_digit(out[1])) return out;
  return out.substr(std::min(out.find_first_not_of("0123456789", 1), out.size()));
}

/// The code, zeros before its number or not, as a word of the line: not followed by a digit or a point.
bool has_word(std::string_view line, char letter, std::string_view number) {
  for (std::size_t at = line.find(letter); at != std::string_view::npos; at = line.find(letter, at + 1)) {
    std::size_t from = at + 1;
    while (from + 1 < line.size() && line[from] == '0' && is_digit(line[from + 1])) ++from;
    if (line.substr(from, number.size()) != number) continue;
    const std::size_t end = from + number.size();
    const bool longer = end < line.size() && (is_digit(line[end]) || line[end] == '.');
    if (!longer) return true;
  }
  return false;
}
bool begins_with(std::string_view text, std::string_view head) { return text.substr(0, head.size()) == head; }
bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// A letter of the line with a number behind it.
bool has_letter(std::string_view line, char letter) {
  const std::size_t at = line.find(letter);
  return at != std::string_view::npos && at + 1 < line.size() &&
         (is_digit(line[at + 1]) || line[at + 1] == '-' || line[at + 1] == '.');
}

struct Found {
  Dialect dialect = Dialect::linuxcnc;
  std::string_view what = {};
};

Found sign_of_haas(std::string_view line) {
  if (has_word(line, 'G', "154") && has_letter(line, 'P')) return {Dialect::haas, "G154 P"};
  if (has_word(line, 'G', "187")) return {Dialect::haas, "G187"};
  if (has_word(line, 'G', "103")) return {Dialect::haas, "G103"};
  if (has_word(line, 'M', "97") && has_letter(line, 'P')) return {Dialect::haas, "M97 P"};
  return {};
}

Found sign_of_fanuc(std::string_view line) {
  if (begins_with(line, "IF[") && contains(line, "GOTO")) return {Dialect::fanuc, "macro B (IF .. GOTO)"};
  if (begins_with(line, "IF[") && contains(line, "THEN")) return {Dialect::fanuc, "macro B (IF .. THEN)"};
  if (begins_with(line, "WHILE[") && contains(line, "]DO")) return {Dialect::fanuc, "macro B (WHILE .. DO)"};
  if (begins_with(line, "GOTO")) return {Dialect::fanuc, "macro B (GOTO)"};
  if (has_word(line, 'G', "65") && has_letter(line, 'P')) return {Dialect::fanuc, "macro B (G65 P)"};
  if (has_word(line, 'G', "54.1") && has_letter(line, 'P')) return {Dialect::fanuc, "G54.1 P"};
  if (has_word(line, 'G', "5.1") && has_letter(line, 'Q')) return {Dialect::fanuc, "G05.1 Q"};
  if (has_word(line, 'M', "29") && has_letter(line, 'S')) return {Dialect::fanuc, "M29 S"};
  if (contains(line, ",R") || contains(line, ",C")) return {Dialect::fanuc, "a corner (,R or ,C)"};
  if (has_word(line, 'G', "28") && (has_word(line, 'G', "0") || has_word(line, 'G', "1")))
    return {Dialect::fanuc, "G0 beside G28"};
  return {};
}

Found sign_of_printer(std::string_view line) {
  for (const std::string_view heats : {"104", "109", "140", "190"})
    if (has_word(line, 'M', heats) && has_letter(line, 'S'))
      return {Dialect::marlin, "a heater's code (M104)"};
  if (has_word(line, 'M', "106") && has_letter(line, 'S')) return {Dialect::marlin, "a fan's code (M106)"};
  for (const std::string_view filament : {"82", "83"})
    if (has_word(line, 'M', filament)) return {Dialect::marlin, "a code of extruders (M82)"};
  return {};
}

Found sign_of_hobby(std::string_view line) {
  if (line.size() > 1 && line[0] == '$' && (is_letter(line[1]) || is_digit(line[1])))
    return {Dialect::grbl, "a command of grbl ($)"};
  if (line == "G2" || line == "G3" || line == "G02" || line == "G03")
    return {Dialect::mach3, "G2 or G3 alone on its line"};
  if (has_word(line, 'G', "31") && has_letter(line, 'Z')) return {Dialect::mach3, "G31"};
  if ((has_word(line, 'G', "41") || has_word(line, 'G', "42")) && has_letter(line, 'P'))
    return {Dialect::mach3, "G41 P"};
  return {};
}

/// N3 G1 X5*71
bool has_checksum(std::string_view written) {
  const std::size_t star = written.find_last_of('*');
  if (star == std::string_view::npos || written.find_first_of(";([#") != std::string_view::npos) return false;
  const std::string_view digits = written.substr(star + 1);
  return !digits.empty() && is_digit(digits[0]) &&
         digits.find_first_not_of("0123456789 \r") == std::string_view::npos;
}

Found sign_of(std::string_view written) {
  const std::string line = plain_words(written);
  for (const auto rule : {&sign_of_haas, &sign_of_fanuc, &sign_of_printer, &sign_of_hobby}) {
    const Found found = rule(line);
    if (found.dialect != Dialect::linuxcnc) return found;
  }
  if (has_checksum(written)) return {Dialect::marlin, "a checksum (*71)"};
  return {};
}

}  // namespace

std::optional<DialectSign> dialect_sign(std::uint32_t file, std::string_view text) {
  std::optional<DialectSign> first;
  for (std::uint32_t number = 1; !text.empty() && number <= kMostSignLines; ++number) {
    const std::string_view written = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(written.size() + 1, text.size()));
    const Found found = sign_of(written);
    if (found.dialect == Dialect::linuxcnc) continue;
    const DialectSign sign{found.dialect, found.what, {file, number, 1, 1}};
    // what Fanuc writes Haas reads too; what Haas alone has decides
    if (!first) first = sign;
    if (first->dialect != Dialect::fanuc || sign.dialect == Dialect::haas)
      return sign.dialect == Dialect::haas ? sign : first;
  }
  return first;
}

void recognise_dialect(const SourceSet& sources, std::uint32_t file, Reading& reading,
                       Diagnostics& diagnostics) {
  const std::optional<DialectSign> sign = dialect_sign(file, sources[file].text());
  reading.dialect = sign ? sign->dialect : Dialect::linuxcnc;
  reading.dialect_said = true;
  const std::string_view word = kDialects.word(reading.dialect);
  Diagnostic d = problem(Code::dialect_recognised, sign ? sign->place : Span{file, 1, 1, 1},
                         sign ? fmt::format("read as {}: here stands {}", word, sign->what)
                              : fmt::format("read as {}: no sign of another dialect", word));
  d.severity = Severity::note;
  diagnostics.add(std::move(d));
}

void suggest_dialect(const SourceSet& sources, std::uint32_t file, Diagnostics& diagnostics) {
  const bool other_kind = std::any_of(
      diagnostics.list().begin(), diagnostics.list().end(),
      [](const Diagnostic& d) { return d.code == Code::kind_other || d.code == Code::encoding_other; });
  const std::optional<DialectSign> sign = dialect_sign(file, sources[file].text());
  if (other_kind || !sign) return;
  Diagnostic d = problem(Code::dialect_recognised, sign->place,
                         fmt::format("this looks like {}: {}", kDialects.word(sign->dialect), sign->what),
                         fmt::format("--dialect {}", kDialects.word(sign->dialect)));
  d.severity = Severity::note;
  diagnostics.add(std::move(d));
}

}  // namespace kadr::gcode
