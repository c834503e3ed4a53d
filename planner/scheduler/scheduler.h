#pragma once
#include "planner/scheduler/block_writer.h"
#include "planner/scheduler/blockwise.h"
#include "planner/scheduler/pieces.h"
#include "planner/scheduler/ramp_method.h"
#include "planner/scheduler/trapezoid.h"
#include "planner/scheduler/valley.h"
#include "planner/scheduler/whole_ticks.h"

/// From caps (limits/) to ramps and plateaus. Run by run, from rest to rest: ValleyPlanner with a jerk limit,
/// plan_trapezoids() without (RampMethod chooses), fill_whole_ticks() afterwards. Or block by block as in
/// paper 003: BlockScheduler. PieceWriter and BlockWriter turn either into the pieces of a MotionLaw. plan()
/// (planner/plan.cpp) picks one.
