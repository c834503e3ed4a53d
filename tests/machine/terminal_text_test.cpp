#include "machine/base/terminal_text.h"

#include <doctest/doctest.h>

#include <string>

#include "machine/base/utf8.h"

using namespace kadr;

namespace {

const std::string kMark = "\xEF\xBF\xBD";

std::string utf8(char32_t c) {
  const auto byte = [](char32_t b) { return static_cast<char>(static_cast<unsigned char>(b)); };
  if (c < 0x80) return {byte(c)};
  if (c < 0x800) return {byte(0xC0 | (c >> 6)), byte(0x80 | (c & 0x3F))};
  if (c < 0x10000) return {byte(0xE0 | (c >> 12)), byte(0x80 | ((c >> 6) & 0x3F)), byte(0x80 | (c & 0x3F))};
  return {byte(0xF0 | (c >> 18)), byte(0x80 | ((c >> 12) & 0x3F)), byte(0x80 | ((c >> 6) & 0x3F)),
          byte(0x80 | (c & 0x3F))};
}

/// What a terminal acts on: control characters, ends of lines and marks of direction.
bool acts(char32_t c) {
  return c < 0x20 || (c >= 0x7F && c <= 0x9F) || c == 0x61C || c == 0x200E || c == 0x200F || c == 0x2028 ||
         c == 0x2029 || (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x206F);
}

/// What looks like nothing, so that two names which differ look the same.
bool looks_like_nothing(char32_t c) {
  return c == 0xAD || c == 0x200B || (c >= 0x2060 && c <= 0x2065) || c == 0xFEFF ||
         (c >= 0xE0000 && c <= 0xE007F);
}

std::size_t width_of(std::string_view text) {
  std::size_t columns = 0;
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint c = decode_utf8(text, at);
    columns += static_cast<std::size_t>(display_width(c.value));
    at += c.bytes;
  }
  return columns;
}

}  // namespace

TEST_CASE("a terminal is shown no code point that it acts on or shows as nothing; each takes one column") {
  std::size_t hidden = 0;
  for (char32_t c = 0; c <= 0x10FFFF; ++c) {
    if (c >= 0xD800 && c <= 0xDFFF) continue;
    const std::string text = "a" + utf8(c) + "b";
    const std::string line = displayable(text), lines = shown_text(text);
    const bool shown = may_be_shown(c);
    bool good = !(shown && (acts(c) || looks_like_nothing(c)));
    if (!shown) ++hidden;
    if (c == '\t')
      good = good && line == "a       b" && lines == text;
    else if (c == '\n')
      good = good && line == "a" + kMark + "b" && lines == text;
    else
      good = good && line == (shown ? text : "a" + kMark + "b") && lines == line;
    // the width before is the width after, and that of what is shown
    std::size_t columns = 0;
    displayable(text, columns);
    good = good && columns == width_of(line) && (c == '\t' || width_of(text) == columns);
    good = good && (shown_bytes(text) == text.size()) == (lines == text);
    if (!good) FAIL_CHECK("code point ", static_cast<std::uint32_t>(c));
  }
  // 65 control characters, 4096 tags and annotations, and some dozens more
  CHECK(hidden > 4096 + 65);
  CHECK(hidden < 4096 + 150);
}

TEST_CASE("words of any script, emoji and box drawings are shown as they are") {
  for (const std::string text : {"деталь №5", "部品 ー 加工", "قطعة", "חלק", "भाग", "é e\xCC\x81",
                                 "👩‍🔧 ⚙️", "│ ┤ ███░ ⣿", "ø 5 µm ± 0,1 °"}) {
    CHECK(shown_text(text) == text);
    CHECK(displayable(text) == text);
  }
}

TEST_CASE("bytes that are not UTF-8 are shown as marks, wherever they stand") {
  // raw C1, an overlong ESC, a surrogate, half a letter, beyond Unicode
  for (const std::string bad :
       {"\x9B", "\xC0\x9B", "\xED\xA0\x80", "\xD0", "\xF4\x90\x80\x80", "\x1b", "\x7F"})
    for (std::size_t at = 0; at < 100; ++at) {
      std::string text(100, 'x');
      text.insert(at, bad);
      std::string expected(100, 'x');
      for (std::size_t i = 0; i < bad.size(); ++i) expected.insert(at, kMark);
      CHECK(shown_text(text) == expected);
      CHECK(shown_bytes(text) == at);
    }
}

TEST_CASE("of sequences only those of our colours stay, and only where a message is coloured") {
  const std::string coloured = std::string(style::kError) + "error" + std::string(style::kOff) + "\n";
  CHECK(shown_text(coloured, Styles::kept) == coloured);
  CHECK(shown_text(coloured) == kMark + "[1;31merror" + kMark + "[0m\n");
  for (const char* other : {"\x1b[31mx", "\x1b[2J", "\x1b]0;x\x07", "\x1b[1;31", "\x1b"}) {
    const std::string shown = shown_text(other, Styles::kept);
    CHECK(shown.find('\x1b') == std::string::npos);
    CHECK(shown.substr(0, 3) == kMark);
  }
}
