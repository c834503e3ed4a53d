#pragma once
#include <functional>
#include <string_view>
#include <utility>

#include <tl/expected.hpp>

#include "planner/time_law/problem.h"

namespace kadr::planner {

/// A speed at every node, and how good it is.
struct LawSolution {
  std::vector<double> speed_u_s;  // [nodes]
  double time_s = 0;              ///< sum dt
  double cost_s = 0;              ///< J
  /// No law that keeps the limits costs less; 0 if nothing is known (certificate.h).
  double lower_bound_s = 0;
  std::uint32_t iterations = 0;  ///< passes, or Newton steps
};

using LawResult = tl::expected<LawSolution, LawFailure>;

/// Told how far a method is: what it does ("pass 3"), and how much of that is done, 0..1;
/// below 0: not known. Called often.
using LawProgress = std::function<void(std::string_view stage, double done)>;

/// A method to solve a LawProblem. Every solution, from whichever method, is looked at by verify_law().
class LawSolver {
 public:
  virtual ~LawSolver() = default;
  virtual std::string_view name() const = 0;
  /// @pre check_problem() has found nothing
  virtual LawResult solve(const LawProblem& problem) = 0;
  void on_progress(LawProgress progress) { progress_ = std::move(progress); }

 protected:
  LawProgress progress_;
};

/// Adds up time and cost of a profile.
LawSolution summed(const LawProblem& problem, std::vector<double> speed_u_s);

}  // namespace kadr::planner
