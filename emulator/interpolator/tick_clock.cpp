#include "emulator/interpolator/tick_clock.h"

#include "machine/base/require.h"

namespace kadr::interpolator {

namespace {

/// Both loops must stay free of branches and calls: the compiler turns them into vector code.
template <class Moment>
inline void stamp_line_loop(const TickClock& clock, double first_level, double spacing_u, double k_begin,
                            int count, double segment_ahead_u, std::uint16_t* out, Moment moment) {
  for (int i = 0; i < count; ++i) {
    // k is exact as a double, so a pulse's position does not depend on the tick it is stamped in
    const double k = k_begin + static_cast<double>(i);
    const double s_u = (first_level + k) * spacing_u;
    out[i] = clock.offset(moment(s_u + segment_ahead_u));
  }
}

template <class Moment>
inline void stamp_list_loop(const TickClock& clock, const double* s_u, int count, double segment_ahead_u,
                            std::uint16_t* out, Moment moment) {
  for (int i = 0; i < count; ++i) out[i] = clock.offset(moment(s_u[i] + segment_ahead_u));
}

}  // namespace

TickClock::TickClock(const planner::TickMotion& motion, std::int64_t control_tick)
    : s_begin_u(motion.s_begin_u),
      inverse_ds_per_u(1.0 / (motion.s_end_u - motion.s_begin_u)),
      last_tick(static_cast<std::int32_t>(control_tick - 1)) {
  const double tau = static_cast<double>(control_tick);
  const double sum = motion.ramp_begin_u_s + motion.ramp_end_u_s;
  if (sum > 0.0) p = std::clamp(motion.ramp_begin_u_s / sum, 0.0, 1.0);
  begin_ticks = std::clamp(motion.move_begin_ticks, 0.0, tau);
  span_ticks = std::clamp(motion.move_end_ticks, begin_ticks, tau) - begin_ticks;
  require(begin_ticks == begin_ticks && span_ticks == span_ticks && p == p,
          "a tick's motion is made of numbers");
}

void stamp_line(const TickClock& clock, double first_level, double spacing_u, std::int64_t k_begin,
                std::size_t count, double segment_ahead_u, std::uint16_t* offset_ticks) {
  const TickClock c = clock;  // a copy that the stores cannot alias
  const auto k0 = static_cast<double>(k_begin);
  const auto n = static_cast<int>(count);
  if (c.steady()) {
    stamp_line_loop(c, first_level, spacing_u, k0, n, segment_ahead_u, offset_ticks,
                    [&c](double ds_u) { return c.steady_moment_ticks(ds_u); });
  } else {
    stamp_line_loop(c, first_level, spacing_u, k0, n, segment_ahead_u, offset_ticks,
                    [&c](double ds_u) { return c.moment_ticks(ds_u); });
  }
}

void stamp_list(const TickClock& clock, const double* s_u, std::size_t count, double segment_ahead_u,
                std::uint16_t* offset_ticks) {
  const TickClock c = clock;
  const auto n = static_cast<int>(count);
  if (c.steady()) {
    stamp_list_loop(c, s_u, n, segment_ahead_u, offset_ticks,
                    [&c](double ds_u) { return c.steady_moment_ticks(ds_u); });
  } else {
    stamp_list_loop(c, s_u, n, segment_ahead_u, offset_ticks,
                    [&c](double ds_u) { return c.moment_ticks(ds_u); });
  }
}

void keep_ascending(std::uint16_t* offset_ticks, std::size_t count) {
  // almost every tick is in order already: that question runs in vector registers, the repair does not
  unsigned falls = 0;
  for (std::size_t i = 1; i < count; ++i)
    falls |= static_cast<unsigned>(offset_ticks[i] < offset_ticks[i - 1]);
  if (falls == 0) return;
  for (std::size_t i = 1; i < count; ++i) offset_ticks[i] = std::max(offset_ticks[i], offset_ticks[i - 1]);
}

}  // namespace kadr::interpolator
