#pragma once
#include "machine/machine.h"
#include "machine/tick_motion.h"

namespace kadr::cycle {

/// Base tick at which the path reaches s inside a control tick: the inverse of TickMotion's linear feed.
/// @param s_u  path length; the tick's first or last moment if the tick does not pass it
Ticks base_tick_at(const TickMotion& motion, double s_u, const machine::ClockModel& clock);

/// Feed of the path at s inside a control tick, by its linear feed.
double feed_at_u_s(const TickMotion& motion, double s_u);

/// First base tick of a control tick.
inline Ticks begin_of(ControlTicks tick, const machine::ClockModel& clock) {
  return {tick.value * clock.control_tick.value};
}

}  // namespace kadr::cycle
