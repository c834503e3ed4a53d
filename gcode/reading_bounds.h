#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kadr::gcode {

/// Bounds that a program may not exceed; each message names the setting. 0: no bound. Every program ends under the
/// defaults, in memory that does not depend on what it loops over; they let through what post-processors write:
/// any number of lines that each run once.
struct ReadingBounds {
  /// Blocks made. Nothing: kBlocks and, for each line of the program and of the files that it calls, one, or
  /// kBlocksOfLine without O words.
  std::optional<std::uint64_t> blocks;
  /// Lines run, of a program with O words, M98 or M99. A line counts once per kLineWeight_bytes begun.
  std::uint64_t lines = 35'000'000;
  /// (MSG, ), (DEBUG, ), (PRINT, ) run, of a program with O words, M98 or M99; weighed as lines.
  std::uint64_t messages = 100'000;
  std::uint32_t call_depth = 100;          ///< nested calls
  std::uint64_t loop_passes = 10'000'000;  ///< passes of all loops together
  std::uint32_t nurbs_order = 16;          ///< L of G5.2: time per point grows with its square
  std::uint64_t file_bytes = 1ULL << 30;   ///< of the program and of each file that it calls: held in memory
  std::uint32_t line_bytes = 1U << 20;

  static constexpr std::uint64_t kBlocks = 3'000'000;  // 720 B each in `kadr check`: 2.2 GB
  static constexpr std::uint64_t kBlocksOfLine = 16;   // of a program that runs each line once
  static constexpr std::size_t kLineWeight_bytes = 256;
};

/// How often a line or message of that many bytes counts.
constexpr std::uint64_t weight_of(std::size_t bytes) {
  return bytes == 0 ? 1 : 1 + (bytes - 1) / ReadingBounds::kLineWeight_bytes;
}

/// A bound for people.
struct BoundEntry {
  std::string name;
  std::string normal;  ///< the default
  std::string bounds;  ///< what it bounds
};
/// The bounds that --limit takes, in the order of ReadingBounds.
std::vector<BoundEntry> bound_entries();
std::vector<std::string> bound_names();
/// Sets a bound by its name. @return false if there is no such bound or the value is beyond its type
bool set_bound(ReadingBounds& bounds, std::string_view name, std::uint64_t value);

}  // namespace kadr::gcode
