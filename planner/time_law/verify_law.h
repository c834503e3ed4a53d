#pragma once
#include <functional>
#include <string>
#include <vector>

#include "planner/time_law/solver.h"

namespace kadr::planner {

/// X'(s) and X''(s) of all axes at any place of a path.
using PathDerivatives = std::function<void(double s_u, double* slope, double* curvature)>;

/// One broken limit of a law, at its worst place.
struct LawViolation {
  std::string what;  ///< "axis 3 acceleration", "zone", "speed at the end", ...
  double s_u = 0;
  double value = 0;
  double limit = 0;
};

struct LawCheck {
  std::vector<LawViolation> broken;  ///< at nodes, zones and ends; one a kind
  double node_excess = 0;            ///< highest value/limit - 1 at nodes; below 0: all are kept
  double dense_excess = 0;           ///< the same at inner points of the intervals, if they were looked at
};

struct LawCheckOptions {
  double tolerance = 1e-6;          ///< relative
  std::uint32_t inner_points = 10;  ///< of an interval, if the path is given
};

/// Looks at a law by the definitions of LawProblem alone, whichever method made it: every limit at every node
/// (and in both_nodes at both ends of each interval), each zone at its exact ends, the given end speeds, time
/// that grows, sums that are right; with the path also between nodes, where only node limits are promised.
LawCheck verify_law(const LawProblem& problem, const LawSolution& solution,
                    const PathDerivatives& path = nullptr, const LawCheckOptions& options = {});

}  // namespace kadr::planner
