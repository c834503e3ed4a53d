#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace kadr::machine {

/// Places in a text as toml++ counts them, line and code point from 1, turned into bytes. Places of one line cost a
/// constant time each, in any order, however long the line is.
class TomlPlaces {
 public:
  /// @param text  outlives this
  explicit TomlPlaces(std::string_view text);
  /// Without its line end; empty beyond the end.
  std::string_view line(std::uint32_t number) const;
  /// Byte column from 1 of a code point; behind the end of the line the column behind its last byte.
  std::uint32_t byte_column(std::uint32_t line, std::uint32_t code_point_column);

 private:
  void mark(std::uint32_t line);

  std::string_view text_;
  std::vector<std::size_t> starts_;  ///< [lines]
  std::uint32_t marked_ = 0;         ///< the line of marks_
  std::vector<std::size_t> marks_;   ///< bytes before every 64th code point of that line
};

/// Most parts of a dotted key or table header. toml++ and the tree are walked as deep as keys and values nest.
inline constexpr std::size_t kMostKeyParts = 16;
/// Most arrays and inline tables within each other.
inline constexpr std::size_t kMostNestedValues = 32;

/// A dotted key or header with more than kMostKeyParts parts, or a value within more than kMostNestedValues others.
struct TooDeep {
  enum class Kind : std::uint8_t { key, value };
  Kind kind = Kind::key;
  std::uint32_t line = 0;
  std::size_t begin = 0;  ///< byte of the line, from 0
  std::size_t length = 0;
  std::size_t levels = 0;
};
/// The first one of a text, whether the rest of it is TOML or not.
std::optional<TooDeep> find_too_deep(std::string_view text);

}  // namespace kadr::machine
