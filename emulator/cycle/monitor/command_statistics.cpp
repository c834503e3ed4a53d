#include "emulator/cycle/monitor/command_statistics.h"

#include <algorithm>
#include <cmath>

#include "planner/path/path.h"

namespace kadr::cycle {

CommandStatistics::CommandStatistics(const planner::Path& path, const CommandedMotion& commanded)
    : path_(path), commanded_(commanded), axes_(commanded.size()) {
  for (std::size_t a = 0; a < axes_.size(); ++a) axes_[a].min_u = axes_[a].max_u = commanded[a].position_u;
}

void CommandStatistics::tick(const TickView& view) {
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    Axis& axis = axes_[a];
    const AxisPulses& pulses = view.batch.axis[a];
    axis.pulses += static_cast<std::int64_t>(pulses.count());
    axis.net_steps += pulses.net_steps();
    const CommandedAxis& now = commanded_[a];
    if (now.at_rest) continue;
    axis.min_u = std::min(axis.min_u, now.position_u);
    axis.max_u = std::max(axis.max_u, now.position_u);
    if (std::fabs(now.speed_u_s) > axis.peak_feed_u_s) {
      axis.peak_feed_u_s = std::fabs(now.speed_u_s);
      axis.peak_feed_tick = view.end;
    }
    // a corner's step of speed is not the axis's acceleration
    if (!commanded_.accel_spans_joint())
      axis.peak_accel_u_s2 = std::max(axis.peak_accel_u_s2, std::fabs(now.accel_u_s2));
    if (!commanded_.jerk_spans_joint())
      axis.peak_jerk_u_s3 = std::max(axis.peak_jerk_u_s3, std::fabs(now.jerk_u_s3));
  }
  if (path_.size() > 0) {
    const planner::PathSegment& s = path_.segments[view.segment];
    peak_feed_u_s_ = std::max(peak_feed_u_s_, view.motion.speed_end_u_s * s.feed_length_u / s.length_u);
  }
  held_error_u_ = std::max(held_error_u_, view.motion.held_error_u);
}

void CommandStatistics::summarize(log::RunSummary& summary) const {
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const Axis& axis = axes_[a];
    log::AxisSummary& s = summary.axis[a];
    s.pulses = axis.pulses;
    s.net_steps = axis.net_steps;
    s.end_u = commanded_[a].position_u;
    s.min_u = axis.min_u;
    s.max_u = axis.max_u;
    s.peak_feed_u_s = axis.peak_feed_u_s;
    s.peak_feed_tick = axis.peak_feed_tick;
    s.peak_accel_u_s2 = axis.peak_accel_u_s2;
    s.peak_jerk_u_s3 = axis.peak_jerk_u_s3;
    summary.pulses += axis.pulses;
  }
  summary.peak_feed_u_s = peak_feed_u_s_;
  summary.held_error_u = held_error_u_;
}

}  // namespace kadr::cycle
