#pragma once
#include <cstdint>

#include "machine/base/count.h"
#include "planner/laws/feed_plan.h"

namespace kadr::machine {
struct MachineModel;
}

namespace kadr::planner {

using kadr::OverrideNote;
using kadr::TickMotion;

/// Requests of the operator and the machine for this control tick.
struct OperatorInput {
  double feed_override = 1.0;   ///< 0..2; the operator's and the spindle's override together
  double rapid_override = 1.0;  ///< 0..1
  bool hold = false;            ///< feed hold
  bool emergency_stop = false;  ///< stop now, whatever is locked
};

/// The one door between planning and the cycle: the cycle asks once per control tick how the path moves in it.
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
  /// Goes on from another time of the law, where it rests at path length s, as if
  /// `tick` control ticks had passed before.
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
