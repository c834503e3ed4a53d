#pragma once
#include <memory>

#include "planner/laws/feed_plan.h"
#include "planner/laws/motion_source.h"

namespace kadr::machine {
struct MachineModel;
}

/// A plan under the operator's override: which feed it allows from tick to tick (feed_terrain.h), how the
/// motion follows it without breaking a limit (feed_tracker.h), and what the axis limiter takes off (axis_limiter.h).
namespace kadr::planner {

class Path;

/// Plays a plan under the operator's override (OverrideSource, override_source.h). `path`, `plan` and `machine`
/// outlive it.
/// @param most_percent  highest ratio that will be requested, >= 1
std::unique_ptr<MotionSource> override_source(const Path& path, const FeedPlan& plan,
                                              const machine::MachineModel& machine, double most_percent);

}  // namespace kadr::planner
