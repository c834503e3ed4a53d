#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kadr::gcode {

/// Bounds that a program may not exceed; each message names the setting. 0: no bound.
struct ReadingBounds {
  std::uint64_t blocks = 0;
  std::uint32_t call_depth = 100;          ///< nested calls
  std::uint64_t loop_passes = 10'000'000;  ///< passes of all loops together
  std::uint64_t file_bytes = 4ULL << 30;   ///< of the program and of each file that it calls
  std::uint32_t line_bytes = 1U << 20;
};

/// The names that --limit takes, in the order of ReadingBounds.
std::vector<std::string> bound_names();
/// Sets a bound by its name. @return false if there is no such bound or the value is beyond its type
bool set_bound(ReadingBounds& bounds, std::string_view name, std::uint64_t value);

}  // namespace kadr::gcode
