#pragma once
#include <cstdint>

#include "emulator/point_to_point/point_study.h"

namespace kadr::emulator {

/// The paper's own method, a genetic algorithm with penalties, over many seeds. It minimises over xi in D1
///   E(xi)/J + weight min(|sin(omega ta/2)|, |sin(omega (tf - ta)/2)|)   without damping
///   X_env(xi)                                                          with damping
/// by pagmo2's `sga`: 90 % crossover (simulated binary), mutation (polynomial), tournament of two.
struct GeneticOptions {
  std::uint32_t seeds = 200;  ///< 1 to 10 000; seeds first_seed, first_seed + 1, ...
  std::uint32_t first_seed = 1;
  std::uint32_t population = 50;  ///< even
  std::uint32_t generations = 100;
  double weight = 10;  ///< of the penalty, joules
};

/// What the runs found, beside the exact answer.
struct GeneticOutcome {
  GeneticOptions options;
  double exact_xi = 0, exact_value = 0;             ///< of best_t_law(); value: J, or mm with damping
  std::uint32_t hits = 0;                           ///< within 1e-5 of the exact xi
  std::uint32_t on_zeros = 0;                       ///< within 1e-5 of any silent xi
  double best_xi = 0, median_xi = 0, worst_xi = 0;  ///< by value
  double best_value = 0, median_value = 0, worst_value = 0;
};

/// @pre study was made of this question, which gives a time
GeneticOutcome run_genetic(const PointQuestion& question, const PointStudy& study,
                           const GeneticOptions& options);

}  // namespace kadr::emulator
