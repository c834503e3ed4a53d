#pragma once
#include <functional>
#include <vector>

#include "emulator/studies/time_law/problem.h"

namespace kadr::studies {

/// The tube with one number of levels.
struct SweepRow {
  std::int32_t levels = 0;
  planner::LawResult law;  ///< or why there is none, and at which node
  std::uint32_t passes = 0;
  bool capped = false;  ///< ended by tube.most_passes or the least half width, not by the rule
  bool kept = false;    ///< verify_law() found no broken limit
};

struct LevelSweep {
  std::vector<SweepRow> rows;  // ascending in levels
  double lower_bound_s = 0;    ///< of J; no law that keeps the limits is below it
  bool good() const;
};

/// Solves a problem by the tube with every number of levels of a range.
/// @param each  called before each, with its number of levels
LevelSweep sweep_levels(const TimeLawProblem& problem, std::int32_t first, std::int32_t last,
                        const std::function<void(std::int32_t)>& each);

}  // namespace kadr::studies
