#pragma once
#include <vector>

#include "emulator/studies/teach/deviation.h"
#include "emulator/studies/teach/follow.h"

/// Data for a picture of a plane case, besides its step table.
namespace kadr::studies {

/// A point at which a method takes the sign of F, in half steps: (2x, 2y).
struct TestedPlace {
  std::int64_t x2, y2;
  bool operator==(const TestedPlace&) const = default;
};

/// Where a method looks before a slot: classic at the node, half_step and crossing at the corner of the dual
/// square that lies ahead, diagonal beside the neighbour along the longer axis, extra_points beside both
/// neighbours, magnitudes at both. Empty: the method tests no sign of F, or the curve has none.
std::vector<TestedPlace> tested_places(const interpolator::lattice::Curve& curve,
                                       interpolator::lattice::Method method,
                                       interpolator::lattice::PlaneNode node);

/// The point of the curve that a deviation is measured to; of a Bezier by crossings that of the moment t.
/// @param t  at which the node was reached; below 0: no Bezier by crossings
Place nearest_place(const interpolator::lattice::Curve& curve, const interpolator::lattice::Point& node,
                    double t);

/// The ideal curve as closely spaced points, from its beginning to its end; a line by its two ends.
/// @param table  of the curve by a method that follows it: curves F(x, y) = 0 are found along its nodes
std::vector<Place> curve_places(const interpolator::lattice::Curve& curve, const StepTable& table);

/// Speed along the path of lines in all directions at one slot per clock period: length over slots, in steps per
/// slot. One axis per slot: 1 along an axis, 1/sqrt(2) at 45 degrees; with diagonals 1 and sqrt(2).
struct RosePoint {
  double angle_rad = 0;
  double speed = 0;  ///< steps per slot; 0: the method can't follow lines
};
/// @param directions    evenly around the circle, from +X on
/// @param radius_steps  the lines end at the nodes nearest to this circle
std::vector<RosePoint> speed_rose(interpolator::lattice::Method method, int directions,
                                  std::int64_t radius_steps);

}  // namespace kadr::studies
