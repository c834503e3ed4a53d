#pragma once
#include <cstddef>
#include <vector>

#include "emulator/cycle/event_list.h"
#include "emulator/cycle/operator/spindle_reactor.h"
#include "emulator/emulator.h"
#include "planner/laws/motion_source.h"

namespace kadr::cycle {

/// Requests of the operator's panel and the spindle for each control tick: steps of a timeline, and live ones.
class OperatorPanel {
 public:
  /// @param steps     of the timeline, by tick those that have one; outlives this, as do machine and events
  /// @param places_u  [steps] of those at path positions (place_on_path)
  OperatorPanel(const std::vector<OperatorStep>& steps, std::vector<double> places_u,
                const machine::MachineModel& machine, EventList& events);
  /// A live step: it takes effect with the next control tick, after the timeline's steps for that tick.
  /// Its own tick and position do not count.
  void operate(const OperatorStep& step) { live_.push_back(step); }
  /// The input of the control tick that begins at `tick` and path length `s_u`. Every step that comes into
  /// force becomes an event.
  const planner::OperatorInput& advance(ControlTicks tick, double s_u);
  double spindle_override() const {
    return spindle_override_;
  }  ///< the spindle's part of the feed override, ratio
  /// The timeline will change nothing any more while the path rests.
  bool at_its_end() const;

 private:
  void take(const OperatorStep& step, Ticks tick);
  void tell(Ticks tick, log::EventKind kind, double value, std::string text);

  const std::vector<OperatorStep>& steps_;
  std::vector<double> places_u_;
  const machine::MachineModel& machine_;
  EventList& events_;
  SpindleReactor reactor_;
  planner::OperatorInput input_{};
  std::size_t next_ = 0, timed_ = 0;  // next of the steps with a tick, and how many they are
  std::vector<std::size_t> placed_;   // steps at path positions, in the order in which the path reaches them
  std::size_t next_placed_ = 0;
  std::vector<OperatorStep> live_;  // for the next control tick
  double operator_override_ = 1, spindle_override_ = 1, load_ = 0;
};

/// Highest feed override that a timeline requests, ratio, at least 1.
double most_override(const std::vector<OperatorStep>& steps);

}  // namespace kadr::cycle
