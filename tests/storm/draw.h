#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "machine/base/numbers.h"
#include "tests/gcode/support.h"

namespace kadr::storm {

/// splitmix64 of a number: neighbouring seeds begin unlike each other.
inline std::uint64_t mixed(std::uint64_t number) {
  std::uint64_t z = number + 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

/// What a case is drawn from: the same draws on every machine, by integers and exact functions alone. One draw a statement:
/// the order of arguments is the compiler's choice (that of a braced list is not).
class Draw : public gcode::test::Random {
 public:
  explicit Draw(std::uint64_t seed) : Random(mixed(seed)) {}

  int whole(int low, int high) {
    return low + static_cast<int>(below(static_cast<std::uint64_t>(high - low + 1)));
  }
  /// Spread evenly over the decades.
  double decades(double low, double high) { return exact_exp(real(exact_log(low), exact_log(high))); }
  template <class T>
  T pick(std::initializer_list<T> choices) {
    return *(choices.begin() + below(choices.size()));
  }
  char letter_of(const std::string& letters) { return letters[below(letters.size())]; }
  /// true or false, as TOML has it.
  const char* flag(double p) { return chance(p) ? "true" : "false"; }
};

/// A number of about `digits` significant digits and no exponent, as G-code and TOML both read it.
inline std::string plain(double value, int digits = 5) {
  int decimals = digits;
  for (double size = value < 0 ? -value : value; size >= 1 && decimals > 0; size /= 10) --decimals;
  for (double size = value < 0 ? -value : value; size > 0 && size < 0.1 && decimals < 12; size *= 10)
    ++decimals;
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

}  // namespace kadr::storm
