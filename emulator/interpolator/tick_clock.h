#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "planner/laws/motion_source.h"

namespace kadr::interpolator {

/// Inverse of one control tick's motion s(t): the moment at which a position of the path is reached.
///
/// With w = (s - s_begin)/(s_end - s_begin) and z = (t - t_b)/(t_e - t_b), both in [0, 1], ramp speeds v0, v1
/// and p = v0/(v0 + v1), the linear feed of planner/laws/motion_source.h reads
///
///   w = 2 p z + (1 - 2p) z^2    =>    z = w / (p + sqrt(p^2 + (1 - 2p) w))
///
/// the root without cancellation, for a start from rest (p = 0), a steady feed (1/2) and a stop (1) alike.
/// Fixed operation count, + - * / sqrt only, no branch, so that a loop over pulses runs in vector registers.
struct TickClock {
  double s_begin_u = 0;
  double inverse_ds_per_u = 0;  ///< 1/(s_end - s_begin)
  double p = 0.5;               ///< share of the begin speed, in [0, 1]
  double begin_ticks = 0;       ///< t_b
  double span_ticks = 0;        ///< t_e - t_b
  std::int32_t last_tick = 0;   ///< tau - 1, the largest offset

  /// @pre motion.s_end_u > motion.s_begin_u
  TickClock(const planner::TickMotion& motion, std::int64_t control_tick);

  /// Share of the tick's path that is done `ds_u` after its beginning, clamped to [0, 1]; not-a-number becomes 0.
  double share(double ds_u) const {
    const double w = ds_u * inverse_ds_per_u;
    const double positive = w > 0.0 ? w : 0.0;
    return positive < 1.0 ? positive : 1.0;
  }
  /// Unrounded moment in base ticks since the control tick's beginning.
  double moment_ticks(double ds_u) const {
    const double w = share(ds_u);
    const double square = p * p + (1.0 - 2.0 * p) * w;
    const double root = std::sqrt(square > 0.0 ? square : 0.0);
    // the tiny number changes nothing but 0/0 at the very start of a motion from rest
    return begin_ticks + span_ticks * (w / (p + root + 1e-300));
  }
  /// The same for constant speed (p = 1/2), where the formula above is w/1: the same bits, without sqrt and division.
  double steady_moment_ticks(double ds_u) const { return begin_ticks + span_ticks * share(ds_u); }

  /// The base tick that holds a moment.
  std::uint16_t offset(double moment) const {
    const auto tick = static_cast<std::int32_t>(moment);
    return static_cast<std::uint16_t>(std::min(tick, last_tick));
  }
  bool steady() const { return p == 0.5; }
};

/// Stamps the pulses of a line: pulse k lies at s_k = (first_level + k) spacing_u on its segment.
///
/// @param k_begin         first pulse, counted on the segment
/// @param segment_ahead_u segment's beginning minus the tick's beginning, along the path
/// @param offset_ticks    [count], written
void stamp_line(const TickClock& clock, double first_level, double spacing_u, std::int64_t k_begin,
                std::size_t count, double segment_ahead_u, std::uint16_t* offset_ticks);

/// Stamps pulses at given positions s_u[count] of their segment.
void stamp_list(const TickClock& clock, const double* s_u, std::size_t count, double segment_ahead_u,
                std::uint16_t* offset_ticks);

/// Makes offsets never decrease, from `begin` on: two crossings within rounding of each other may swap base ticks.
void keep_ascending(std::uint16_t* offset_ticks, std::size_t count);

}  // namespace kadr::interpolator
