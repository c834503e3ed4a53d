#pragma once
#include <vector>

#include "machine/base/plane_spline.h"

namespace kadr::planner {

/// A spline is followed by arcs and lines that lie no further from it than this, unless the program allows
/// more (G64 P).
inline constexpr double kSplineDeviation_mm = 0.001;

/// A straight or circular part of a plane curve; it begins where the part before it ends.
struct CurvePiece {
  bool arc = false;
  double end_first_mm = 0, end_second_mm = 0;
  double center_first_mm = 0, center_second_mm = 0;
  double sweep_rad = 0;  ///< signed, > 0 from first to second axis, at most half a turn
  double length_mm = 0;  ///< > 0
};

/// A curve as pairs of arcs joined by tangents (biarcs), so that corners brake it nowhere and its curvature
/// bounds the feed as that of any arc.
///
/// Each pair takes point and direction from the curve at both of its ends:
///   v = P1 - P0, t = T0 + T1,  2 (1 - T0 . T1) d^2 + 2 (v . t) d = v . v,  J = (P0 + P1 + d (T0 - T1)) / 2
/// and is halved until the curve at sixteen places between them is within the deviation. Pairs end at every
/// knot.
///
/// @param deviation_mm  > 0
/// @return pieces in order, without gaps
std::vector<CurvePiece> arcs_along(const PlaneSpline& spline, double deviation_mm);

}  // namespace kadr::planner
