#include "gcode/message.h"

#include <fmt/format.h>

#include <charconv>

#include "gcode/predefined.h"
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

namespace {

/// What a named parameter reads, ###### if it was never set.
std::string named_value(const State& state, std::int32_t name, std::uint32_t line) {
  if (is_predefined(name)) return fmt::format("{:.6f}", read_predefined(state, name, line));
  const double* value = find_named(state, name);
  return value ? fmt::format("{:.6f}", *value) : "######";
}

}  // namespace

std::string expanded_text(std::string_view text, State& state, std::uint32_t line) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] != '#') {
      out += text[at++];
      continue;
    }
    const std::size_t close = text.find('>', at);
    if (at + 1 < text.size() && text[at + 1] == '<' && close != std::string_view::npos) {
      out += named_value(state, state.names.number(text.substr(at + 2, close - at - 2)), line);
      at = close + 1;
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
