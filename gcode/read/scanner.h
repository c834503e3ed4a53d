#pragma once
#include <cstdint>
#include <string_view>

#include "gcode/read/tree.h"

/// Characters and numbers of a line. Blanks (space and tab) mean nothing anywhere, even inside a number: "X1
/// 2 . 5" is X12.5.
namespace kadr::gcode {

/// A carriage return counts as blank, as at the end of a CR LF line.
constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }
constexpr char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

/// Result of reading a number.
enum class NumberResult : std::uint8_t {
  good,
  no_digits,      ///< "-", "." or nothing
  second_point,   ///< 1.2.3
  decimal_comma,  ///< 1,5
};

/// Reads a line from left to right, skipping blanks.
class Cursor {
 public:
  explicit Cursor(std::string_view text, std::uint32_t at = 0) : text_(text), at_(at) {}

  /// Next character that is not blank, '\0' at the end (a NUL byte in the text reads the same; at_end() tells).
  char peek() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  /// @pre peek() was called and the line does not end here
  void advance() { ++at_; }
  bool at_end() {
    peek();
    return at_ >= text_.size();
  }
  bool begins_digit() { return is_digit(peek()); }
  std::uint32_t at() const { return at_; }
  void go_to(std::uint32_t at) { at_ = at; }
  std::string_view text() const { return text_; }

  /// Reads a number written without blanks and of few digits, which nearly all are, to the value that
  /// read_number() gives. False, with the cursor unchanged, if it is more complicated.
  bool read_plain_number(double& value);
  /// Reads sign, digits, point, digits. Correctly rounded. The cursor is left after the number.
  /// @param bytes  position of the number; on failure, of the offending sign
  /// @param comma_ends  a comma separates two numbers; it is no decimal mark
  NumberResult read_number(double& value, Bytes& bytes, bool comma_ends = false);

 private:
  NumberResult read_long_number(double& value, Bytes bytes);

  std::string_view text_;
  std::uint32_t at_ = 0;
};

}  // namespace kadr::gcode
