#pragma once
#include "planner/time_law/dp_step.h"
#include "planner/time_law/level_grid.h"
#include "planner/time_law/solver.h"

namespace kadr::planner {

/// The best law through given levels (paper 000, step 2): J(i, j) = min over k of J(i-1, k) + dt + penalty,
/// from the first node's only level to the last one's. Storage is kept from run to run: 8 + 2 x 2 bytes a
/// node and level.
class DynamicProgramme {
 public:
  /// `problem` outlives it.
  explicit DynamicProgramme(const LawProblem& problem, DpStepFunction function = dp_step_function());

  /// @param levels  [nodes], at most 65,535 each; one at both ends
  /// @return the solution with the least cost, of equal ones that with the lowest levels from the end on;
  /// failure: the
  ///         first node of which no level can be reached
  LawResult run(const std::vector<LevelRange>& levels);

  /// `each` is called with the part of the nodes that is done, 0..1, now and then.
  void on_progress(std::function<void(double)> each) { progress_ = std::move(each); }

  const std::vector<std::int32_t>& level() const { return level_; }  ///< [nodes], of the last solution
  std::uint64_t transitions() const { return transitions_; }         ///< evaluated in all runs

 private:
  struct NodeLevels {
    std::vector<double> speed, square;
    LevelRange range;
    std::int32_t first = 0, last = 0;  ///< levels that can be reached
    void set(const LevelRange& range, std::size_t padded);
  };

  bool step(std::size_t i);
  LawSolution read_back(const std::vector<LevelRange>& levels);

  const LawProblem& problem_;
  AccelRows rows_;
  DpStepFunction step_;
  std::function<void(double)> progress_;
  std::size_t stride_ = 0;    ///< levels of a node in the tables
  std::vector<double> cost_;  // [nodes][stride]
  std::vector<std::uint16_t> first_, last_;
  std::vector<std::int32_t> step_first_, step_last_;
  std::vector<double> least_square_, most_square_;
  NodeLevels before_, here_;
  std::vector<std::int32_t> level_;
  std::uint64_t transitions_ = 0;
};

}  // namespace kadr::planner
