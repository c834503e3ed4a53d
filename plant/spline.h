#pragma once
#include <array>

#include "machine/base/count.h"

namespace kadr::plant {

/// One control tick of the smooth command: s(theta) = node * step + sum c_i theta^i, theta in [0, 1].
struct SplinePiece {
  std::array<double, 6> c{};
  Steps node;
  bool constant = true;
};

/// A point of the smooth command, kept as a lattice node and a small rest, so that no precision goes with the position.
struct SplinePoint {
  Steps node;
  double rest_m = 0;
  friend bool operator==(const SplinePoint&, const SplinePoint&) = default;
};

/// Uniform quintic B-spline: four times continuously differentiable whatever the points are, local to six of
/// them, and exact for straight lines. It need not meet its points; the plant answers for the difference
/// exactly.
/// @param point  [6], oldest first
SplinePiece spline_piece(const std::array<SplinePoint, 6>& point, double step_m);

}  // namespace kadr::plant
