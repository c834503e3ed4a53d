#pragma once
#include <array>
#include <cstdint>

#include "emulator/interpolator/crossing_run.h"
#include "planner/path/path.h"

namespace kadr::interpolator {

/// Half-crossings of one of the two plane axes of an arc, run by run in the order of the path.
///
/// Both axes and both directions have one normal form, in steps, with u = s/length in [0, 1]:
///   x(u) = center + (radius + growth u) cos(psi + sweep u),   sweep > 0
/// (second axis: psi = angle - pi/2; negative sweep: angle mirrored, since the cosine is even.)
/// x'(u) = -V sin(theta), theta(u) = psi + sweep u - delta(u), delta = atan2(growth, (radius + growth u)
/// sweep), and theta only rises: so the extremes are theta = m pi, maxima for even m, and between them the
/// axis is monotone. The crossings of a piece are exactly the half-levels between the nodes of its two ends.
/// Each crossing starts from the circle's closed form, a spiral adds Newton's steps inside the piece's
/// bracket. Nothing depends on how many turns there are.
class ArcCrossings : public CrossingRun {
 public:
  struct Ends {
    std::int64_t node_begin = 0;
    std::int64_t node_end = 0;
    double length_u = 0;
  };
  /// @param second the plane's second axis (sine) instead of the first (cosine)
  /// @pre   shape.sweep_rad != 0 and a radius > 0
  void start(const planner::ArcShape& shape, bool second, double step_u, const Ends& ends);

  /// Finds the next run of crossings in one direction; false when the segment has no more.
  bool find_run();

 private:
  using Run = double[kRun];  // [count], heights above the centre in steps, angles

  void begin_piece();
  double turning_share(std::int64_t m, double u_from) const;
  double turning_position(std::int64_t m, double u) const;
  double lag_rad(double u) const;
  double half_turns_rad(std::int64_t m) const;
  void circle_angles(const Run& height, Run& chi) const;
  void spiral_angles(const Run& height, Run& chi) const;
  double bracketed_angle(double height) const;

  double center_ = 0, radius_ = 0, growth_ = 0;  // steps
  double psi_rad_ = 0, sweep_rad_ = 0;
  double u_per_rad_ = 0, s_per_rad_u_ = 0, length_u_ = 0;
  double radius_per_rad_ = 0;
  std::int64_t last_extreme_ = 0;  // last m inside the segment
  std::int64_t node_last_ = 0;     // node of the segment's end

  // the piece from extreme piece_ (or the segment's beginning) to extreme piece_ + 1 (or its end); chi =
  // angle - piece_ pi
  std::int64_t piece_ = 0;
  bool last_piece_ = false;
  double parity_ = 1;        // cos(angle) = parity cos(chi)
  double piece_radius_ = 0;  // radius at chi = 0
  double piece_s_u_ = 0;     // path length at chi = 0
  double u_begin_ = 0, u_end_ = 0;
  double s_begin_u_ = 0, s_end_u_ = 0;
  double chi_begin_ = 0, chi_end_ = 0;
  std::int64_t node_begin_ = 0, node_end_ = 0;
  std::int64_t found_ = 0;  // crossings of this piece already found
};

}  // namespace kadr::interpolator
