#pragma once
#include <cstddef>
#include <cstdint>
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

}  // namespace kadr
