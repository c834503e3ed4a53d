#pragma once
#include <array>

#include "planner/bezier/path_curve.h"

namespace kadr::planner {

/// Upper bounds over a whole curve of its derivatives by arc length, x' = T, x'' of length kappa, x'''.
///
/// T and x'' are at right angles, so that for every axis and every K >= kappa
///   |a x'_j + b x''_j| <= plane_j sqrt(a^2 + (b K)^2),   plane_j = max sqrt(T_j^2 + (x''_j/K)^2) <= 1
struct CurveBounds {
  double curvature_per_u = 0;                   ///< K
  double curvature_least_per_u = 0;             ///< of the sampled points
  std::array<double, kProgramAxes> tangent{};   ///< |x'_j|
  std::array<double, kProgramAxes> plane{};     ///< share of the axis in the plane of x' and x''
  std::array<double, kProgramAxes> third_u2{};  ///< |x'''_j|
};

/// From places of the curve, raised by twice what a parabola through three of them rises between them.
/// Property tests sample thousands of other points.
CurveBounds curve_bounds(const PathCurve& curve);

}  // namespace kadr::planner
