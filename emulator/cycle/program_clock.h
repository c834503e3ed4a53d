#pragma once
#include <cstddef>
#include <optional>

#include "emulator/cycle/event_list.h"
#include "emulator/emulator.h"
#include "machine/tick_motion.h"

namespace kadr::cycle {

/// Makes the program's events as the path reaches their joints, one after the other: a dwell, a wait or a
/// tool change delays those after it.
class ProgramClock {
 public:
  /// @param program_events  ascending in after_segment; outlives this, as do path, machine and list
  ProgramClock(const std::vector<ProgramEvent>& program_events, const planner::Path& path,
               const machine::MachineModel& machine, EventList& list);
  /// Adds the events of this control tick, in tick order.
  void tick(const TickMotion& motion);
  /// Every event has been made, and the last one no longer holds the machine.
  /// @param now  end of the last control tick
  bool finished(Ticks now) const { return next_ == program_events_.size() && held_until_ <= now; }

 private:
  void add(const ProgramEvent& event);

  const std::vector<ProgramEvent>& program_events_;
  const planner::Path& path_;
  const machine::MachineModel& machine_;
  EventList& list_;
  std::size_t next_ = 0;
  std::optional<std::size_t> joint_;  // reached last, by the segment after it
  Ticks held_until_;                  // the events made so far hold the machine until then
};

}  // namespace kadr::cycle
