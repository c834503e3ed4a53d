#include "machine/base/parse_number.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace kadr {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Copies digits to `out`; a `_` must stand between two digits. Returns how many digits, or -1.
int copy_digits(std::string_view& text, std::string& out) {
  int count = 0;
  while (!text.empty() && (is_digit(text.front()) || text.front() == '_')) {
    if (text.front() == '_') {
      if (count == 0 || text.size() < 2 || !is_digit(text[1])) return -1;
    } else {
      out += text.front();
      ++count;
    }
    text.remove_prefix(1);
  }
  return count;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  std::string plain;
  plain.reserve(text.size());
  const auto sign = [&] {
    if (text.empty() || (text.front() != '-' && text.front() != '+')) return;
    if (text.front() == '-') plain += '-';
    text.remove_prefix(1);
  };
  sign();
  const int whole = copy_digits(text, plain);
  int fraction = 0;
  if (whole >= 0 && !text.empty() && text.front() == '.') {
    if (whole == 0) plain += '0';
    plain += '.';
    text.remove_prefix(1);
    fraction = copy_digits(text, plain);
  }
  if (whole < 0 || fraction < 0 || whole + fraction == 0) return std::nullopt;
  if (!text.empty() && (text.front() == 'e' || text.front() == 'E')) {
    plain += 'e';
    text.remove_prefix(1);
    sign();
    if (copy_digits(text, plain) <= 0) return std::nullopt;
  }
  if (!text.empty()) return std::nullopt;

  double value = 0;
  const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  if (error == std::errc::result_out_of_range) {
    // too small is zero, too large is no number: the exponent's sign tells them apart
    const auto e = plain.find('e');
    const bool tiny =
        e != std::string::npos ? plain[e + 1] == '-' : plain.find_first_of("123456789") > plain.find('.');
    return tiny ? std::optional<double>(plain.front() == '-' ? -0.0 : 0.0) : std::nullopt;
  }
  if (error != std::errc{} || end != plain.data() + plain.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::string number_text(double value) { return fmt::format("{}", value); }

}  // namespace kadr
