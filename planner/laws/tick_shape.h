#pragma once
#include <algorithm>

#include "planner/laws/motion_source.h"

namespace kadr::planner {

/// Linear feed over a tick that keeps the law's path and speeds at both ends:
///   ramp_begin = S/tau - (v1 - v0)/2,  ramp_end = S/tau + (v1 - v0)/2
/// Where that would run backwards, the path rests for a part of the tick: it starts late, or ends early.
inline void shape_linear_feed(TickMotion& m, double tau_s, double tick_ticks) {
  const double way = m.s_end_u - m.s_begin_u;
  const double v0 = m.speed_begin_u_s;
  const double v1 = m.speed_end_u_s;
  const double mean = way / tau_s;
  m.ramp_begin_u_s = mean - 0.5 * (v1 - v0);
  m.ramp_end_u_s = mean + 0.5 * (v1 - v0);
  m.move_begin_ticks = 0.0;
  m.move_end_ticks = tick_ticks;
  if (m.ramp_begin_u_s < 0.0) {  // then v1 > 2 mean: the triangle 0 -> v1 at the tick's end
    m.ramp_begin_u_s = 0.0;
    m.ramp_end_u_s = v1;
    m.move_begin_ticks = tick_ticks - tick_ticks * std::min(2.0 * mean / v1, 1.0);
  } else if (m.ramp_end_u_s < 0.0) {
    m.ramp_begin_u_s = v0;
    m.ramp_end_u_s = 0.0;
    m.move_end_ticks = tick_ticks * std::min(2.0 * mean / v0, 1.0);
  }
}

}  // namespace kadr::planner
