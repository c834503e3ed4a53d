#pragma once
#include "planner/time_law/solver.h"

namespace kadr::planner {

/// The time optimum (J without penalty) by reachability: backwards the range of squared speeds from which the
/// end can be reached, then forwards the highest of it in every interval. Two unknowns a step, so linear in nodes.
class GreedyOptimum final : public LawSolver {
 public:
  std::string_view name() const override { return "greedy"; }
  LawResult solve(const LawProblem& problem) override;
};

}  // namespace kadr::planner
