#pragma once
#include <cstdint>

#include "planner/point_to_point/point_to_point.h"

/// The method of paper 001, kept to be measured against: a genetic algorithm with penalties, by pagmo2.
namespace kadr::test {

/// A T law of a given time is looked for (the defaults: Table 1, with the paper's gravity).
struct GeneticProblem {
  planner::PointTask task{3.5, 3, 1};
  double time_s = 4;
  planner::DrivenMode driven;
  planner::Load load;
};

struct GeneticOptions {
  std::uint32_t seeds = 200, first_seed = 1;
  std::uint32_t population = 50;  ///< even
  std::uint32_t generations = 100;
  double weight = 10;  ///< of the penalty, joules
};

/// Results of the runs, next to the exact answer of best_t_law().
struct GeneticOutcome {
  double exact_xi = 0, exact_value = 0;  ///< value: J, or mm with damping
  std::uint32_t hits = 0;                ///< within 1e-5 of the exact xi
  std::uint32_t on_zeros = 0;            ///< within 1e-5 of any silent xi
  double best_fitness = 0, exact_fitness = 0;
};

/// Minimises over xi in D1, by `sga` (90 % simulated binary crossover, polynomial mutation, tournament of
/// two),
///   E(xi)/J + weight min(|sin(omega ta/2)|, |sin(omega (tf - ta)/2)|)   without damping
///   X_env(xi)/mm                                                       with damping
/// from each seed. Counts hang a little on the machine: pagmo takes powers by libm.
GeneticOutcome run_genetic(const GeneticProblem& problem, const GeneticOptions& options);

}  // namespace kadr::test
