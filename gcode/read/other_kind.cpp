#include "gcode/read/other_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "gcode/read/report.h"
#include "gcode/read/scanner.h"

namespace kadr::gcode {
namespace {

constexpr std::size_t kMostLines = 2000;
constexpr std::size_t kMostColumns = 200;  // of a line
constexpr std::size_t kEncodingBytes = 256;

/// Capital letters without blanks, line number and remark: "N10 g1 x1 (a) ; b" is "G1X1(A)".
std::string plain(std::string_view line) {
  std::string out;
  for (const char c : line.substr(0, kMostColumns)) {
    if (c == ';') break;
    if (!is_blank(c)) out += upper(c);
  }
  if (out.empty() || out.front() != 'N') return out;
  return out.substr(std::min(out.find_first_not_of("0123456789", 1), out.size()));
}

bool has(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }
bool begins(std::string_view text, std::string_view head) { return text.substr(0, head.size()) == head; }
/// `head` at the beginning, with a digit behind it.
bool begins_number(std::string_view text, std::string_view head) {
  return begins(text, head) && text.size() > head.size() && is_digit(text[head.size()]);
}
/// `part` somewhere, with a digit or a sign behind it.
bool has_number(std::string_view text, std::string_view part) {
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) {
    const char next = at + part.size() < text.size() ? text[at + part.size()] : '\0';
    if (is_digit(next) || next == '-' || next == '.') return true;
  }
  return false;
}

/// A move or G92 with the filament's axis E. Only M66 to M68, G33 and G76 read an E for kadr.
bool is_slicer(std::string_view line) {
  constexpr std::array<std::string_view, 5> kMoves = {"G0", "G1", "G2", "G3", "G92"};
  if (!has_number(line, "E") || line.find_first_of("M#[(") != std::string_view::npos) return false;
  return std::any_of(kMoves.begin(), kMoves.end(), [&](std::string_view code) {
    return begins(line, code) && line.size() > code.size() && is_letter(line[code.size()]);
  });
}

bool is_sinumerik(std::string_view line) {
  constexpr std::array<std::string_view, 9> kHeads = {
      "DEFREAL", "DEFINT", "DEFBOOL", "DEFSTRING", "DEFAXIS", "EXTERNPROC", "WORKPIECE(", "MSG(", "PROC"};
  const auto at_head = [&](std::string_view head) { return begins(line, head); };
  const bool assigns = begins(line, "G") && (has(line, "X=") || has(line, "Y=") || has(line, "Z="));
  return std::any_of(kHeads.begin(), kHeads.end(), at_head) || begins_number(line, "CYCLE") ||
         has(line, "T=\"") || has(line, "GOTOF") || has(line, "GOTOB") || assigns;
}

bool is_heidenhain(std::string_view line) {
  // blocks are numbered without a letter: 0 BEGIN PGM PART MM
  line.remove_prefix(std::min(line.find_first_not_of("0123456789"), line.size()));
  return begins(line, "BEGINPGM") || begins(line, "TOOLCALL") || begins(line, "TOOLDEF") ||
         begins(line, "CYCLDEF") || begins(line, "BLKFORM");
}

bool is_macro(std::string_view line) {
  const bool condition = begins(line, "IF[") && (has(line, "GOTO") || has(line, "THEN"));
  return condition || (begins(line, "WHILE[") && has_number(line, "]DO")) || begins_number(line, "GOTO");
}

}  // namespace

std::optional<OtherKind> other_kind(std::string_view text, bool macros) {
  for (std::size_t count = 0; !text.empty() && count < kMostLines; ++count) {
    const std::string_view written = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(written.size() + 1, text.size()));
    const std::string line = plain(written);
    if (is_slicer(line))
      return OtherKind{"a slicer's file for a 3D printer: E moves the filament",
                       "kadr has no extruder: take the E words out to see the motion; --dialect marlin tells "
                       "the heater's M codes once"};
    if (is_sinumerik(line))
      return OtherKind{"a program in Sinumerik's language (Siemens)",
                       "let the postprocessor write ISO code (G291 mode), or use one for LinuxCNC"};
    if (is_heidenhain(line))
      return OtherKind{"a program in Heidenhain's language",
                       "let the postprocessor write ISO code (DIN/ISO)"};
    if (!macros && is_macro(line))
      return OtherKind{
          "a Fanuc or Haas macro (macro B: IF .. GOTO, WHILE .. DO)",
          "--dialect fanuc or --dialect haas reads it; LinuxCNC has O words: O1 if [#1 LT 5] ... O1 endif"};
  }
  return std::nullopt;
}

std::string_view other_encoding(std::string_view text) {
  if (begins(text, std::string_view("\xFF\xFE\0\0", 4)) || begins(text, std::string_view("\0\0\xFE\xFF", 4)))
    return "UTF-32";
  if (begins(text, "\xFF\xFE") || begins(text, "\xFE\xFF")) return "UTF-16";
  const std::string_view head = text.substr(0, std::min(text.size(), kEncodingBytes) & ~std::size_t{1});
  std::array<std::size_t, 2> zeros{};
  for (std::size_t i = 0; i < head.size(); ++i) zeros[i % 2] += head[i] == '\0' ? 1 : 0;
  const std::size_t pairs = head.size() / 2;
  // of Latin letters one byte of each pair is zero, the other never
  const bool one_side = zeros[0] == 0 || zeros[1] == 0;
  return pairs >= 2 && one_side && 4 * (zeros[0] + zeros[1]) > 3 * pairs ? "UTF-16" : std::string_view();
}

std::optional<Diagnostic> encoding_problem(std::uint32_t file, std::string_view text) {
  const std::string_view encoding = other_encoding(text);
  if (encoding.empty()) return std::nullopt;
  return problem(Code::encoding_other, {file, 1, 1, 1}, fmt::format("the file is {}", encoding),
                 fmt::format("save it as UTF-8: iconv -f {} -t utf-8 part.ngc > part_utf8.ngc",
                             encoding == "UTF-16" ? "utf-16" : "utf-32"));
}

}  // namespace kadr::gcode
