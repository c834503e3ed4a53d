#pragma once
#include <memory>
#include <span>
#include <string>
#include <variant>

#include <tl/expected.hpp>

#include "planner/laws/feed_plan.h"
#include "planner/laws/motion_source.h"
#include "planner/limits/plan_error.h"
#include "planner/override/override.h"
#include "planner/path/joints.h"
#include "planner/path/path.h"
#include "planner/path/path_builder.h"
#include "planner/path/path_cut.h"
#include "planner/verify/verify.h"

/// Blocks -> path -> feed plan -> motion law. One door to the cycle: MotionSource. One door between geometry and
/// limits: Joints.
namespace kadr::planner {

/// Plans a whole path, rest to rest between the segments that stop, with look-ahead over the whole path.
///
/// Speed caps per segment (feed, axis speeds, centripetal) and per joint (junction rule, specs in
/// docs/papers.md: paper 003 section 1.2), then jerk-limited ramps that may span many segments (acceleration
/// continuous over inner joints), zero acceleration at every plateau. With jerk = inf the ramps are those of
/// trapezoidal motion, segment by segment. With planner.whole_ticks each rest-to-rest run lasts a whole
/// number of control ticks (paper 003, eq. 2). With planner.law = quintic ramps are polynomials of the fifth
/// degree in speed, whose jerk does not jump either (ramp_time_s); they need a jerk limit. Deterministic:
/// fixed iteration counts, + - * / sqrt only.
///
/// With planner.scheduler = blockwise ramps end with their segment, acceleration being zero at every joint,
/// and each segment lasts a whole number of control ticks (BlockScheduler); speed jumps only where the plan's
/// table states it.
/// @param pauses  ascending in after_segment; the law stands there, what follows begins later
tl::expected<FeedPlan, PlanError> plan(const Path& path, const machine::MachineModel& machine,
                                       std::span<const Pause> pauses = {});
/// The same by the limits of other joints than the machine's own (machine_joints).
tl::expected<FeedPlan, PlanError> plan(const Joints& joints, const machine::MachineModel& machine,
                                       std::span<const Pause> pauses = {});

/// Time that plan() gives to the segments from `first` to the path's end, where the machine stops, without
/// pauses. Segment `first` begins at rest. Runs are planned one by one, so the times of parts add up to that
/// of the whole.
tl::expected<double, PlanError> motion_time_s(const Path& path, const machine::MachineModel& machine,
                                              std::size_t first);

}  // namespace kadr::planner
