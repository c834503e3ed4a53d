#include "tests/genetic/genetic.h"

#include <algorithm>
#include <cmath>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/sga.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "machine/base/numbers.h"

namespace kadr::test {
namespace {

constexpr double kHit = 1e-5;

/// The optimisation problem as pagmo wants it.
struct XiProblem {
  GeneticProblem p;
  planner::XiRange range;
  double weight = 0;

  /// What is compared: joules, or millimetres of residual vibration.
  double value(double xi) const {
    if (p.driven.mode.zeta > 0.0)
      return 1e3 * p.driven.gain * planner::t_law_amplitude_u(p.task.distance_u, p.time_s, xi, p.driven.mode);
    return planner::t_law_energy_J(p.task.distance_u, p.time_s, xi, p.load);
  }
  pagmo::vector_double fitness(const pagmo::vector_double& x) const {
    if (p.driven.mode.zeta > 0.0) return {value(x[0])};
    const double half = p.driven.mode.omega_rad_s * p.time_s / 2;
    return {value(x[0]) + weight * std::min(std::fabs(exact_sincos(half * x[0]).sin),
                                            std::fabs(exact_sincos(half * (1 - x[0])).sin))};
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {{range.low}, {range.high}};
  }
};

double evolve(const pagmo::problem& problem, const GeneticOptions& options, std::uint32_t seed) {
  const pagmo::algorithm method{
      pagmo::sga(options.generations, 0.9, 1.0, 0.1, 1.0, 2, "sbx", "polynomial", "tournament", seed)};
  return method.evolve(pagmo::population{problem, options.population, seed}).champion_x()[0];
}

}  // namespace

GeneticOutcome run_genetic(const GeneticProblem& p, const GeneticOptions& options) {
  const XiProblem xi_problem{p, planner::xi_range(p.task, p.time_s), options.weight};
  const pagmo::problem problem{xi_problem};
  GeneticOutcome out;
  out.exact_xi = planner::best_t_law(p.task, p.time_s, p.driven, p.load).value().xi;
  out.exact_value = xi_problem.value(out.exact_xi);
  out.exact_fitness = out.best_fitness = xi_problem.fitness({out.exact_xi})[0];
  const auto zeros = planner::zero_laws(p.task, p.time_s, p.driven.mode, p.load).value();
  for (std::uint32_t i = 0; i < options.seeds; ++i) {
    const double xi = evolve(problem, options, options.first_seed + i);
    out.hits += std::fabs(xi - out.exact_xi) <= kHit;
    out.on_zeros += std::any_of(zeros.begin(), zeros.end(),
                                [&](const planner::ZeroLaw& z) { return std::fabs(xi - z.xi) <= kHit; });
    out.best_fitness = std::min(out.best_fitness, xi_problem.fitness({xi})[0]);
  }
  return out;
}

}  // namespace kadr::test
