#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace kadr::planner {

/// A curve through points, one Bezier curve from each point to the next, with continuous curvature (paper
/// 004 asks for it at joints).
///
/// Between the points the C2 cubic spline over their chord lengths h_i, whose first derivatives m_i solve
///   m_(i-1)/h_(i-1) + 2 (1/h_(i-1) + 1/h_i) m_i + m_(i+1)/h_i = 3 (d_(i-1)/h_(i-1) + d_i/h_i),  d = chord/h
/// with the directions of the first and the last chord at the ends; the first and the last curve are of
/// degree 5 so that the curvature at the ends is 0 and lines may follow there.
struct PointFit {
  std::vector<std::vector<double>> control_u;  ///< [points - 1], each 4 or 6 control points * axes
  std::vector<double> deviation_u;  ///< [points - 1], at most this far from the chord, any axis direction
};

/// @param points_u  [points * axes], three or more points, no two neighbours equal
PointFit fit_points(std::span<const double> points_u, std::size_t axes);

}  // namespace kadr::planner
