#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "planner/path.h"

namespace kadr::planner {

/// What held the feed at a place: our signature column.
enum class LimitedBy : std::uint8_t {
  program,           ///< programmed feed reached
  rapid,             ///< axis speed during a rapid
  path_feed,         ///< machine's path.max_feed_mm_s
  axis_speed,        ///< an axis' max feed
  centripetal,       ///< curvature
  junction,          ///< corner ahead or behind
  length,            ///< accelerating or braking: the path is too short for more
  stop,              ///< at rest
  override_percent,  ///< programmed feed times the operator's percent
  hold,              ///< feed hold, or a percent of 0
  limiter,           ///< the axis limiter
};
std::string_view limited_by_name(LimitedBy reason);

/// Per segment, made by the scheduler; boundary feeds are reachable within each segment.
struct SegmentPlan {
  double peak_u_s = 0;      ///< F_HK of paper 003: highest speed of s on the segment
  double end_u_s = 0;       ///< F_KK: speed at its end
  double begin_time_s = 0;  ///< since the law's beginning
  double end_time_s = 0;
  LimitedBy limited_by = LimitedBy::program;  ///< what held the peak
  std::int8_t limiting_axis = -1;             ///< machine axis, or -1
};

/// s(t) as pieces of constant jerk (jerk = 0 and jumps of acceleration where a jerk limit is infinite).
struct JerkPiece {
  double begin_s = 0;     ///< time since the law's beginning, s
  double duration_s = 0;  ///< > 0
  double s_u = 0;         ///< path length at its beginning
  double speed_u_s = 0;
  double accel_u_s2 = 0;
  double jerk_u_s3 = 0;
  LimitedBy limited_by = LimitedBy::program;
  std::int8_t limiting_axis = -1;
};

struct MotionState {
  double s_u, speed_u_s, accel_u_s2, jerk_u_s3;
};

/// s(t), ds/dt >= 0, from rest to rest; s and ds/dt continuous, d2s/dt2 too where every jerk limit is finite.
/// Consecutive runs (rest to rest) follow each other without a gap; `pause` pieces (speed 0) are allowed.
struct MotionLaw {
  std::vector<JerkPiece> pieces;  ///< ascending in time, without gaps
  double duration_s = 0;
  double length_u = 0;
  /// State at a time in [0, duration_s]; `hint` is the piece found last time (monotone callers pay O(1)).
  MotionState eval(double time_s, std::size_t& hint) const;
};

struct FeedPlan {
  std::vector<SegmentPlan> segments;  ///< [path.size()]
  MotionLaw law;
};

}  // namespace kadr::planner
