#pragma once
#include <memory>
#include <vector>

#include "planner/limits/limits.h"
#include "planner/limits/ramp.h"

namespace kadr::planner {

/// Jerk-limited plan of the runs of a path: ramps may span many segments, acceleration is zero between them.
///
/// The valley rule, on a region between two anchors (s_A, v_A), (s_B, v_B) where no cap inside is below
/// either speed: let m be the lowest cap inside. If two ramps meet below m, that peak is the answer.
/// Otherwise the level m is reached, and the region splits at the places whose cap is m: outer parts
/// keep one anchor, inner parts have (m, m).
///
/// A ramp that is still below m when it passes such a place x leaves it in its shadow. Then the level is w,
/// the lowest cap outside the shadows, provided that the ramps stay below all caps in them:
///
///     v
///   w |              ___________
///     |             /
///   m |      x     /             x: a place whose cap is m, passed by a speed below m
///     |           /
///     |      ____/
///     |    A
///     +--------------------------- s
///
/// Every part is feasible when it is made, so the speed never passes a cap and no pass has to be repeated. An
/// explicit stack replaces recursion. Cost about O(log n) per level by range minima.
class ValleyPlanner {
 public:
  ValleyPlanner(const Path& path, const PathLimitTable& table);
  ~ValleyPlanner();
  /// Appends the elements of one run, in path order, without gaps.
  void plan(const Run& run, std::vector<Element>& out);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kadr::planner
