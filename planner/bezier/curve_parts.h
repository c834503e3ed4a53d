#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace kadr::planner {

/// Cuts a Bezier curve into parts on which the curvature changes little, so that one speed limit for each
/// part costs little time: halves, until the least curvature of a part is 0.7 of its largest, or the largest
/// limits nothing.
///
/// @param control_u  [points * axes], two to six points
/// @param harmless_per_u  a curvature that limits nothing
/// @return control points of each part; nothing for a curve with a cusp, or one that stands at an end (a
///         control point on it)
std::optional<std::vector<std::vector<double>>> parts_of_like_curvature(std::span<const double> control_u,
                                                                        std::size_t axes,
                                                                        double harmless_per_u);

}  // namespace kadr::planner
