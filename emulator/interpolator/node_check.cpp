#include "emulator/interpolator/node_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "machine/machine.h"
#include "planner/path/path.h"

namespace kadr::interpolator {

namespace {

/// s(t) of planner/laws/motion_source.h at a moment of the tick, measured from a joint.
double path_length_at(const planner::TickMotion& motion, double moment_ticks, double base_hz,
                      double joint_s_u) {
  const double after_s = (moment_ticks - motion.move_begin_ticks) / base_hz;
  const double span_s = (motion.move_end_ticks - motion.move_begin_ticks) / base_hz;
  double gone_u = motion.ramp_begin_u_s * after_s;
  if (span_s > 0.0)
    gone_u += (motion.ramp_end_u_s - motion.ramp_begin_u_s) * after_s * after_s / (2.0 * span_s);
  return (motion.s_begin_u - joint_s_u) + gone_u;
}

}  // namespace

NodeCheck::NodeCheck(const planner::Path& path, const machine::MachineModel& machine)
    : path_(path), machine_(machine) {
  const auto axes = static_cast<std::size_t>(path.axes());
  position_u_.resize(axes);
  reach_u_.resize(axes);
  worst_steps_.resize(axes);
}

void NodeCheck::add(const planner::TickMotion& motion, const std::vector<std::int64_t>& nodes,
                    const std::vector<StepEvent>& events) {
  nodes_ = nodes;
  const auto base_hz = static_cast<double>(machine_.clock.base_hz);
  for (const StepEvent& event : events) {
    const planner::PathSegment& piece = path_.segments[event.segment];
    const double s_u = path_length_at(motion, event.moment_ticks, base_hz, path_.start_s_u[event.segment]);
    planner::eval_position(path_, event.segment, s_u, position_u_);
    std::fill(reach_u_.begin(), reach_u_.end(), 0.0);
    if (piece.kind == planner::SegmentKind::arc) {
      const planner::ArcShape& arc = path_.arc_of(event.segment);
      reach_u_[static_cast<std::size_t>(arc.first_axis)] = std::fabs(arc.center_first_u) + arc.radius_begin_u;
      reach_u_[static_cast<std::size_t>(arc.second_axis)] =
          std::fabs(arc.center_second_u) + arc.radius_begin_u;
    }
    for (std::size_t axis = 0; axis < nodes_.size(); ++axis)
      measure(event.segment, axis, nodes_[axis], motion.s_end_u);
    const auto stepped = static_cast<std::size_t>(event.axis);
    nodes_[stepped] += event.sign;
    measure(event.segment, stepped, nodes_[stepped], motion.s_end_u);
  }
}

void NodeCheck::measure(std::size_t segment, std::size_t axis, std::int64_t node, double s_u) {
  const double step_u = machine_.axis[axis].step_u;
  // doubles can't resolve positions closer than this on a path of that length and at that position
  const double blur_u =
      4.0 * std::numeric_limits<double>::epsilon() * (s_u + std::fabs(position_u_[axis]) + reach_u_[axis]);
  const double error = std::fabs(static_cast<double>(node) - position_u_[axis] / step_u) - blur_u / step_u;
  worst_steps_[axis] = std::max(worst_steps_[axis], error);
  if (error <= worst_) return;
  worst_ = error;
  worst_segment_ = segment;
}

}  // namespace kadr::interpolator
