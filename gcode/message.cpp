#include "gcode/message.h"

#include <fmt/format.h>

#include <charconv>

#include "gcode/scanner.h"
#include "machine/base/utf8.h"

namespace kadr::gcode {

std::string valid_text(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint point = decode_utf8(text, at);
    const bool bad = point.bytes == 1 && static_cast<unsigned char>(text[at]) >= 0x80;
    if (bad) {
      out += "\xEF\xBF\xBD";
    } else {
      out += text.substr(at, point.bytes);
    }
    at += point.bytes;
  }
  return out;
}

std::string expanded_text(std::string_view text, const State& state) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] != '#') {
      out += text[at++];
      continue;
    }
    std::size_t end = at + 1;
    while (end < text.size() && is_digit(text[end])) ++end;
    int number = 0;
    const auto result = std::from_chars(text.data() + at + 1, text.data() + end, number);
    const bool exists = result.ec == std::errc() && number >= parameter::kFirst && number <= parameter::kLast;
    out += exists ? fmt::format("{:.6f}", read_parameter(state, number))
                  : std::string(text.substr(at, end - at));
    at = end;
  }
  return valid_text(out);
}

}  // namespace kadr::gcode
