#pragma once
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "machine/base/vocabulary.h"

namespace kadr::machine {

/// How the speeds of a motion from rest to rest are found: by the scheduler's ramps, or by a law of paper
/// 000.
enum class PlanMethod : std::uint8_t { scheduler, classical, tube, greedy, optimum, certified, jerk_limited };

/// A method's word, and what others ask about it. (Which code does its work: planner/run_maker.cpp and
/// planner/time_law/law_methods.cpp.)
struct PlanMethodRow {
  PlanMethod method{};
  std::string_view word, sentence;
  bool plans = false;   ///< a machine may choose it (key planner.method); others are for study (`kadr tube`)
  bool is_law = false;  ///< its speeds are its own: no ramps of planner.law, and no override exceeds them
  bool keeps_jerk = false;  ///< its plans keep the jerk limits of axes and path
};

inline constexpr PlanMethodRow kPlanMethodRows[] = {
    {PlanMethod::scheduler, "scheduler", "ramps between block speeds", true, false, true},
    {PlanMethod::classical, "classical", "one dynamic programme over all speeds of each node", false, true,
     false},
    {PlanMethod::tube, "tube", "time law of paper 000: dynamic programmes in a narrowing tube", true, true,
     false},
    {PlanMethod::greedy, "greedy", "the shortest time, by reachability: one pass backward, one forward",
     false, true, false},
    {PlanMethod::optimum, "optimum", "the least J, by an interior point method, with the proof", false, true,
     false},
    {PlanMethod::certified, "certified",
     "time law of paper 000: the greedy law, polished, with a proof; no jerk limit", true, true, false},
    {PlanMethod::jerk_limited, "jerk-limited", "time law that keeps the jerk limits", true, true, true},
};

inline constexpr auto kPlanMethods = [] {
  Vocabulary<PlanMethod, std::size(kPlanMethodRows)> words{};
  for (std::size_t i = 0; i < words.size(); ++i)
    words.words[i] = {kPlanMethodRows[i].method, kPlanMethodRows[i].word, kPlanMethodRows[i].sentence};
  return words;
}();
static_assert(kPlanMethods.complete());

constexpr const PlanMethodRow& facts(PlanMethod method) {
  return kPlanMethodRows[static_cast<std::size_t>(method)];
}

/// Those that a machine can choose (key planner.method).
inline constexpr auto kMachinePlanMethods =
    words_where<kPlanMethods>([](PlanMethod method) { return facts(method).plans; });
/// Those that `kadr tube` compares.
inline constexpr auto kLawMethods =
    words_where<kPlanMethods>([](PlanMethod method) { return facts(method).is_law; });

}  // namespace kadr::machine
