#pragma once
#include <cstdint>

#include "machine/base/count.h"
#include "planner/laws/feed_plan.h"

namespace kadr::planner {

/// What the operator and the machine ask of this control tick.
struct OperatorInput {
  double feed_override = 1.0;   ///< 0..2; the operator's and the spindle's percent together
  double rapid_override = 1.0;  ///< 0..1
  bool hold = false;            ///< feed hold
  bool emergency_stop = false;  ///< stop now, whatever is locked
};

/// Why a percent that was asked for is not in force in a control tick.
enum class OverrideNote : std::uint8_t {
  none,
  deferred,  ///< the motion brakes for a place ahead
  locked,    ///< thread, tap, M49
  limited,   ///< the axis limiter lowers the feed
};

/// How s moves in one control tick. Exact at both ends of the tick; between them the feed runs linearly over
/// [move_begin, move_end] (base ticks within the tick, fractions allowed) and the path rests outside of it,
/// so that s never runs back, also where a motion starts or ends inside the tick:
///   s(t) = s_begin + ramp_begin * (t - t_b) + (ramp_end - ramp_begin) * (t - t_b)^2 / (2 (t_e - t_b))
struct TickMotion {
  ControlTicks tick;
  double s_begin_u = 0;  ///< path length, as Path::start_s_u counts
  double s_end_u = 0;
  double speed_begin_u_s = 0;  ///< the law's speed at the tick's beginning and end
  double speed_end_u_s = 0;
  double move_begin_ticks = 0;
  double move_end_ticks = 0;
  double ramp_begin_u_s =
      0;  ///< speed at move_begin and move_end of the linear feed; (sum / 2) * (t_e - t_b) = s_end - s_begin
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

/// The one door between planning and the cycle: the cycle asks once per control tick how the path moves in
/// it.
class MotionSource {
 public:
  virtual ~MotionSource() = default;
  /// The next control tick's motion. After the end it answers with ticks at rest.
  virtual TickMotion advance(const OperatorInput& input) = 0;
  /// The path's end is reached and at rest.
  virtual bool finished() const = 0;
  /// At rest after an emergency stop: nothing moves any more.
  virtual bool stopped() const { return false; }
};

/// Plays a motion law computed beforehand, at 100 %.
class LawSource final : public MotionSource {
 public:
  LawSource(const MotionLaw& law, const machine::MachineModel& machine);
  TickMotion advance(const OperatorInput& input) override;
  bool finished() const override;

  /// The law's state at the end of the last tick, and the piece that it lies in.
  const MotionState& state() const { return state_; }
  std::size_t piece() const { return hint_; }
  /// Goes on from another time of the law, where it rests at path length s, as if `tick` control ticks had
  /// passed before.
  void seek(double time_s, double s_u, ControlTicks tick);
  double time_s() const;  ///< of the law, at the end of the last tick

 private:
  const MotionLaw& law_;
  const machine::MachineModel& machine_;
  ControlTicks tick_;
  ControlTicks from_tick_;  ///< tick at which the law stood at from_s_
  double from_s_ = 0;
  std::size_t hint_ = 0;
  MotionState state_{};
};

}  // namespace kadr::planner
