#include "emulator/cycle/tick_time.h"

#include <algorithm>
#include <cmath>

namespace kadr::cycle {

Ticks base_tick_at(const TickMotion& m, double s_u, const machine::ClockModel& clock) {
  const std::int64_t begin = m.tick.value * clock.control_tick.value;
  const double left_u = s_u - m.s_begin_u;
  const double span_ticks = m.move_end_ticks - m.move_begin_ticks;
  if (!(left_u > 0) || !(span_ticks > 0)) return {begin};
  const double span_s = span_ticks / static_cast<double>(clock.base_hz);
  const double accel_u_s2 = (m.ramp_end_u_s - m.ramp_begin_u_s) / span_s;
  const double root = std::sqrt(std::max(0.0, m.ramp_begin_u_s * m.ramp_begin_u_s + 2 * accel_u_s2 * left_u));
  const double t_s = 2 * left_u / (m.ramp_begin_u_s + root);
  const double ticks = m.move_begin_ticks + std::min(t_s, span_s) * static_cast<double>(clock.base_hz);
  return {begin + std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(ticks)), 0,
                                           clock.control_tick.value)};
}

double feed_at_u_s(const TickMotion& m, double s_u) {
  const double left_u = std::max(s_u - m.s_begin_u, 0.0);
  const double way_u = m.s_end_u - m.s_begin_u;
  if (!(way_u > 0)) return m.speed_end_u_s;
  const double v0 = m.ramp_begin_u_s, v1 = m.ramp_end_u_s;
  return std::sqrt(std::max(0.0, v0 * v0 + (v1 * v1 - v0 * v0) * std::min(left_u / way_u, 1.0)));
}

}  // namespace kadr::cycle
