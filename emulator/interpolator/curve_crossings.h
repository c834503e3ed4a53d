#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "emulator/interpolator/crossing_run.h"
#include "planner/path/path.h"

namespace kadr::interpolator {

/// Half-crossings of one axis of a curve, run by run in the order of the path.
///
/// [0, 1] is cut where the axis turns round; on each monotone piece the crossings are exactly the half-levels
/// between the nodes of its two ends, each bracketed by the one before and the piece's end and found by
/// Newton's method that falls back on halving (papers 002 and 004). Their places are the curve's arc length
/// there. Doubles in a fixed order of + - * / sqrt.
class CurveCrossings : public CrossingRun {
 public:
  /// @pre curve.moves(axis); `curve` lives as long as this
  void start(const planner::PathCurve& curve, std::size_t axis, double step_u, std::int64_t node_begin,
             std::int64_t node_end);

  /// Finds the next run of crossings in one direction; false when the segment has no more.
  bool find_run();

 private:
  bool begin_piece();
  double position(double t) const;
  double speed(double t) const;
  double crossing(double level, double low, double high) const;

  const planner::PathCurve* curve_ = nullptr;
  std::array<double, planner::PathCurve::kPowers> c_{};    // x(t) in steps
  std::vector<double> ends_;                               // t where the monotone pieces end; the last is 1
  std::size_t piece_ = 0;                                  // the next to begin
  std::int64_t node_ = 0, piece_node_ = 0, node_end_ = 0;  // now, at the piece's end, at the curve's end
  double t_ = 0;                                           // of the last crossing
  double s_last_u_ = 0;
};

}  // namespace kadr::interpolator
