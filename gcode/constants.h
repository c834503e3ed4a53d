#pragma once
#include <cstddef>

#include "machine/base/numbers.h"

namespace kadr::gcode {

inline constexpr double kSecondsPerMinute = 60.0;
inline constexpr double kFullTurn_deg = 360.0;
inline constexpr double kRadiansPerDegree = kPi / 180.0;

// of AxisValues
inline constexpr std::size_t kX = 0, kY = 1, kZ = 2;

// tool tables
inline constexpr double kLargestTool = 99999;
inline constexpr double kLargestOrientation = 9;

}  // namespace kadr::gcode
