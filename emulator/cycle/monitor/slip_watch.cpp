#include "emulator/cycle/monitor/slip_watch.h"

#include <fmt/format.h>

#include "machine/base/codes.h"
#include "machine/machine.h"

namespace kadr::cycle {
namespace {

/// A motor that has kept up for so long is no longer slipping.
constexpr double kGrip_s = 0.1;

}  // namespace

SlipWatch::SlipWatch(const machine::MachineModel& machine, EventList& events)
    : machine_(machine),
      events_(events),
      axes_(machine.axis.size()),
      grip_{static_cast<std::int64_t>(kGrip_s / machine.clock.tau_s())} {}

void SlipWatch::tick(const std::vector<plant::LostSteps>& lost, Ticks end) {
  for (Axis& axis : axes_)
    if (axis.ticks_of_grip) ++*axis.ticks_of_grip;
  for (const plant::LostSteps& l : lost) {
    Axis& axis = axes_[static_cast<std::size_t>(l.axis)];
    axis.lost += l.steps;
    axis.slip += l.steps;
    if (!axis.ticks_of_grip) {
      ++alarms_;
      log::EventRecord& e = events_.add(end, log::EventKind::alarm);
      e.code = Code::lost_steps;
      e.axis = l.axis;
      e.value = static_cast<double>(l.steps.value);
      e.text = fmt::format("axis {} lost {} steps", machine_.axis[static_cast<std::size_t>(l.axis)].letter,
                           l.steps.value);
    }
    axis.ticks_of_grip = ControlTicks{};
  }
  end_slips(grip_, end);
}

void SlipWatch::finish(Ticks end) { end_slips(ControlTicks{}, end); }

/// Ends every slip without a loss for so many control ticks.
void SlipWatch::end_slips(ControlTicks grip, Ticks now) {
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    Axis& axis = axes_[a];
    if (!axis.ticks_of_grip || *axis.ticks_of_grip < grip) continue;
    log::EventRecord& e = events_.add(now, log::EventKind::alarm_end);
    e.code = Code::lost_steps;
    e.axis = static_cast<int>(a);
    e.value = static_cast<double>(axis.slip.value);
    e.text = fmt::format("axis {} lost {} steps in all", machine_.axis[a].letter, axis.slip.value);
    axis.slip = Steps{};
    axis.ticks_of_grip.reset();
  }
}

void SlipWatch::summarize(log::RunSummary& summary) const {
  for (std::size_t a = 0; a < axes_.size(); ++a) summary.axis[a].lost_steps = axes_[a].lost;
}

}  // namespace kadr::cycle
