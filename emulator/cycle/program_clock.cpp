#include "emulator/cycle/program_clock.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "emulator/cycle/program_event.h"
#include "emulator/cycle/tick_time.h"

namespace kadr::cycle {

ProgramClock::ProgramClock(const std::vector<ProgramEvent>& program_events, const planner::Path& path,
                           const machine::MachineModel& machine, EventList& list)
    : program_events_(program_events), path_(path), machine_(machine), list_(list) {}

void ProgramClock::tick(const TickMotion& motion) {
  const Ticks end = begin_of(motion.tick + ControlTicks{1}, machine_.clock);
  for (; next_ < program_events_.size(); ++next_) {
    const ProgramEvent& event = program_events_[next_];
    const double at_u = path_.size() == 0 ? 0.0 : path_.start_s_u[event.after_segment];
    if (motion.s_end_u < at_u) return;
    if (event.after_segment != joint_) {
      joint_ = event.after_segment;
      held_until_ = std::max(held_until_, base_tick_at(motion, at_u, machine_.clock));
    }
    if (held_until_ > end) return;
    add(event);
  }
}

void ProgramClock::add(const ProgramEvent& event) {
  log::EventRecord e = event_record(event);
  e.tick = held_until_;
  e.block = event.after_segment == 0 ? 0 : path_.segments[event.after_segment - 1].block;
  e.span = event.block.span;
  list_.append(std::move(e));
  const double hold_ticks = hold_time_s(event, machine_) * static_cast<double>(machine_.clock.base_hz);
  held_until_ += Ticks{static_cast<std::int64_t>(std::floor(hold_ticks + 0.5))};
}

}  // namespace kadr::cycle
