#pragma once
#include <vector>

#include "planner/laws/feed_plan.h"
#include "planner/time_law/jerk_limited.h"

namespace kadr::planner {

/// Limits of a motion between two nodes.
struct IntervalLimits {
  double speed_u_s;
  double accel_u_s2;
  double jerk_u_s3;  ///< inf: none
};

/// An interval in which acceleration runs from a0 over am in the middle of its time to a1, straight: exact in
/// path, speed and acceleration at both ends.
///   T v0/2 + T v1/2 + T^2 (a0 - a1)/12 = ds,   am = 2 (v1 - v0)/T - (a0 + a1)/2
struct IntervalMotion {
  double time_s = 0;
  double v0_u_s = 0, v1_u_s = 0;
  double a0_u_s2 = 0, am_u_s2 = 0, a1_u_s2 = 0;

  double first_jerk_u_s3() const { return 2.0 * (am_u_s2 - a0_u_s2) / time_s; }
  double second_jerk_u_s3() const { return 2.0 * (a1_u_s2 - am_u_s2) / time_s; }
  double middle_u_s() const { return v0_u_s + 0.25 * time_s * (a0_u_s2 + am_u_s2); }
  double lowest_u_s() const;
  double highest_u_s() const;
};

/// The motion between two nodes.
/// @pre there is one: v0 + v1 > 0, ((v0 + v1)/2)^2 + ds (a0 - a1)/3 >= 0
IntervalMotion interval_motion(double ds_u, double v0_u_s, double v1_u_s, double a0_u_s2, double a1_u_s2);

/// A law of node speeds, from rest to rest, as a motion whose acceleration is continuous. At a node it is
/// that of the line between the middles of both intervals' times, steep on both sides as the jerk there may
/// be, and 0 at both ends; where speed would run below zero between nodes it is lowered until it does not.
/// @param s_u        [nodes], ascending
/// @param speed_u_s  [nodes], 0 at both ends, > 0 inside
/// @param limits     [nodes], of the interval that ends at a node; no node's acceleration is above them
/// @param jerk       what the steepness follows
/// @return [nodes], of the interval that ends at a node; none for node 0
std::vector<IntervalMotion> jerk_motion(const std::vector<double>& s_u, const std::vector<double>& speed_u_s,
                                        const std::vector<IntervalLimits>& limits, const NodeJerk& jerk);

/// Appends an interval as pieces of constant jerk; parted where acceleration passes 0, so that the highest
/// speed of a piece is at one of its ends. Times begin at 0: the writer of pieces counts them.
void add_pieces(const IntervalMotion& motion, double s_u, LimitedBy reason, std::int8_t axis,
                std::vector<JerkPiece>& out);

}  // namespace kadr::planner
