#pragma once
#include <span>
#include <vector>

#include "planner/path/joints.h"
#include "planner/path/path.h"
#include "planner/verify/verify.h"
#include "planner/verify/verify_blocks.h"

namespace kadr::planner {

/// What all parts of verify() share: what is looked at, how exactly, and what was found.
class VerifyContext {
 public:
  VerifyContext(const Joints& joints, const FeedPlan& plan, const machine::MachineModel& machine,
                const VerifyOptions& options, std::span<const Pause> pauses);

  const Joints& joints;
  const Path& path;
  const FeedPlan& plan;
  const MotionLaw& law;
  const machine::MachineModel& machine;
  const VerifyOptions& options;
  const std::span<const Pause> pauses;
  std::vector<Violation> found;

  bool full() const { return found.size() >= options.most; }
  void report(const char* what, double time_s, std::size_t segment, int axis, double value, double limit);

  double slack_u() const { return slack_u_; }  ///< lengths of the path closer than this are one
  double top_speed_u_s() const { return top_speed_u_s_; }
  /// Of a speed reached under an acceleration at a time, both of which are rounded.
  double speed_tolerance(double v_u_s, double a_u_s2, double time_s) const;
  /// Of the length at a piece's end.
  double way_tolerance_u(const JerkPiece& piece) const;
  double way_tolerance_u(const JerkPiece& piece, const VerifiedState& end) const;
  /// Within a piece, when it reaches s: Newton's method in a bracket that bisection closes.
  double time_of(const JerkPiece& piece, double s_u) const;

  std::size_t segment_at(double s_u) const;
  /// Whether the limits of the axes themselves are kept on a segment.
  bool axes_enforced(const PathSegment& segment) const;
  bool jerk_limited(std::size_t segment) const;
  /// Whether every segment at a length of the path has a jerk limit.
  bool jerk_limited_around(double s_u) const;
  /// A rapid of an axis with a flexible link, where such a rapid ends before anything else moves.
  bool positions(std::size_t segment) const;

 private:
  double slack_u_ = 0;
  double top_speed_u_s_ = 0;
  mutable std::size_t hint_ = 0;  // segment of the last segment_at()
};

/// The law by itself: it begins and ends at rest, and s, speed, acceleration (and jerk) don't jump.
void verify_law_ends(VerifyContext& c);
void verify_law_links(VerifyContext& c);
/// The law on the path: the limits of path, axes, arcs, curves and joints, over the segments from `first` to
/// the one before `last`.
void verify_limits(VerifyContext& c, std::size_t first, std::size_t last);
/// The path rests where it has to, on whole control ticks where asked.
void verify_stops(VerifyContext& c);
/// The plan's table of segments says what the law does.
void verify_table(VerifyContext& c);

}  // namespace kadr::planner
