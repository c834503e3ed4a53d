#include "machine/base/terminal_text.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "machine/base/utf8.h"

namespace kadr {
namespace {

constexpr std::string_view kShownInstead = "\xEF\xBF\xBD";
constexpr std::size_t kTabStop_columns = 8;

struct CodeRange {
  char32_t first, last;
};

/// Not shown, ascending: Cc, Zl and Zp, and Default_Ignorable_Code_Point of Unicode 15.1 (with all marks of direction)
/// but for joiners and variation selectors; U+FFF9..FFFB frame annotations that a terminal does not know.
constexpr CodeRange kNotShown[] = {
    {0x0000, 0x001F},    // C0
    {0x007F, 0x009F},    // DEL, C1
    {0x00AD, 0x00AD},    // soft hyphen
    {0x034F, 0x034F},    // combining grapheme joiner
    {0x061C, 0x061C},    // Arabic letter mark
    {0x115F, 0x1160},    // Hangul fillers
    {0x17B4, 0x17B5},    // Khmer inherent vowels
    {0x180B, 0x180F},    // Mongolian selectors and vowel separator
    {0x200B, 0x200B},    // zero-width space
    {0x200E, 0x200F},    // left-to-right and right-to-left mark
    {0x2028, 0x202E},    // line and paragraph separator; embeddings and overrides
    {0x2060, 0x206F},    // word joiner, invisible operators, isolates
    {0x3164, 0x3164},    // Hangul filler
    {0xFEFF, 0xFEFF},    // byte-order mark
    {0xFFA0, 0xFFA0},    // halfwidth Hangul filler
    {0xFFF0, 0xFFFB},    // annotations
    {0x1BCA0, 0x1BCA3},  // shorthand format controls
    {0x1D173, 0x1D17A},  // musical format controls
    {0xE0000, 0xE0FFF},  // tags
};

/// ASCII that stays in a text of several lines.
bool is_plain(char c) { return (c >= 0x20 && c < 0x7F) || c == '\n' || c == '\t'; }

/// True if a line, or a part of one, is ASCII without control characters: most are. Tabs make it false.
bool is_printable(std::string_view line) {
  constexpr std::uint64_t kOnes = 0x0101010101010101U, kHighBits = 0x80 * kOnes;
  std::uint64_t seen = 0, eight = 0;
  // a high bit appears above ASCII, in DEL + 1 and in what is below a blank; without these nothing carries over
  const auto look = [&](std::size_t at) {
    std::memcpy(&eight, line.data() + at, sizeof eight);
    seen |= eight | (eight + kOnes) | (eight - 0x20 * kOnes);
  };
  if (line.size() < sizeof eight)
    return std::all_of(line.begin(), line.end(), [](char c) { return c != '\t' && is_plain(c); });
  for (std::size_t at = 0; at + sizeof eight <= line.size(); at += sizeof eight) look(at);
  look(line.size() - sizeof eight);
  return (seen & kHighBits) == 0;
}

/// Number of bytes from `at` on that are ASCII and stay.
std::size_t plain_bytes(std::string_view text, std::size_t at) {
  constexpr std::size_t kWindow_bytes =
      128;  // so that a long line is not looked at from each of its letters on
  std::size_t end = at;
  while (end < text.size() && is_plain(text[end])) {
    const std::string_view window = text.substr(end, kWindow_bytes);
    const std::size_t line = window.find('\n');
    if (is_printable(window.substr(0, line)))
      end += line == std::string_view::npos ? window.size() : line + 1;
    else
      while (end < text.size() && is_plain(text[end]) && text[end] != '\n') ++end;
    while (end < text.size() && text[end] == '\n') ++end;
  }
  return end - at;
}

bool is_good(const CodePoint& c) {
  const bool broken = c.value == 0xFFFD && c.bytes == 1;
  return !broken && may_be_shown(c.value);
}

/// Length of the style that begins a text; 0: none does.
std::size_t style_bytes(std::string_view text) {
  for (const std::string_view s : style::kAll)
    if (text.starts_with(s)) return s.size();
  return 0;
}

}  // namespace

bool may_be_shown(char32_t c) {
  for (const CodeRange& range : kNotShown)
    if (c <= range.last) return c < range.first;
  return true;
}

int display_width(char32_t c) {
  const auto in = [c](char32_t low, char32_t high) { return c >= low && c <= high; };
  if (c < 0x300 || !may_be_shown(c)) return 1;
  if (in(0x300, 0x36F) || in(0x483, 0x489) || in(0x200C, 0x200D) || in(0x20D0, 0x20FF) || in(0xFE00, 0xFE0F))
    return 0;
  if (in(0x1100, 0x115F) || in(0x2E80, 0x303E) || in(0x3041, 0xA4CF) || in(0xAC00, 0xD7A3) ||
      in(0xF900, 0xFAFF) || in(0xFE30, 0xFE6F) || in(0xFF00, 0xFF60) || in(0xFFE0, 0xFFE6) ||
      in(0x1F300, 0x1FAFF) || in(0x20000, 0x3FFFD))
    return 2;
  return 1;
}

std::string displayable(std::string_view text, std::size_t& column) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint c = decode_utf8(text, at);
    if (c.value == '\t') {
      const std::size_t blanks = kTabStop_columns - column % kTabStop_columns;
      out.append(blanks, ' ');
      column += blanks;
    } else if (is_good(c)) {
      out += text.substr(at, c.bytes);
      column += static_cast<std::size_t>(display_width(c.value));
    } else {
      out += kShownInstead;
      column += 1;
    }
    at += c.bytes;
  }
  return out;
}

std::string displayable(std::string_view text) {
  std::size_t column = 0;
  return displayable(text, column);
}

std::size_t shown_bytes(std::string_view text) {
  std::size_t at = plain_bytes(text, 0);
  while (at < text.size()) {
    const CodePoint c = decode_utf8(text, at);
    if (!is_good(c)) break;
    at += c.bytes;
    at += plain_bytes(text, at);
  }
  return at;
}

void append_shown(std::string& out, std::string_view text, Styles styles) {
  for (;;) {
    const std::size_t shown = shown_bytes(text);
    out += text.substr(0, shown);
    text.remove_prefix(shown);
    if (text.empty()) return;
    const std::size_t kept = styles == Styles::kept ? style_bytes(text) : 0;
    out += kept > 0 ? text.substr(0, kept) : kShownInstead;
    text.remove_prefix(kept > 0 ? kept : decode_utf8(text, 0).bytes);
  }
}

std::string shown_text(std::string_view text, Styles styles) {
  std::string out;
  append_shown(out, text, styles);
  return out;
}

}  // namespace kadr
