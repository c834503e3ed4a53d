#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

namespace kadr::planner {

/// Speed levels of one node: uniform from low to high, or in two uniform pieces that meet at a speed to be
/// kept as a level ("nominal kept"). One level where low = high.
struct LevelRange {
  std::int32_t count = 1;
  std::int32_t lower = 1;  ///< levels of the lower piece, the kept one included
  double low_u_s = 0;
  double kept_u_s = 0;  ///< end of the lower piece
  double high_u_s = 0;
  double step_low_u_s = 0;
  double step_high_u_s = 0;

  static LevelRange single(double speed_u_s) { return {1, 1, speed_u_s, speed_u_s, speed_u_s, 0, 0}; }

  static LevelRange uniform(std::int32_t count, double low, double high) {
    if (!(high > low)) return single(high);
    return {count, count, low, high, high, (high - low) / (count - 1), 0.0};
  }

  /// @param kept  a level exactly, if it lies between low and high; needs 3 levels
  static LevelRange keeping(std::int32_t count, double low, double high, double kept) {
    if (!(kept > low && kept < high)) return uniform(count, low, high);
    const double share = (count - 1) * (kept - low) / (high - low);
    const std::int32_t below = std::clamp(static_cast<std::int32_t>(share + 0.5), 1, count - 2);
    return {count, below + 1, low, kept, high, (kept - low) / below, (high - kept) / (count - 1 - below)};
  }

  double speed_u_s(std::int32_t level) const {
    if (level == count - 1) return high_u_s;
    if (level == lower - 1) return kept_u_s;
    if (level < lower) return low_u_s + level * step_low_u_s;
    return kept_u_s + (level - (lower - 1)) * step_high_u_s;
  }
};

}  // namespace kadr::planner
