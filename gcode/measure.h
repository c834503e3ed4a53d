#pragma once
#include <cmath>
#include <cstddef>

#include "gcode/block.h"
#include "gcode/constants.h"

namespace kadr::gcode {

/// Distance between two points over three axes from `first_axis` on.
inline double length_of(const AxisValues& from, const AxisValues& to, std::size_t first_axis) {
  double sum = 0;
  for (std::size_t axis = first_axis; axis < first_axis + 3; ++axis) {
    const double d = to[axis] - from[axis];
    sum += d * d;
  }
  return std::sqrt(sum);
}

/// Sets what F measures along a straight move. The NIST rule, in this one place: X Y Z if one of them moves,
/// else U V W, else A B C.
inline void measure_straight(const AxisValues& from, Block& block) {
  constexpr std::size_t kA = 3, kU = 6;
  block.feed_length = FeedLength::xyz;
  block.length_u = length_of(from, block.end, kX);
  if (block.length_u > 0) return;
  const double uvw = length_of(from, block.end, kU);
  const double rotary = length_of(from, block.end, kA);
  if (uvw > 0) {
    block.feed_length = FeedLength::uvw;
    block.length_u = uvw;
  } else if (rotary > 0) {
    block.feed_length = FeedLength::rotary;
    block.length_u = rotary;
  }
}

/// Sets what F measures along an arc or helix: sqrt((sweep · radius)² + rise²), the radius being the mean of
/// those at the start and the end.
inline void measure_arc(double sweep_rad, double mean_radius_mm, double rise_mm, Block& block) {
  const double around = sweep_rad * mean_radius_mm;
  block.feed_length = FeedLength::xyz;
  block.length_u = std::sqrt(around * around + rise_mm * rise_mm);
}

}  // namespace kadr::gcode
