#pragma once
#include "planner/scheduler/block_writer.h"
#include "planner/scheduler/blockwise.h"
#include "planner/scheduler/pieces.h"
#include "planner/scheduler/run_planner.h"

/// From caps (limits/) to ramps and plateaus. Run by run, from rest to rest: ValleyPlanner with a jerk limit,
/// plan_trapezoids() without, fill_whole_ticks() afterwards (run_planner.h). Or block by block as in paper
/// 003: BlockScheduler. PieceWriter and BlockWriter turn either into the pieces of a MotionLaw. plan()
/// (planner/plan.cpp) picks one.
