#pragma once
#include <array>

namespace kadr::interpolator {

/// Crossings found ahead of the motion, all in one direction.
struct CrossingRun {
  static constexpr int kRun = 64;  ///< found ahead at most
  std::array<double, kRun> s_u{};  ///< positions on the segment, ascending
  int count = 0;
  int next = 0;  ///< first that has not fired
  int sign = 1;
};

}  // namespace kadr::interpolator
