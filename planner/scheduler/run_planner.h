#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "planner/limits/limits.h"
#include "planner/limits/ramp.h"

namespace kadr::planner {

/// Jerk-limited plan of the runs of a path: ramps may span many segments, acceleration is zero between them.
///
/// The valley rule, on a region between two anchors (s_A, v_A), (s_B, v_B) where no cap inside is below
/// either speed: let m be the lowest cap inside. If two ramps meet below m, that peak is the answer.
/// Otherwise the level m is reached, and the region falls apart at the places whose cap is m: outer parts
/// keep one anchor, inner parts have (m, m).
///
///   v  A          ______            m   a ramp that is still below m when it passes such a place does not
///   care for it
///      |\  ______/      \___B           ("shadow"): then the level is the lowest cap outside of the shadows,
///      provided | \/  m                          that the ramps keep below all caps in them
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
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Trapezoidal plan of one run without jerk limit: the exact time optimum for acceleration limits that are
/// constant on each segment. Forward and backward pass over v^2, then the peak of each segment from
///   w^2 = min(cap^2, a L + (v0^2 + v1^2)/2)
void plan_trapezoids(const Path& path, const PathLimitTable& table, const Run& run,
                     std::vector<Element>& out);

struct WholeTicks {
  std::int64_t ticks = 0;
  double stretch = 1.0;  ///< factor on all times that is left to apply
};
/// Makes the time of one run a whole number of control ticks (paper 003, eq. 2) by lowering the longest
/// plateau, or, if no plateau can give enough, by slowing the whole run a little (v/k, a/k^2, j/k^3); both
/// keep every limit.
WholeTicks fill_whole_ticks(std::vector<Element>& run, double tau_s);
/// The same by slowing the whole run alone.
WholeTicks stretched_to_ticks(double time_s, double tau_s);

}  // namespace kadr::planner
