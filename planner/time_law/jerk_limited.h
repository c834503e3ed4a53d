#pragma once
#include "planner/time_law/solver.h"

namespace kadr::planner {

/// Least J with the jerk along the path limited at every node, rest ends included:
///   |u_(i+1) - u_i| <= j (dt_i + dt_(i+1))/2,   u = dv/dt of an interval.
/// dt is convex in the squared speeds, so its tangent at any law lies below it: each convex problem made with
/// it admits only laws that keep the limit, and its optimum is the next tangent point. A local optimum of a
/// problem that is not convex. From rest to rest.
class JerkLimitedLaw final : public LawSolver {
 public:
  explicit JerkLimitedLaw(double jerk_u_s3) : jerk_u_s3_(jerk_u_s3) {}
  std::string_view name() const override { return "jerk-limited"; }
  LawResult solve(const LawProblem& problem) override;
  std::uint32_t tangents() const { return tangents_; }  ///< convex problems of the last solution

 private:
  double jerk_u_s3_;
  std::uint32_t tangents_ = 0;
};

/// A jerk limit on either side of every node, u/s^3, > 0; inf: none.
struct NodeJerk {
  std::vector<double> before, behind;  // [nodes]
};

/// One of these convex problems: tangents at a law, with
///   |u_(i+1) - u_i| <= (j_before dt_i + j_behind dt_(i+1))/2.
/// @param at_u_s  [nodes], speeds of the law, > 0 inside, 0 at both ends
LawResult jerk_tangent_law(const LawProblem& problem, const NodeJerk& jerk,
                           const std::vector<double>& at_u_s);

/// Highest |u_(i+1) - u_i| / ((dt_i + dt_(i+1))/2) of a law, rest ends included (there dt counts once).
double node_jerk_u_s3(const LawProblem& problem, const std::vector<double>& speed_u_s);

}  // namespace kadr::planner
