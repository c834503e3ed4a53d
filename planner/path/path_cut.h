#pragma once
#include "planner/path/path.h"

namespace kadr::planner {

/// Makes a joint within a path: the segment there becomes two of the same block, on the same line or circle.
/// @param s_u  length from the path's beginning, within it
/// @return the segment that begins there, size() at the path's end; where a joint lies as near as 1e-9 of s,
/// that is taken
std::size_t cut_path(Path& path, double s_u);

}  // namespace kadr::planner
