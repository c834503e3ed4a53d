#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "machine/base/axes.h"
#include "machine/base/vocabulary.h"
#include "machine/choices.h"
#include "machine/tick_motion.h"

namespace kadr::planner {

using kadr::kLimitedBy;
using kadr::LimitedBy;

/// How the blockwise scheduler gave a block its whole control ticks (fill_block_ticks).
enum class TickRule : std::uint8_t {
  none,           ///< they were whole, or need not be
  lower_main,     ///< a: F_HK lowered
  stretch_brake,  ///< b: braking stretched
  lower_end,      ///< c: F_KK lowered
  scale,          ///< d: all speeds times kl (paper 003, eq. 3-4)
};
inline constexpr Vocabulary<TickRule, 5> kTickRules{{
    {TickRule::none, ""},
    {TickRule::lower_main, "a", "feed of the block lowered"},
    {TickRule::stretch_brake, "b", "braking stretched"},
    {TickRule::lower_end, "c", "feed at the block's end lowered"},
    {TickRule::scale, "d", "all speeds times kl"},
}};
static_assert(kTickRules.complete());

/// Per segment, made by the scheduler; boundary feeds are reachable within each segment.
struct SegmentPlan {
  double peak_u_s = 0;      ///< F_HK of paper 003: highest speed of s on the segment
  double end_u_s = 0;       ///< F_KK: speed at its end
  double kl = 1;            ///< factor in both of them, <= 1; below 1 with TickRule::scale only
  double end_jump_u_s = 0;  ///< speed just after its end minus end_u_s; not 0 only next to a kl
  double begin_time_s = 0;  ///< since the law's beginning
  double end_time_s = 0;
  LimitedBy limited_by = LimitedBy::program;  ///< limit of the peak
  std::int8_t limiting_axis = -1;             ///< machine axis, or -1
  TickRule rule = TickRule::none;
};

struct MotionState {
  double s_u, speed_u_s, accel_u_s2, jerk_u_s3;
};

/// s(t) as pieces of constant jerk (jerk = 0 and jumps of acceleration where a jerk limit is infinite), or of
/// quintic speed with acceleration and jerk zero at both ends:
///   v = v0 + rise (10 x^3 - 15 x^4 + 6 x^5),   s = s0 + v0 t + rise T x^4 (2.5 - 3 x + x^2),   x = t/T
struct JerkPiece {
  double begin_s = 0;     ///< time since the law's beginning, s
  double duration_s = 0;  ///< > 0
  double s_u = 0;         ///< path length at its beginning
  double speed_u_s = 0;
  double accel_u_s2 = 0;
  double jerk_u_s3 = 0;  ///< of a quintic piece its largest, 10/sqrt(3) rise/T^2, with the sign of the rise
  LimitedBy limited_by = LimitedBy::program;
  std::int8_t limiting_axis = -1;
  double quintic_rise_u_s = 0;  ///< change of speed over a quintic piece; 0: constant jerk

  bool is_quintic() const { return quintic_rise_u_s != 0.0; }
  bool is_hold() const { return accel_u_s2 == 0.0 && jerk_u_s3 == 0.0; }
  /// Path since the piece's beginning, and state there; t in [0, duration_s].
  double way_u(double t_s) const;
  double speed_after_u_s(double t_s) const;
  MotionState state_after(double t_s) const;
};

/// s(t), ds/dt >= 0, from rest to rest; s and ds/dt continuous, d2s/dt2 too where every jerk limit is finite;
/// except for the jumps of ds/dt that the table states (SegmentPlan::end_jump_u_s).
/// Consecutive runs (rest to rest) follow each other without a gap; `pause` pieces (speed 0) are allowed.
struct MotionLaw {
  std::vector<JerkPiece> pieces;  ///< ascending in time, without gaps
  double duration_s = 0;
  double length_u = 0;
  /// State at a time in [0, duration_s]; `hint` is the piece found last time (monotone callers pay O(1)).
  MotionState eval(double time_s, std::size_t& hint) const;
};

/// A rapid that planner.rapid_law took care of.
struct PositionedSegment {
  std::uint32_t segment = 0;
  machine::RapidShape shape = machine::RapidShape::scurve;  ///< never automatic; scurve: nothing there rings
  std::string_view reason;                                  ///< of an automatic choice, else empty
  double loss_s = 0;                                        ///< over the fastest motion within the limits
  std::array<double, kProgramAxes> residual_u{};  ///< [machine axes] amplitude of the remaining vibration
};

/// A standstill that the program asks for where the path rests: a dwell, a tool change, a wait.
struct Pause {
  std::size_t after_segment = 0;  ///< number of path segments before it; the path rests there
  double hold_s = 0;              ///< > 0
};

struct FeedPlan {
  std::vector<SegmentPlan> segments;          ///< [path.size()]
  MotionLaw law;                              ///< pauses included
  std::vector<PositionedSegment> positioned;  ///< ascending
  double motion_s = 0;                        ///< what the law would last without its pauses
  double pause_s = 0;                         ///< sum of the pauses
};

}  // namespace kadr::planner
