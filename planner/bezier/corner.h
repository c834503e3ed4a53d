#pragma once
#include <optional>
#include <span>
#include <vector>

namespace kadr::planner {

/// A corner between two lines, rounded: a Bezier curve of degree 5 with three control points evenly on each
/// line, so that tangent and curvature go on at both ends (G2; curvature 0 there as on the lines). With trim
/// d, turn theta and s = sin(theta/2) the points lie d, (1 - r) d, (1 - 2 r) d from the corner, and the curve
/// passes the corner at
///   e = s d (16 - 25 r)/16
/// its largest distance from both lines' path. r is that of the least largest curvature for the same e.
struct RoundedCorner {
  double trim_u = 0;              ///< d, cut off both lines
  double deviation_u = 0;         ///< e
  std::vector<double> control_u;  ///< [6 * axes]
};

/// @param corner_u    [axes]
/// @param direction_before, direction_after  [axes], unit vectors along the lines
/// @param deviation_u  allowed e, > 0
/// @param most_trim_u  allowed d; then e is smaller
/// @return nothing where the lines go straight on, or turn back by more than 175 degrees
std::optional<RoundedCorner> round_corner(std::span<const double> corner_u,
                                          std::span<const double> direction_before,
                                          std::span<const double> direction_after, double deviation_u,
                                          double most_trim_u);

}  // namespace kadr::planner
