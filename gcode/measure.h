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

/// Sets the length that F measures along a straight move. The NIST rule, in this one place: X Y Z if one of them moves,
/// else U V W, else A B C.
inline void measure_straight(const AxisValues& from, Move& move) {
  constexpr std::size_t kA = 3, kU = 6;
  move.feed_length = FeedLength::xyz;
  move.length_u = length_of(from, move.end, kX);
  if (move.length_u > 0) return;
  const double uvw = length_of(from, move.end, kU);
  const double rotary = length_of(from, move.end, kA);
  if (uvw > 0) {
    move.feed_length = FeedLength::uvw;
    move.length_u = uvw;
  } else if (rotary > 0) {
    move.feed_length = FeedLength::rotary;
    move.length_u = rotary;
  }
}

/// Sets the length that F measures along an arc or helix: sqrt((sweep · radius)² + rise²), the radius being the mean of
/// those at the start and the end.
inline void measure_arc(double sweep_rad, double mean_radius_mm, double rise_mm, Move& move) {
  const double around = sweep_rad * mean_radius_mm;
  move.feed_length = FeedLength::xyz;
  move.length_u = std::sqrt(around * around + rise_mm * rise_mm);
}

}  // namespace kadr::gcode
