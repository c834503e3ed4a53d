#pragma once
#include "planner/time_law/level_grid.h"
#include "planner/time_law/solver.h"

namespace kadr::planner {

/// The dynamic programme word by word: every pair of levels, every limit. The oracle of DynamicProgramme.
LawResult literal_dp(const LawProblem& problem, const std::vector<LevelRange>& levels);

}  // namespace kadr::planner
