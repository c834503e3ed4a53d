#pragma once

/// The part of verify() that knows about curves.
namespace kadr::planner {

class PathCurve;

/// Whether the curve somewhere runs more than 90 degrees away from the direction in which it begins. The
/// planner bounds a curve by its curvature at 17 places, and misses the tip of one that turns back between
/// two of them: see VerifyOptions::curves_that_turn_back.
bool turns_back(const PathCurve& curve);

}  // namespace kadr::planner
