#pragma once
#include <cstddef>

#include "emulator/cycle/event_list.h"
#include "emulator/cycle/lost_time.h"
#include "planner/planner.h"

namespace kadr::cycle {

/// Watches a run under an operator: how long a change of the override waits, the time lost against the plan
/// and why, and a spindle overload that a lock keeps waiting (an alarm).
class OperatorWatch {
 public:
  /// @param law, events  outlive this
  OperatorWatch(const planner::MotionLaw& law, double tau_s, EventList& events);
  /// @param spindle_override  the spindle's part of the input's feed override, ratio
  /// @param begin             of the control tick
  void tick(const TickMotion& motion, const planner::OperatorInput& input, double spindle_override,
            Ticks begin);
  /// Control ticks that a change has been waiting for the motion before it.
  ControlTicks deferred_ticks() const { return deferred_ticks_; }
  std::vector<log::LimitShare> lost_by() const { return lost_.shares(); }
  std::size_t alarms() const { return alarms_; }

 private:
  void name_reason(const TickMotion& motion, const planner::OperatorInput& input, double spindle_override);

  LostTime lost_;
  EventList& events_;
  ControlTicks deferred_ticks_;
  bool locked_overload_ = false;  // in the last tick
  log::LostReason reason_ = log::LostReason::feed_override;
  std::size_t alarms_ = 0;
};

}  // namespace kadr::cycle
