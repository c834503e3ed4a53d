#pragma once
#include <functional>
#include <string_view>
#include <vector>

#include "emulator/studies/time_law/problem.h"
#include "machine/base/vocabulary.h"

namespace kadr::emulator {

enum class LawMethod : std::uint8_t { classical, tube, greedy, optimum, certified, jerk_limited };
inline constexpr Vocabulary<LawMethod, 6> kLawMethods{{
    {LawMethod::classical, "classical", "one dynamic programme over all speeds of each node"},
    {LawMethod::tube, "tube", "the paper's algorithm: dynamic programmes in a narrowing tube"},
    {LawMethod::greedy, "greedy", "the shortest time, by reachability: one pass backward, one forward"},
    {LawMethod::optimum, "optimum", "the least J, by an interior point method, with the proof"},
    {LawMethod::certified, "certified", "the greedy law, polished for J in a narrow tube, with the proof"},
    {LawMethod::jerk_limited, "jerk-limited", "the least J with the jerk along the path limited"},
}};
static_assert(kLawMethods.complete());
/// All methods that the problem states: jerk-limited needs a limit.
std::vector<LawMethod> methods_of(const TimeLawProblem& problem);

/// The law that one method found, and its measurements.
struct MethodOutcome {
  LawMethod method;
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
std::optional<Diagnostic> check_size(const TimeLawProblem& problem, const std::vector<LawMethod>& methods,
                                     bool keep_profiles);

/// Solves a problem by each method, and measures every law by law_metrics() and verify_law().
/// Reports the progress of a study: method, its stage, the share done (planner::LawProgress).
using StudyProgress = std::function<void(LawMethod method, std::string_view stage, double done)>;
/// @param keep_profiles  of every pass of the tube
LawStudy study_laws(const TimeLawProblem& problem, const std::vector<LawMethod>& methods, bool keep_profiles,
                    const StudyProgress& progress = nullptr);

}  // namespace kadr::emulator
