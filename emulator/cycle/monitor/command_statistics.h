#pragma once
#include <vector>

#include "emulator/cycle/monitor/commanded_motion.h"
#include "emulator/log/records.h"

namespace kadr::cycle {

/// Counts pulses and keeps the extremes of the commanded motion, axis by axis and along the path.
class CommandStatistics {
 public:
  /// @param commanded  of each tick before tick() is called; outlives this, as path does
  CommandStatistics(const planner::Path& path, const CommandedMotion& commanded);
  void tick(const TickView& view);
  /// @param summary  with its axes [axes]
  void summarize(log::RunSummary& summary) const;

 private:
  struct Axis {
    std::int64_t pulses = 0;
    Steps net_steps;
    double min_u = 0, max_u = 0;
    double peak_feed_u_s = 0;
    Ticks peak_feed_tick;
    double peak_accel_u_s2 = 0, peak_jerk_u_s3 = 0;
  };
  const planner::Path& path_;
  const CommandedMotion& commanded_;
  std::vector<Axis> axes_;
  double peak_feed_u_s_ = 0, held_error_u_ = 0;
};

}  // namespace kadr::cycle
