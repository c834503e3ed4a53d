#include "emulator/studies/time_law/level_sweep.h"

#include <algorithm>

namespace kadr::studies {

bool LevelSweep::good() const {
  return std::all_of(rows.begin(), rows.end(), [](const SweepRow& r) { return r.law && r.kept; });
}

LevelSweep sweep_levels(const TimeLawProblem& problem, std::int32_t first, std::int32_t last,
                        const std::function<void(std::int32_t)>& each) {
  LevelSweep out;
  const planner::LawResult best = planner::InteriorPointOptimum().solve(problem.law);
  if (best) out.lower_bound_s = best->lower_bound_s;
  for (std::int32_t levels = first; levels <= last; ++levels) {
    each(levels);
    planner::TubeOptions options = problem.tube;
    options.levels = levels;
    planner::TubeDp tube(options);
    SweepRow row{levels, tube.solve(problem.law), 0, false, false};
    row.passes = static_cast<std::uint32_t>(tube.passes().size());
    row.capped = tube.capped();
    row.kept = row.law && planner::verify_law(problem.law, *row.law).broken.empty();
    out.rows.push_back(std::move(row));
  }
  return out;
}

}  // namespace kadr::studies
