#pragma once
#include <cstdint>
#include <vector>

#include "emulator/interpolator/interpolator.h"

namespace kadr::interpolator {

/// The interpolator's check of itself: |node - x(t_event)| <= 1/2 step for every axis at every event. It
/// shares no formula with the crossings: s comes from the tick's motion at the event's unrounded moment, x
/// from the path.
class NodeCheck {
 public:
  NodeCheck(const planner::Path& path, const machine::MachineModel& machine);
  /// @param nodes   lattice nodes before the tick's first event [axes]
  /// @param events  the tick's events in path order
  void add(const planner::TickMotion& motion, const std::vector<std::int64_t>& nodes,
           const std::vector<StepEvent>& events);
  /// Where the largest error of all axes was.
  std::size_t worst_segment() const { return worst_segment_; }
  const std::vector<double>& worst_steps() const { return worst_steps_; }

 private:
  void measure(std::size_t segment, std::size_t axis, std::int64_t node, double s_u);

  const planner::Path& path_;
  const machine::MachineModel& machine_;
  std::vector<std::int64_t> nodes_;
  std::vector<double> position_u_, reach_u_, worst_steps_;
  double worst_ = 0;
  std::size_t worst_segment_ = 0;
};

}  // namespace kadr::interpolator
