#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace kadr {

/// One decoded code point: its value and how many bytes it took (>= 1).
struct CodePoint {
  char32_t value;  ///< U+FFFD for a byte that is not UTF-8
  std::size_t bytes;
};
/// Decodes the code point that begins at text[at]; a byte that is not UTF-8 counts as one code point by
/// itself.
/// @pre at < text.size()
CodePoint decode_utf8(std::string_view text, std::size_t at);
/// True if every byte belongs to a well-formed UTF-8 sequence.
bool is_utf8(std::string_view text);
/// Number of code points in the text.
std::size_t count_code_points(std::string_view text);
/// Terminal columns of a code point: 0 for combining marks, 2 for East Asian wide forms, 1 otherwise.
int display_width(char32_t code_point);
/// The text as a terminal may show it: tabs expanded to columns of 8 (counted from `column`), control
/// characters and bytes that are not UTF-8 replaced by U+FFFD.
/// @param column  display column at which the text begins; moved to where it ends
std::string displayable(std::string_view text, std::size_t& column);

}  // namespace kadr
