#include "emulator/cycle/monitor/commanded_motion.h"

#include <algorithm>

#include "machine/machine.h"
#include "planner/path/path.h"

namespace kadr::cycle {

CommandedMotion::CommandedMotion(const planner::Path& path, const machine::MachineModel& machine)
    : path_(path), tau_s_(machine.clock.tau_s()), axes_(machine.axis.size()), tangent_(machine.axis.size()) {
  for (std::size_t a = 0; a < axes_.size(); ++a)
    axes_[a].position_u = path.size() > 0 ? path.node(0)[a] : machine.axis[a].home_u;
}

void CommandedMotion::tick(const TickView& view) {
  // the speeds at the ends of this tick belong to different segments: a corner may lie between them
  ticks_since_joint_ = view.segment != segment_ ? 0 : std::min(ticks_since_joint_ + 1, kLongAgo);
  segment_ = view.segment;
  const double feed_u_s = view.motion.speed_end_u_s;
  if (path_.size() > 0 && feed_u_s > 0)
    planner::eval_tangent(
        path_, segment_,
        std::clamp(view.motion.s_end_u - path_.start_s_u[segment_], 0.0, path_.segments[segment_].length_u),
        tangent_);
  else
    std::fill(tangent_.begin(), tangent_.end(), 0.0);
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const CommandedAxis last = axes_[a];
    CommandedAxis& axis = axes_[a];
    axis.position_u = view.batch.axis[a].command.position_end_u;
    axis.speed_u_s = tangent_[a] * feed_u_s;
    axis.accel_u_s2 = (axis.speed_u_s - last.speed_u_s) / tau_s_;
    axis.jerk_u_s3 = (axis.accel_u_s2 - last.accel_u_s2) / tau_s_;
    axis.at_rest = axis.position_u == last.position_u && axis.speed_u_s == 0 && axis.accel_u_s2 == 0 &&
                   axis.jerk_u_s3 == 0;
  }
}

}  // namespace kadr::cycle
