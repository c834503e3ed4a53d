#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace kadr {

/// Reads a decimal number that is the whole text, whatever the locale: sign, digits with `_` between digits,
/// a dot, an exponent: "-1_000.5", ".5", "2e4". A decimal comma, blanks, hexadecimal, "inf" and "nan" are not
/// numbers, nor is a value too large for a double. Correctly rounded.
std::optional<double> parse_number(std::string_view text);

/// Shortest text that reads back as the same double: "0.0025", "1000000", "1e-08", "1e+16", "inf".
std::string number_text(double value);

}  // namespace kadr
