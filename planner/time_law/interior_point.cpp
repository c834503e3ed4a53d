#include "planner/time_law/interior_point.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "planner/time_law/band_program.h"
#include "planner/time_law/greedy.h"

namespace kadr::planner {
namespace {

constexpr double kBelow = 0.9;  ///< of the known law's squared speeds, to begin with: away from every limit

}  // namespace

LawResult InteriorPointOptimum::solve(const LawProblem& problem) {
  LawResult greedy = GreedyOptimum().solve(problem);
  if (!greedy) return greedy;
  return solve_from(problem, *greedy);
}

LawResult InteriorPointOptimum::solve_from(const LawProblem& problem, const LawSolution& known) {
  const std::size_t n = problem.nodes();
  BandProgram program = cost_program(problem, node_caps(problem));
  const std::vector<RowOrigin> origins = add_accel_rows(program, accel_rows(problem));
  add_caps(program);
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double v = known.speed_u_s[i];
    const bool inner = i > 0 && i + 1 < n;
    x[i] = (inner ? kBelow : 1.0) * v * v / program.unit_u2_s2;
  }
  // a law may rest for a moment; the method must not
  for (std::size_t i = 1; i + 1 < n; ++i) x[i] = std::max(x[i], 1e-9 * program.cap[i]);
  BandOptions options;
  options.relative_gap = relative_gap_;
  if (progress_)
    options.each_step = [this](std::uint32_t step) { progress_(fmt::format("step {}", step), -1.0); };
  const BandOptimum optimum = planner::solve(program, std::move(x), options);
  std::vector<double> speed(n);
  for (std::size_t i = 0; i < n; ++i) speed[i] = std::sqrt(std::max(optimum.x[i], 0.0) * program.unit_u2_s2);
  speed.front() = problem.begin_u_s;
  speed.back() = problem.end_u_s;
  const AccelRows rows = accel_rows(problem);
  certificate_.speed_u_s = speed;
  certificate_.upper.assign(rows.before.size(), 0.0);
  certificate_.lower.assign(rows.before.size(), 0.0);
  for (std::size_t k = 0; k < origins.size(); ++k)
    (origins[k].upper ? certificate_.upper : certificate_.lower)[origins[k].row] = optimum.multipliers[k];
  if (!optimum.converged)
    return tl::unexpected(LawFailure{
        0, problem.s_u[0],
        fmt::format("the interior point method stopped after {} steps at a cost of {:.6f} s, above "
                    "a bound of {:.6f} s",
                    optimum.steps, optimum.cost_s, optimum.bound_s)});
  LawSolution out = summed(problem, std::move(speed));
  out.lower_bound_s = lower_bound_s(problem, certificate_);
  out.iterations = optimum.steps;
  return out;
}

}  // namespace kadr::planner
