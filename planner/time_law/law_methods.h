#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "machine/plan_method.h"
#include "planner/limits/run_method.h"
#include "planner/time_law/solver.h"
#include "planner/time_law/tube.h"

namespace kadr::planner {

/// What a problem file states beside the problem.
struct LawSettings {
  std::int32_t classical_levels = 1100;
  TubeOptions tube;
  bool keeps_profiles = false;      ///< of every pass of the tube
  std::optional<double> jerk_u_s3;  ///< limit along the path, > 0
};

/// Estimate of what a solver takes.
struct LawWork {
  double memory_bytes = 0;
  double transitions = 0;  ///< of one pass, if every transition were admissible
  double jerk_rows = 0;    ///< limits that each of some hundred tangents looks at
};

/// A law of machine::kLawMethods: for study as a solver of any LawProblem, and for plan() as a planner of runs.
struct LawMethod {
  machine::PlanMethod method;
  /// @pre `jerk_u_s3` is given, where the method needs it
  std::unique_ptr<LawSolver> (*solver)(const LawSettings& settings);
  LawWork (*work)(const LawProblem& problem, const LawSettings& settings);
  /// As RunMethod::plan(); nullptr for a method that no machine can choose.
  tl::expected<void, PlanError> (*plan)(const RunTask& task, const Run& run, PlannedRun& out);
};

/// @pre facts(method).is_law
const LawMethod& law_method(machine::PlanMethod method);

}  // namespace kadr::planner
