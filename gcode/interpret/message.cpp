#include "gcode/interpret/message.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "gcode/interpret/macro_variables.h"
#include "gcode/interpret/predefined.h"
#include "gcode/read/scanner.h"
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

constexpr int kDecimals = 6;          // of a value without a format before it
constexpr double kLeastShown = 1e-4;  // values closer to 0 are printed as 0
constexpr int kDecimalsOfF = 4;       // %f
constexpr const char* kUnset = "######";

/// Expands one text from left to right; a format applies to every value after it.
class Expansion {
 public:
  Expansion(std::string_view text, State& state, std::uint32_t line)
      : text_(text), state_(state), line_(line) {}

  std::string run() {
    while (at_ < text_.size()) {
      if (text_[at_] == '%' && format()) continue;
      if (text_[at_] == '#' && (named() || numbered())) continue;
      out_ += text_[at_++];
    }
    return valid_text(out_);
  }

 private:
  char ahead(std::size_t n) const { return at_ + n < text_.size() ? text_[at_ + n] : '\0'; }
  /// %d, %f and %.0f to %.9f; anything else is text.
  bool format() {
    if (ahead(1) == 'd') return take_format(2, 0);
    if (ahead(1) == 'f') return take_format(2, kDecimalsOfF);
    if (ahead(1) == '.' && is_digit(ahead(2)) && ahead(3) == 'f') return take_format(4, ahead(2) - '0');
    return false;
  }
  bool take_format(std::size_t length, int decimals) {
    decimals_ = decimals;
    at_ += length;
    return true;
  }
  /// #<name>
  bool named() {
    const std::size_t close = text_.find('>', at_);
    if (ahead(1) != '<' || close == std::string_view::npos) return false;
    const std::int32_t name = state_.names.number(text_.substr(at_ + 2, close - at_ - 2));
    const double* value = is_predefined(name) ? nullptr : find_named(state_, name);
    if (is_predefined(name)) {
      put(read_predefined(state_, name, line_));
    } else if (value != nullptr) {
      put(*value);
    } else {
      out_ += kUnset;
    }
    at_ = close + 1;
    return true;
  }
  /// #5
  bool numbered() {
    std::size_t end = at_ + 1;
    while (end < text_.size() && is_digit(text_[end])) ++end;
    if (end == at_ + 1) return false;
    int number = 0;
    const auto result = std::from_chars(text_.data() + at_ + 1, text_.data() + end, number);
    if (result.ec == std::errc() && number >= parameter::kFirst && number <= parameter::kLast) {
      put(read_parameter(state_, number));
    } else {
      out_ += kUnset;
    }
    at_ = end;
    return true;
  }
  void put(double value) {
    if (is_vacant(value)) {
      out_ += kUnset;
      return;
    }
    out_ += fmt::format("{:.{}f}", std::fabs(value) < kLeastShown ? 0.0 : value, decimals_);
  }

  std::string_view text_;
  State& state_;
  std::uint32_t line_;
  std::size_t at_ = 0;
  int decimals_ = kDecimals;
  std::string out_;
};

}  // namespace

std::string expanded_text(std::string_view text, State& state, std::uint32_t line) {
  return Expansion(text, state, line).run();
}

}  // namespace kadr::gcode
