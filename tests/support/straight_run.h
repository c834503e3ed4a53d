#pragma once
#include <vector>

#include "emulator/cycle/monitor/tick_view.h"
#include "machine/machine.h"
#include "planner/path/path.h"

namespace kadr::test {

/// A path along the first axis: one line per length, each a block of its own; block i stands on line i + 1.
inline planner::Path straight_path(const std::vector<double>& lengths_u, int axes = 1) {
  planner::Path path(axes);
  path.start_s_u = {0.0};
  path.nodes_u.assign(static_cast<std::size_t>(axes), 0.0);
  for (std::size_t i = 0; i < lengths_u.size(); ++i) {
    planner::PathSegment s;
    s.block = static_cast<std::uint32_t>(i);
    s.span.line = static_cast<std::uint32_t>(i) + 1;
    s.length_u = s.feed_length_u = lengths_u[i];
    path.segments.push_back(s);
    path.start_s_u.push_back(path.start_s_u.back() + lengths_u[i]);
    path.nodes_u.insert(path.nodes_u.end(), static_cast<std::size_t>(axes), 0.0);
    path.nodes_u[path.nodes_u.size() - static_cast<std::size_t>(axes)] = path.start_s_u.back();
  }
  return path;
}

/// Control ticks along a straight path, made by hand: where each ends and how fast.
class StraightRun {
 public:
  StraightRun(const planner::Path& path, const machine::MachineModel& machine)
      : plant(machine.axis.size()), energy(machine.axis.size()), path_(path), machine_(machine) {
    batch_.axis.resize(machine.axis.size());
    motion_.tick = ControlTicks{-1};
  }
  /// The next control tick. The plant's states and energies are as the test has set them before.
  cycle::TickView tick(double s_end_u, double speed_end_u_s, bool with_plant = true) {
    ++motion_.tick;
    motion_.s_begin_u = motion_.s_end_u;
    motion_.s_end_u = s_end_u;
    motion_.speed_end_u_s = speed_end_u_s;
    AxisCommand& x = batch_.axis[0].command;
    x.position_begin_u = x.position_end_u;
    x.position_end_u = s_end_u;
    while (segment_ + 1 < path_.size() && s_end_u > path_.start_s_u[segment_ + 1]) ++segment_;
    const std::int64_t tau = machine_.clock.control_tick.value;
    return {motion_,
            batch_,
            segment_,
            Ticks{motion_.tick.value * tau},
            Ticks{(motion_.tick.value + 1) * tau},
            with_plant ? &plant : nullptr,
            with_plant ? &energy : nullptr};
  }

  std::vector<AxisState> plant;              ///< [axes]
  std::vector<plant::EnergyBalance> energy;  ///< [axes]

 private:
  const planner::Path& path_;
  const machine::MachineModel& machine_;
  TickMotion motion_{};
  StepBatch batch_;
  std::size_t segment_ = 0;
};

}  // namespace kadr::test
