#include "gcode/read/scanner.h"

#include <array>
#include <charconv>
#include <cstddef>
#include <limits>
#include <string>

namespace kadr::gcode {
namespace {

constexpr std::uint64_t kExactMantissa = 1ULL << 53;  // integers up to here are exact as double
constexpr int kMaxFastDigits = 18;                    // fit in 64 bits
constexpr std::ptrdiff_t kMaxPlainDigits = 15;        // their integer is exact as double

// powers of ten that are exact as double
constexpr std::array<double, 19> kPowersOfTen = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8, 1e9,
                                                 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18};

/// Reads the digits at `at`; returns the position after them.
const char* read_digits(const char* at, const char* end, std::uint64_t& mantissa) {
  for (; at < end && is_digit(*at); ++at) mantissa = mantissa * 10 + static_cast<std::uint64_t>(*at - '0');
  return at;
}

}  // namespace

bool Cursor::read_plain_number(double& value) {
  const char* const end = text_.data() + text_.size();
  const char* at = text_.data() + at_;
  const bool negative = at < end && *at == '-';
  if (negative) ++at;
  std::uint64_t mantissa = 0;
  const char* const whole = at;
  at = read_digits(at, end, mantissa);
  std::ptrdiff_t digits = at - whole;
  std::ptrdiff_t decimals = 0;
  if (at < end && *at == '.') {
    const char* const point = at++;
    at = read_digits(at, end, mantissa);
    decimals = at - point - 1;
    digits += decimals;
  }
  if (digits == 0 || digits > kMaxPlainDigits) return false;
  // a number may continue after a blank
  const char* next = at;
  while (next < end && is_blank(*next)) ++next;
  if (next < end && (is_digit(*next) || *next == '.' || *next == ',')) return false;
  const double magnitude = static_cast<double>(mantissa) / kPowersOfTen[static_cast<std::size_t>(decimals)];
  value = negative ? -magnitude : magnitude;
  at_ = static_cast<std::uint32_t>(at - text_.data());
  return true;
}

NumberResult Cursor::read_number(double& value, Bytes& bytes, bool comma_ends) {
  char c = peek();
  bytes.begin = at_;
  const bool negative = c == '-';
  if (c == '-' || c == '+') {
    advance();
    c = peek();
  }
  std::uint64_t mantissa = 0;
  int digits = 0;
  int decimals = 0;
  bool point = false;
  std::uint32_t end = at_;  // after the last character that belongs to the number
  for (;;) {
    if (is_digit(c)) {
      if (digits < kMaxFastDigits) mantissa = mantissa * 10 + static_cast<std::uint64_t>(c - '0');
      ++digits;
      decimals += point ? 1 : 0;
    } else if (c == '.') {
      if (point) {
        bytes = {at_, at_ + 1};
        return NumberResult::second_point;
      }
      point = true;
    } else {
      break;
    }
    end = ++at_;
    c = peek();
  }
  if (digits == 0) {
    bytes.end = end > bytes.begin ? end : bytes.begin + 1;
    return NumberResult::no_digits;
  }
  if (c == ',' && !comma_ends && Cursor(text_, at_ + 1).begins_digit()) {
    bytes.end = at_ + 1;
    return NumberResult::decimal_comma;
  }
  at_ = end;
  bytes.end = end;
  if (digits > kMaxFastDigits || mantissa > kExactMantissa) return read_long_number(value, bytes);
  // both operands are exact, so the quotient is the correctly rounded value
  const double magnitude = static_cast<double>(mantissa) / kPowersOfTen[static_cast<std::size_t>(decimals)];
  value = negative ? -magnitude : magnitude;
  return NumberResult::good;
}

NumberResult Cursor::read_long_number(double& value, Bytes bytes) {
  std::string digits;
  for (std::uint32_t i = bytes.begin; i < bytes.end; ++i) {
    if (!is_blank(text_[i]) && text_[i] != '+') digits += text_[i];
  }
  const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  // without an exponent a number can only be too large, never unreadable
  if (result.ec != std::errc()) value = std::numeric_limits<double>::infinity();
  return NumberResult::good;
}

}  // namespace kadr::gcode
