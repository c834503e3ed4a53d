#pragma once
#include "planner/time_law/certificate.h"
#include "planner/time_law/solver.h"

namespace kadr::planner {

/// The optimum of J, with a certificate of it.
class InteriorPointOptimum final : public LawSolver {
 public:
  /// @param relative_gap  between its cost and the lower bound
  explicit InteriorPointOptimum(double relative_gap = 5e-8) : relative_gap_(relative_gap) {}
  std::string_view name() const override { return "optimum"; }
  LawResult solve(const LawProblem& problem) override;
  /// The same, begun at a law that is known.
  LawResult solve_from(const LawProblem& problem, const LawSolution& known);
  /// Of the last solution, or the best one found if none was reached.
  const Certificate& certificate() const { return certificate_; }

 private:
  double relative_gap_;
  Certificate certificate_;
};

}  // namespace kadr::planner
