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
  LawResult polished = TubeDp(options).refine(problem, *greedy, kPolishHalfWidth * fastest);
  if (!polished) return polished;
  InteriorPointOptimum optimum;
  const LawResult bound = optimum.solve_from(problem, *greedy);
  if (!bound) return bound;
  certificate_ = optimum.certificate();
  polished->lower_bound_s = bound->lower_bound_s;
  return polished;
}

}  // namespace kadr::planner
