#pragma once
#include <tl/expected.hpp>

#include "planner/limits/ramp.h"
#include "planner/limits/run_method.h"
#include "planner/time_law/solver.h"

namespace kadr::planner {

/// A run of a path as a problem of paper 000: nodes at every joint and between, at most planner.node_mm apart
/// and at most 2 degrees on arcs; X' and X'' of every joint of the machine (on both sides where two segments
/// meet), programmed feed, corners and centripetal limit as caps of nodes (limit_table). Accelerations at
/// both nodes of an interval; on arcs they are limited a little lower, by as much as may be exceeded between
/// nodes:
///   d^2/8 (5 |a_t| + a_n) with d the angle of an interval, of X' a + X'' v^2 where X is a circle.
struct RunProblem {
  LawProblem problem;
  std::vector<std::size_t>
      segment;  // [nodes], that the interval ending at a node lies on; of node 0 the first
};
/// Whose limits count: those of the axes themselves, or those along the path by which every axis keeps its
/// own, jerk included (limit_table). These are for motions of continuous acceleration, which also need
/// intervals that do not differ much from their neighbours.
enum class RunLimits : std::uint8_t { axes, path };
RunProblem run_problem(const Joints& joints, const PathLimitTable& table, const Run& run,
                       const machine::MachineModel& machine, RunLimits limits = RunLimits::axes);

/// Penalty of a run of that length: as much a millimetre as in paper 000, whose path was one stretch of 2846.9 mm.
Penalty run_penalty(double length_u);

/// K4008: a run without a time law, with its place.
PlanError law_not_found(const Path& path, const RunProblem& run, const LawFailure& failure);

/// What holds the speed in an interval of a segment that ends at a node with a cap.
Signature law_signature(const PathLimitTable& table, std::size_t segment, double cap_u_s, double speed_u_s);

/// How a law is found for a run.
using RunSolver = LawResult(const LawProblem& problem, const machine::MachineModel& machine);

/// Plans a run by a law of constant acceleration between nodes: one element for every interval whose speed
/// changes, holds joined.
tl::expected<void, PlanError> plan_time_law(const RunTask& task, const Run& run, RunSolver& solve,
                                            std::vector<Element>& out);

}  // namespace kadr::planner
