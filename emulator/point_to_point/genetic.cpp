#include "emulator/point_to_point/genetic.h"

#include <algorithm>
#include <cmath>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/sga.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "machine/base/numbers.h"

namespace kadr::emulator {
namespace {

constexpr double kHit = 1e-5;

/// The optimisation problem as pagmo wants it.
struct XiProblem {
  planner::PointTask task;
  double time_s = 0;
  planner::DrivenMode driven;
  planner::Load load;
  planner::XiRange range;
  double weight = 0;

  /// What is compared: joules, or millimetres of residual vibration.
  double value(double xi) const {
    if (driven.mode.zeta > 0.0)
      return 1e3 * driven.gain * planner::t_law_amplitude_u(task.distance_u, time_s, xi, driven.mode);
    return planner::t_law_energy_J(task.distance_u, time_s, xi, load);
  }
  pagmo::vector_double fitness(const pagmo::vector_double& x) const {
    if (driven.mode.zeta > 0.0) return {value(x[0])};
    const double half = driven.mode.omega_rad_s * time_s / 2;
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

GeneticOutcome run_genetic(const PointQuestion& q, const PointStudy& study, const GeneticOptions& options) {
  GeneticOutcome out;
  out.options = options;
  const XiProblem xi_problem{
      q.task, q.time_s, study.driven, study.load, planner::xi_range(q.task, q.time_s), options.weight};
  out.exact_xi = study.rows[study.chosen].xi;
  out.exact_value = xi_problem.value(out.exact_xi);
  const auto zeros = planner::zero_laws(q.task, q.time_s, study.driven.mode, study.load);
  const pagmo::problem problem{xi_problem};
  std::vector<double> found;
  for (std::uint32_t i = 0; i < options.seeds; ++i) {
    const double xi = evolve(problem, options, options.first_seed + i);
    found.push_back(xi);
    out.hits += std::fabs(xi - out.exact_xi) <= kHit;
    out.on_zeros += zeros && std::any_of(zeros->begin(), zeros->end(), [&](const planner::ZeroLaw& z) {
                      return std::fabs(xi - z.xi) <= kHit;
                    });
  }
  std::stable_sort(found.begin(), found.end(),
                   [&](double a, double b) { return problem.fitness({a})[0] < problem.fitness({b})[0]; });
  out.best_xi = found.front();
  out.median_xi = found[found.size() / 2];
  out.worst_xi = found.back();
  out.best_value = xi_problem.value(out.best_xi);
  out.median_value = xi_problem.value(out.median_xi);
  out.worst_value = xi_problem.value(out.worst_xi);
  return out;
}

}  // namespace kadr::emulator
