#pragma once
#include <cstdint>

namespace kadr::interpolator {

/// Half-crossings of one axis that moves linearly along a segment: x(s) = begin + (end - begin) s/length, in
/// steps. Crossing k = 0, 1, ... of the levels node_begin +- (k + 1/2) lies at s_k = (first_level + k) spacing_u.
struct LineCrossings {
  double first_level = 0;  ///< distance from the beginning to the first level, steps
  double spacing_u = 0;    ///< path length from level to level
  std::int64_t count = 0;  ///< crossings on the whole segment
  std::int64_t next = 0;   ///< the first that has not fired
  int sign = 1;

  /// @param begin, end            positions at the segment's ends in steps
  /// @param node_begin, node_end  their lattice nodes; not equal
  static LineCrossings between(double begin, double end, std::int64_t node_begin, std::int64_t node_end,
                               double length_u);

  double s_u(std::int64_t k) const { return (first_level + static_cast<double>(k)) * spacing_u; }

  /// Number of crossings, from the beginning, that lie at or before s_end_u: exactly those with s_u(k) <= s_end_u.
  std::int64_t reached(double s_end_u) const;
};

}  // namespace kadr::interpolator
