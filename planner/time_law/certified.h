#pragma once
#include "planner/time_law/certificate.h"
#include "planner/time_law/solver.h"

namespace kadr::planner {

/// The time optimum, polished for J by dynamic programming in a narrow tube round it, with a proof of how
/// good that is.
class CertifiedLaw final : public LawSolver {
 public:
  std::string_view name() const override { return "certified"; }
  LawResult solve(const LawProblem& problem) override;
  const Certificate& certificate() const { return certificate_; }

 private:
  Certificate certificate_;
};

}  // namespace kadr::planner
