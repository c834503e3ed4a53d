#pragma once
#include <cstdint>
#include <vector>

#include "emulator/cycle/monitor/commanded_motion.h"
#include "emulator/log/records.h"

namespace kadr::cycle {

/// Keeps how far the flexible machine strays from the command: vibration of the link, following error, the
/// tool's distance from the path, and the work of the motors. Looks at control ticks' ends.
class PlantStatistics {
 public:
  /// @param machine, commanded (of each tick before tick() is called)  outlive this
  PlantStatistics(const machine::MachineModel& machine, const CommandedMotion& commanded);
  /// @param line  of the program, at the tick's end
  void tick(const TickView& view, std::uint32_t line);
  /// @param summary  with its axes [axes]
  void summarize(log::RunSummary& summary) const;

 private:
  struct Axis {
    double peak_vibration_u = 0, vibration_squares_u2 = 0;
    Ticks peak_vibration_tick;
    std::uint32_t peak_vibration_line = 0;
    double peak_following_u = 0, following_squares_u2 = 0;
    double positive_J = 0, recuperated_J = 0;
  };
  double path_error_u(const TickView& view) const;

  const machine::MachineModel& machine_;
  const CommandedMotion& commanded_;
  std::vector<Axis> axes_;
  double path_error_u_ = 0;
  ControlTicks ticks_;
};

}  // namespace kadr::cycle
