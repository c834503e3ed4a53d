#pragma once
#include <optional>
#include <vector>

#include "emulator/cycle/event_list.h"
#include "plant/plant.h"

namespace kadr::machine {
struct MachineModel;
}

namespace kadr::cycle {

/// Turns the lost steps that the plant finds into alarms. A motor that keeps slipping is one alarm: it ends
/// after 0.1 s without a loss, with the steps lost in all.
class SlipWatch {
 public:
  /// @param machine, events  outlive this
  SlipWatch(const machine::MachineModel& machine, EventList& events);
  /// One control tick.
  /// @param lost  found in it
  /// @param end   of the tick
  void tick(const std::vector<plant::LostSteps>& lost, Ticks end);
  /// Ends the slips that are still open.
  void finish(Ticks end);
  /// @param summary  with its axes [axes]
  void summarize(log::RunSummary& summary) const;
  std::size_t alarms() const { return alarms_; }

 private:
  struct Axis {
    Steps lost;                                 // in all
    Steps slip;                                 // in the slip under way
    std::optional<ControlTicks> ticks_of_grip;  // since its last loss; empty: no slip is under way
  };
  void end_slips(ControlTicks grip, Ticks now);

  const machine::MachineModel& machine_;
  EventList& events_;
  std::vector<Axis> axes_;
  ControlTicks grip_;  // that ends a slip
  std::size_t alarms_ = 0;
};

}  // namespace kadr::cycle
