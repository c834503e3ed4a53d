#pragma once
#include <vector>

#include "planner/time_law/path_law.h"
#include "planner/time_law/verify_law.h"

namespace kadr::planner {

/// A stretch of a path as a problem of its own (run_problem), s from 0 where the stretch begins. Both ends
/// have the caps of their joints, so that it may begin and end with a speed.
struct Stretch {
  LawProblem problem;
  std::vector<std::size_t>
      segment;                     // [nodes], that the interval ending at a node lies on; of node 0 the first
  std::vector<Signature> held_by;  // [nodes], what cap_u_s is
};
Stretch state_stretch(const Path& path, const PathLimitTable& table, const Run& run,
                      const machine::MachineModel& machine);

/// X' and X'' of the segments themselves; at a joint those behind it. `path` outlives it.
PathDerivatives derivatives(const Path& path, const Run& run);

}  // namespace kadr::planner
