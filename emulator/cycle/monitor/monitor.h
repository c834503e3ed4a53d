#pragma once
#include <vector>

#include "emulator/cycle/event_list.h"
#include "emulator/cycle/monitor/block_ends.h"
#include "emulator/cycle/monitor/command_statistics.h"
#include "emulator/cycle/monitor/commanded_motion.h"
#include "emulator/cycle/monitor/limit_watch.h"
#include "emulator/cycle/monitor/plant_statistics.h"
#include "emulator/cycle/monitor/slip_watch.h"
#include "emulator/cycle/monitor/stop_residual.h"
#include "emulator/cycle/monitor/tick_view.h"

namespace kadr::cycle {

/// Watches a run, control tick by control tick: the command for overruns of limits, the plant for vibration
/// and lost steps. Each subject is a class of its own; this one calls them in the order in
/// which the log has their events.
class Monitor {
 public:
  /// @param path, machine, events, block_ends  outlive this
  Monitor(const planner::Path& path, const machine::MachineModel& machine, EventList& events,
          std::vector<log::BlockEndRecord>& block_ends);
  /// @pre events.segment() == view.segment
  void tick(const TickView& view);
  /// After tick(): lost steps that the plant found in it.
  void lost_steps(const std::vector<plant::LostSteps>& lost, Ticks end) { slips_.tick(lost, end); }
  /// Ends what is open: overruns, slips, the residual of the last stop, the last block.
  void finish(Ticks end);
  /// Fills in the axes, pulses, path error, peak feeds and number of alarms.
  void summarize(log::RunSummary& summary) const;
  std::size_t alarms() const { return limits_.alarms() + slips_.alarms(); }

 private:
  EventList& events_;
  std::size_t axes_;
  CommandedMotion commanded_;
  LimitWatch limits_;
  CommandStatistics command_;
  PlantStatistics plant_;
  StopResidual residual_;
  SlipWatch slips_;
  BlockEnds blocks_;
};

}  // namespace kadr::cycle
