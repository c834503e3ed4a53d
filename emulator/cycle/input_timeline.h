#pragma once
#include <cstddef>
#include <vector>

#include "emulator/cycle/event_list.h"
#include "emulator/emulator.h"

namespace kadr::cycle {

/// Follows one input from a time on. An input reads 0 until its first step; a step holds from the beginning
/// of its control tick. Rise and fall are steps after `begin_s`; high and low may hold already.
/// @param steps  ascending by tick
WaitOutcome wait_for(const gcode::InputWait& wait, double begin_s, const std::vector<InputStep>& steps,
                     double tau_s);

/// Makes an event of each step of the timeline that sets an input, at the beginning of its control tick.
class InputEvents {
 public:
  /// @param steps  ascending by tick; outlives this, as do clock and events
  InputEvents(const std::vector<InputStep>& steps, const machine::ClockModel& clock, EventList& events)
      : steps_(steps), clock_(clock), events_(events) {}
  void tick(ControlTicks tick);

 private:
  const std::vector<InputStep>& steps_;
  const machine::ClockModel& clock_;
  EventList& events_;
  std::size_t next_ = 0;
};

}  // namespace kadr::cycle
