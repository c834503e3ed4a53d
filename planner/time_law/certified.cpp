#include "planner/time_law/certified.h"

#include <algorithm>

#include "planner/time_law/greedy.h"
#include "planner/time_law/interior_point.h"
#include "planner/time_law/tube.h"

namespace kadr::planner {
namespace {

constexpr std::int32_t kPolishLevels = 21;
constexpr std::uint32_t kPolishPasses = 4;         ///< the greedy law counts as the first
constexpr double kPolishHalfWidth = 20.0 / 545.0;  ///< of the highest speed

}  // namespace

LawResult CertifiedLaw::solve(const LawProblem& problem) {
  LawResult greedy = GreedyOptimum().solve(problem);
  if (!greedy) return greedy;
  TubeOptions options;
  options.levels = kPolishLevels;
  options.grid = TubeGrid::nominal_kept;
  options.most_passes = kPolishPasses;
  double fastest = 0;
  for (const double v : greedy->speed_u_s) fastest = std::max(fastest, v);
  TubeDp tube(options);
  tube.on_progress(progress_);
  LawResult polished = tube.refine(problem, *greedy, kPolishHalfWidth * fastest);
  if (!polished) return polished;
  InteriorPointOptimum optimum;
  optimum.on_progress(progress_);
  const LawResult best = optimum.solve_from(problem, *greedy);
  certificate_ = optimum.certificate();
  // without an optimum there is a lower bound all the same, though one that leaves a gap
  const double bound = best ? best->lower_bound_s : lower_bound_s(problem, certificate_);
  polished->lower_bound_s = bound > 0.0 ? bound : 0.0;
  return polished;
}

}  // namespace kadr::planner
