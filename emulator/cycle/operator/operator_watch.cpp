#include "emulator/cycle/operator/operator_watch.h"

#include <fmt/format.h>

namespace kadr::cycle {

using planner::LimitedBy;
using planner::OverrideNote;

OperatorWatch::OperatorWatch(const planner::MotionLaw& law, double tau_s, EventList& events)
    : lost_(law, tau_s), events_(events) {}

void OperatorWatch::tick(const TickMotion& motion, const planner::OperatorInput& input,
                         double spindle_override, Ticks begin) {
  if (motion.note == OverrideNote::none || motion.note == OverrideNote::limited)
    deferred_ticks_ = ControlTicks{};
  else
    ++deferred_ticks_;
  const bool locked_overload = motion.note == OverrideNote::locked && spindle_override < 1;
  if (locked_overload && !locked_overload_) {
    events_.alarm(begin, Code::overload_locked, spindle_override * 100, 100,
                  fmt::format("the load asks for {:.6g} %, but the feed is locked", spindle_override * 100));
    ++alarms_;
  }
  locked_overload_ = locked_overload;
  const bool rests = motion.s_end_u == motion.s_begin_u;
  if (rests && motion.limited_by == LimitedBy::stop) return;  // a pause of the program
  name_reason(motion, input, spindle_override);
  lost_.add(motion, reason_);
}

/// The reason stays where none of them holds: the motion still comes back from the last one.
void OperatorWatch::name_reason(const TickMotion& motion, const planner::OperatorInput& input,
                                double spindle_override) {
  if (input.hold || motion.limited_by == LimitedBy::hold)
    reason_ = log::LostReason::hold;
  else if (motion.note == OverrideNote::deferred)
    reason_ = log::LostReason::deferral;
  else if (motion.limiter < 1)
    reason_ = log::LostReason::limiter;
  else if (spindle_override < 1)
    reason_ = log::LostReason::spindle_load;
  else if (motion.override_used != 1 || input.rapid_override != 1)
    reason_ = log::LostReason::feed_override;
}

}  // namespace kadr::cycle
