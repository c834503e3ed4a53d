#pragma once
#include <tl/expected.hpp>

#include "planner/limits/ramp.h"
#include "planner/time_law/path_law.h"

namespace kadr::planner {

/// Plans a run by planner.method = "jerk-limited": a law of node speeds (jerk_tangent_law) as a motion of
/// continuous acceleration (jerk_motion). Limits are those of the scheduler (limit_table), under which every
/// axis keeps its own. The motion lies a little above the law's jerk where that changes abruptly: there node
/// and interval are limited lower, and the law is sought again; what is left after kRounds is taken by time:
///   v/k, a/k^2, j/k^3   with the least k >= 1 that keeps every limit.
/// @param out  pieces are appended, their times begin at 0 each
/// @return k
tl::expected<double, PlanError> plan_jerk_law(const RunTask& task, const Run& run,
                                              std::vector<JerkPiece>& out);

}  // namespace kadr::planner
