#pragma once
#include <cstdint>

#include "machine/base/count.h"
#include "machine/base/vocabulary.h"

/// How the path moves in a control tick: made by a planner's MotionSource, read by interpolator and log.
namespace kadr {

/// What limited the feed at a position: the "limited by" column.
enum class LimitedBy : std::uint8_t {
  program,           ///< programmed feed reached
  rapid,             ///< axis speed during a rapid
  path_feed,         ///< machine's path.max_feed_mm_s
  axis_speed,        ///< an axis' max feed
  centripetal,       ///< curvature
  junction,          ///< corner ahead or behind
  length,            ///< accelerating or braking: the path is too short for more
  stop,              ///< at rest
  override_percent,  ///< programmed feed times the operator's override
  hold,              ///< feed hold, or an override of 0
  limiter,           ///< the axis limiter
};
inline constexpr Vocabulary<LimitedBy, 11> kLimitedBy{{
    {LimitedBy::program, "program", "the programmed feed is reached"},
    {LimitedBy::rapid, "rapid", "axis speed during a rapid"},
    {LimitedBy::path_feed, "path feed", "feed.max_mm_s of the machine"},
    {LimitedBy::axis_speed, "axis speed", "highest speed of an axis"},
    {LimitedBy::centripetal, "centripetal", "curvature of the path"},
    {LimitedBy::junction, "junction", "a corner ahead or behind"},
    {LimitedBy::length, "length", "speeding up or braking: the path is too short for more"},
    {LimitedBy::stop, "stop", "at rest"},
    {LimitedBy::override_percent, "override", "the programmed feed times the override"},
    {LimitedBy::hold, "hold", "feed hold, or an override of 0"},
    {LimitedBy::limiter, "limiter", "the axis limiter"},
}};
static_assert(kLimitedBy.complete());

/// Why a requested override is not in force in a control tick.
enum class OverrideNote : std::uint8_t {
  none,
  deferred,  ///< the motion brakes for a point ahead
  locked,    ///< thread, tap, M49
  limited,   ///< the axis limiter lowers the feed
};
inline constexpr Vocabulary<OverrideNote, 4> kOverrideNotes{{
    {OverrideNote::none, "in force"},
    {OverrideNote::deferred, "deferred: braking", "the motion brakes for a point ahead"},
    {OverrideNote::locked, "locked", "thread, tap, M49"},
    {OverrideNote::limited, "axis limiter", "the axis limiter lowers the feed"},
}};
static_assert(kOverrideNotes.complete());

/// How s moves in one control tick. Exact at both ends of the tick; between them the feed runs linearly over
/// [move_begin, move_end] (base ticks within the tick, fractions allowed) and the path rests outside of it,
/// so that s never decreases, even where a motion starts or ends inside the tick:
///   s(t) = s_begin + ramp_begin * (t - t_b) + (ramp_end - ramp_begin) * (t - t_b)^2 / (2 (t_e - t_b))
struct TickMotion {
  ControlTicks tick;
  double s_begin_u = 0;  ///< path length, as Path::start_s_u counts
  double s_end_u = 0;
  double speed_begin_u_s = 0;  ///< the law's speed at the tick's beginning and end
  double speed_end_u_s = 0;
  double move_begin_ticks = 0;
  double move_end_ticks = 0;
  /// speed at move_begin and move_end of the linear feed; (sum / 2) * (t_e - t_b) = s_end - s_begin
  double ramp_begin_u_s = 0;
  double ramp_end_u_s = 0;
  double accel_end_u_s2 = 0;        ///< of the law at the tick's end, for the log
  double override_requested = 1.0;  ///< ratio
  double override_used = 1.0;       ///< in force at the tick's end
  OverrideNote note = OverrideNote::none;
  double limiter = 1.0;  ///< K_max of the axis limiter, 1 where it does nothing
  LimitedBy limited_by = LimitedBy::program;
  std::int8_t limiting_axis = -1;
  double held_error_u = 0;  ///< tick_feed = constant: largest distance from the law inside the tick
};

}  // namespace kadr
