#pragma once
#include <cstddef>
#include <span>

#include "planner/laws/feed_plan.h"

namespace kadr::planner {

class Path;

/// Where a motion from rest to rest begins: at a segment of the path, with a piece of the law.
struct RunBegin {
  std::size_t segment = 0;
  std::size_t piece = 0;
};

/// Completes a plan that has motion only: sets motion_s and pause_s, lets the law stand at each pause, and
/// delays all that follows it, in the law and in the table.
/// @param pauses  ascending; each at the beginning of a run or at the path's end
/// @param runs    all of the plan, ascending
void add_pauses(const Path& path, std::span<const Pause> pauses, std::span<const RunBegin> runs,
                FeedPlan& plan);

}  // namespace kadr::planner
