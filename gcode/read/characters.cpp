#include <fmt/format.h>

#include <optional>
#include <string_view>

#include "gcode/read/parser.h"
#include "machine/base/utf8.h"

/// Characters of other alphabets and of typesetting, which editors and web pages put where a program has plain ones.
namespace kadr::gcode {
namespace {

struct Lookalike {
  char32_t character;
  std::string_view name;
  std::string_view meant;  ///< what to write
};

constexpr std::string_view kMinus = "write - (the hyphen of the keyboard)";
constexpr std::string_view kBlank = "write a blank";
constexpr Lookalike kLookalikes[] = {
    {U'\u2212', "a minus sign of typesetting", kMinus},
    {U'\u2010', "a hyphen of typesetting", kMinus},
    {U'\u2011', "a non-breaking hyphen", kMinus},
    {U'\u2012', "a figure dash", kMinus},
    {U'\u2013', "an en dash", kMinus},
    {U'\u2014', "an em dash", kMinus},
    {U'\uFE63', "a small hyphen-minus", kMinus},
    {U'\uFF0D', "a wide hyphen-minus", kMinus},
    {U'\u00AD', "a soft hyphen, which is not shown", "remove it"},
    {U'\u00A0', "a no-break space", kBlank},
    {U'\u2007', "a figure space", kBlank},
    {U'\u2009', "a thin space", kBlank},
    {U'\u202F', "a narrow no-break space", kBlank},
    {U'\u3000', "a wide space", kBlank},
    {U'\u200B', "a space of no width, which is not shown", "remove it"},
    {U'\uFEFF', "a byte order mark inside the file", "remove it: two files were put together here"},
    {U'\u00D7', "a multiplication sign", "write *"},
    {U'\u201A', "a quotation mark that looks like a comma", "the decimal mark is a point"},
    {U'\uFF0C', "a wide comma", "the decimal mark is a point"},
    {U'\uFF0E', "a wide point", "write . (the point of the keyboard)"},
};

struct Twin {
  char32_t letter;
  char latin;
};
/// Letters that look like Latin ones and come from another keyboard layout.
constexpr Twin kTwins[] = {{U'А', 'A'}, {U'В', 'B'}, {U'С', 'C'}, {U'Е', 'E'}, {U'Н', 'H'},
                           {U'К', 'K'}, {U'М', 'M'}, {U'О', 'O'}, {U'Р', 'P'}, {U'Т', 'T'},
                           {U'Х', 'X'}, {U'У', 'Y'}, {U'а', 'A'}, {U'с', 'C'}, {U'е', 'E'},
                           {U'к', 'K'}, {U'м', 'M'}, {U'р', 'P'}, {U'х', 'X'}, {U'у', 'Y'}};

Diagnostic foreign_character(const Line& line, std::uint32_t at) {
  const CodePoint point = decode_utf8(line.text, at);
  const Span span = line.span({at, at + static_cast<std::uint32_t>(point.bytes)});
  if (point.bytes == 1) {
    return problem(Code::bad_character, span,
                   fmt::format("byte 0x{:02X} is not UTF-8", static_cast<unsigned char>(line.text[at])),
                   "if the file is in cp1251, convert it with `iconv -f cp1251 -t utf-8`");
  }
  const std::string number = fmt::format("U+{:04X}", static_cast<std::uint32_t>(point.value));
  for (const Twin& twin : kTwins) {
    if (twin.letter != point.value) continue;
    return problem(Code::bad_character, span, fmt::format("this is a Cyrillic letter ({})", number),
                   fmt::format("type a Latin {}", twin.latin));
  }
  for (const Lookalike& known : kLookalikes) {
    if (known.character != point.value) continue;
    return problem(Code::bad_character, span, fmt::format("this is {} ({})", known.name, number),
                   std::string(known.meant));
  }
  return problem(Code::bad_character, span, fmt::format("{} is not allowed here", number));
}

}  // namespace

Diagnostic character_problem(const Line& line, std::uint32_t at) {
  const auto byte = static_cast<unsigned char>(line.text[at]);
  if (byte >= 0x80) return foreign_character(line, at);
  const Span span = line.span({at, at + 1});
  if (byte < 0x20 || byte == 0x7F)
    return problem(Code::bad_character, span, fmt::format("control character 0x{:02X}", byte));
  return problem(Code::bad_character, span, fmt::format("{} is not allowed here", line.text[at]));
}

}  // namespace kadr::gcode
