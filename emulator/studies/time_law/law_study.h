#pragma once
#include <functional>
#include <string_view>
#include <vector>

#include "emulator/studies/time_law/problem.h"
#include "machine/plan_method.h"

namespace kadr::studies {

using machine::kLawMethods;
using machine::PlanMethod;

/// All methods that the problem states: jerk-limited needs a limit.
std::vector<PlanMethod> methods_of(const TimeLawProblem& problem);

/// The law that one method found, and its measurements.
struct MethodOutcome {
  PlanMethod method;
  planner::LawResult law;  ///< or why there is none, and at which node
  planner::LawMetrics metrics;
  planner::LawCheck check;  ///< verify_law(), and of the jerk-limited law its jerk at nodes
  double wall_s = 0;

  bool good() const { return law && check.broken.empty(); }
};

/// The loop of the tube, pass by pass.
struct TubeStory {
  std::vector<planner::TubePass> passes;
  std::vector<std::vector<double>> profiles_mm_s;  // [passes][nodes], if they were kept
  std::optional<planner::LawFailure> lost;
  bool capped = false;
  /// Of the pass that would have come next.
  double next_half_width_mm_s() const;
};

struct LawStudy {
  std::vector<MethodOutcome> outcomes;
  TubeStory tube;                  ///< empty unless the tube was requested
  double lower_bound_s = 0;        ///< of J, by optimum or certified; 0 if neither was requested
  std::uint32_t inner_points = 0;  ///< sampled in every interval

  bool good() const;
};

/// Estimate of memory and work, before either is taken.
/// @return an error at problem.size_span if a method needs more than 4 GB, a pass more than 1e12 transitions,
/// or the jerk-limited law more than 1e7 limits
std::optional<Diagnostic> check_size(const TimeLawProblem& problem, const std::vector<PlanMethod>& methods,
                                     bool keep_profiles);

/// Solves a problem by each method, and measures every law by law_metrics() and verify_law().
/// Reports the progress of a study: method, its stage, the share done (planner::LawProgress).
using StudyProgress = std::function<void(PlanMethod method, std::string_view stage, double done)>;
/// @param keep_profiles  of every pass of the tube
LawStudy study_laws(const TimeLawProblem& problem, const std::vector<PlanMethod>& methods, bool keep_profiles,
                    const StudyProgress& progress = nullptr);

}  // namespace kadr::studies
