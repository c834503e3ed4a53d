#pragma once
#include <cstddef>
#include <vector>

#include "emulator/cycle/event_list.h"
#include "emulator/cycle/monitor/tick_view.h"

namespace kadr::machine {
struct MachineModel;
}

namespace kadr::cycle {

/// Residual vibration after each stop, of the axes that moved before it and have a link: the larger of the
/// envelope of the free link at the stop,
///   X = sqrt(x1^2 + ((v1 + zeta w x1)/wd)^2)      (paper 001, eq. 20 as corrected)
/// and of |x1| until the next motion. It is reported when the next motion begins, with the block that ended
/// in the stop.
class StopResidual {
 public:
  /// @param machine, events  outlive this
  StopResidual(const machine::MachineModel& machine, EventList& events);
  void tick(const TickView& view);
  /// Reports the last stop.
  void finish(Ticks end);
  /// @param summary  with its axes [axes]
  void summarize(log::RunSummary& summary) const;

 private:
  struct Axis {
    double omega_rad_s = 0, damped_rad_s = 0, zeta = 0;  // of the link, 0 without one
    bool moved = false;                                  // since the last stop that was reported
    double residual_u = 0;                               // of the stop under way
    double worst_u = 0;                                  // of all that were reported
  };
  double envelope_u(const Axis& axis, const AxisState& state) const;
  void report(Ticks now);

  const machine::MachineModel& machine_;
  EventList& events_;
  std::vector<Axis> axes_;
  bool moving_ = false, stopped_ = false;
  std::size_t stop_segment_ = 0;
};

}  // namespace kadr::cycle
