#pragma once
#include "machine/base/vocabulary.h"
#include "planner/time_law/dynamic_programme.h"

namespace kadr::planner {

/// Levels over all speeds of a node, from 0 to its cap (paper 000, step 1 and 2).
class ClassicalDp final : public LawSolver {
 public:
  explicit ClassicalDp(std::int32_t levels) : levels_(levels) {}
  std::string_view name() const override { return "classical"; }
  LawResult solve(const LawProblem& problem) override;

 private:
  std::int32_t levels_;
};

enum class TubeGrid : std::uint8_t {
  uniform,      ///< the paper's: the speed before is not a level, so a pass may be slower than the one before
  nominal_kept  ///< it is: the cost never rises
};
inline constexpr Vocabulary<TubeGrid, 2> kTubeGrids{{
    {TubeGrid::uniform, "uniform", "as printed: a pass may be slower than the one before"},
    {TubeGrid::nominal_kept, "nominal-kept", "the speed before is a level: the cost never rises"},
}};
static_assert(kTubeGrids.complete());

struct TubeOptions {
  std::int32_t levels = 100;         ///< M
  double relative_half_width = 0.1;  ///< delta_sh: of the highest speed of the first pass
  double stop_percent = 0.5;         ///< delta_p
  TubeGrid grid = TubeGrid::uniform;
  double least_half_width_u_s = 0;  ///< stops below it
  std::uint32_t most_passes = 60;
};

/// One pass of the loop.
struct TubePass {
  std::uint32_t number = 0;
  double time_s = 0;
  double cost_s = 0;
  double half_width_u_s = 0;  ///< used in it; 0 in the first
  bool touched = false;       ///< the law lies on the tube's edge somewhere
  bool compared = false;      ///< the second pass in a row without a touch
  double fall_percent = 0;    ///< of time, if compared
};

/// When the tube is halved and when the loop ends (paper 000, step 3).
class TubeControl {
 public:
  TubeControl(const TubeOptions& options, const LawSolution& first, double half_width_u_s);
  double half_width_u_s() const { return half_width_u_s_; }  ///< of the next pass
  /// Takes a pass. @return it, as it stands in the log
  const TubePass& pass(double time_s, double cost_s, bool touched);
  bool ended() const { return ended_; }
  bool capped() const { return capped_; }  ///< ended by the number of passes alone
  const std::vector<TubePass>& passes() const { return passes_; }

 private:
  TubeOptions options_;
  double half_width_u_s_;
  bool ended_ = false, capped_ = false;
  std::vector<TubePass> passes_;
};

/// Dynamic programming in a tube round the law found before (paper 000): few levels, close together.
class TubeDp final : public LawSolver {
 public:
  explicit TubeDp(TubeOptions options = {}) : options_(options) {}
  std::string_view name() const override { return "tube"; }
  /// The law with the least cost of all passes.
  LawResult solve(const LawProblem& problem) override;
  /// The same round a law that is known, whose half width is given.
  LawResult refine(const LawProblem& problem, const LawSolution& known, double half_width_u_s);

  const std::vector<TubePass>& passes() const { return passes_; }                 ///< of the last solve()
  const std::vector<std::vector<double>>& profiles() const { return profiles_; }  ///< [passes][nodes]
  void keep_profiles(bool keep) { keeps_profiles_ = keep; }
  /// Why the loop ended before its rule: no level of a uniform tube could be reached.
  const std::optional<LawFailure>& lost() const { return lost_; }
  bool capped() const { return capped_; }  ///< ended by the number of passes alone
  std::uint64_t transitions() const { return transitions_; }

 private:
  void tell_pass(DynamicProgramme& programme, std::size_t number) const;
  LawResult loop(DynamicProgramme& programme, const LawProblem& problem, LawSolution law,
                 TubeControl control);

  TubeOptions options_;
  bool keeps_profiles_ = false, capped_ = false;
  std::optional<LawFailure> lost_;
  std::vector<TubePass> passes_;
  std::vector<std::vector<double>> profiles_;
  std::uint64_t transitions_ = 0;
};

}  // namespace kadr::planner
