#include "emulator/cycle/monitor/monitor.h"

#include "machine/machine.h"

namespace kadr::cycle {

Monitor::Monitor(const planner::Path& path, const machine::MachineModel& machine, EventList& events,
                 std::vector<log::BlockEndRecord>& block_ends)
    : events_(events),
      axes_(machine.axis.size()),
      commanded_(path, machine),
      limits_(machine, commanded_, events),
      command_(path, commanded_),
      plant_(machine, commanded_),
      residual_(machine, events),
      slips_(machine, events),
      blocks_(path, machine.axis.size(), block_ends) {}

void Monitor::tick(const TickView& view) {
  commanded_.tick(view);
  limits_.tick(view.end);
  command_.tick(view);
  plant_.tick(view, events_.line());
  residual_.tick(view);
  blocks_.tick(view);
}

void Monitor::finish(Ticks end) {
  limits_.finish(end);
  slips_.finish(end);
  residual_.finish(end);
  blocks_.finish(end);
}

void Monitor::summarize(log::RunSummary& summary) const {
  summary.axis.assign(axes_, log::AxisSummary{});
  command_.summarize(summary);
  plant_.summarize(summary);
  residual_.summarize(summary);
  slips_.summarize(summary);
  summary.alarms = alarms();
}

}  // namespace kadr::cycle
