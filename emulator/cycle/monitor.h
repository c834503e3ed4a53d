#pragma once
#include <vector>

#include "emulator/log/records.h"
#include "planner/laws/motion_source.h"
#include "plant/plant.h"

namespace kadr::planner {
class Path;
}

namespace kadr::machine {
struct MachineModel;
}

namespace kadr::emulator {

/// What one control tick looked like, for the monitor.
struct TickView {
  const planner::TickMotion* motion = nullptr;
  const StepBatch* batch = nullptr;
  const std::vector<plant::AxisState>* plant = nullptr;  ///< null without plant
  const plant::Plant* energy = nullptr;                  ///< the plant if it keeps energies
  std::size_t segment = 0;                               ///< at the tick's end
};

/// Watches the commanded motion for overruns and the plant for vibration, control tick by control tick.
///
/// Commanded axis speed is dx/ds * ds/dt at the tick's end, acceleration and jerk its first and second
/// differences over tau; at a tick that holds a joint between segments the junction step of the machine is
/// allowed besides. An overrun is one alarm when it begins and one "alarm end" with the worst value when it
/// is over. Residual vibration after a stop is the larger of the envelope of the free link at the stop,
///   X = sqrt(x1^2 + ((v1 + zeta w x1)/wd)^2)      (paper 001, eq. 20 as corrected)
/// and of |x1| until the next motion; it is told when that begins, with the block that ended in the stop.
class Monitor {
 public:
  Monitor(const planner::Path& path, const machine::MachineModel& machine);
  /// Looks at the tick; alarms and residuals are appended to `events`.
  void tick(const TickView& view, std::vector<EventRecord>& events, std::vector<BlockEndRecord>& block_ends);
  /// Lost steps are found by the plant; they become alarms here. A motor that keeps slipping is one alarm: it
  /// ends after 0.1 s without a loss, with the steps lost in all.
  void lost_steps(const std::vector<plant::LostSteps>& lost, Ticks tick, std::vector<EventRecord>& events);
  /// Ends what is open (overruns, residual of the last stop, last block).
  void finish(Ticks end, std::vector<EventRecord>& events, std::vector<BlockEndRecord>& block_ends);
  /// Fills the axis part, path error, peak feeds and alarm count.
  void summarize(RunSummary& summary) const;
  std::size_t alarms() const { return alarms_; }

 private:
  enum Overrun : std::uint8_t { soft_limit, speed, acceleration, jerk, kOverruns };
  static const Code kOverrunCodes[kOverruns];
  struct Excursion {
    bool open = false;
    double worst = 0;
    double limit = 0;
  };
  struct Axis {
    AxisSummary summary;
    Excursion excursion[kOverruns];
    double position_u = 0, speed_u_s = 0, accel_u_s2 = 0;
    double omega_rad_s = 0, damped_rad_s = 0, zeta = 0;  // of the link, 0 without one
    double vibration_squares_u2 = 0, following_squares_u2 = 0;
    double stop_residual_u = 0;
    Steps slip_steps;                  // lost in the slip under way
    std::int64_t slip_ticks_ago = -1;  // control ticks since its last loss; -1: no slip
    double block_link_u = 0, block_following_u = 0;
    double block_positive_J = 0, block_recuperated_J = 0;  // of the run, where the block began
    bool moved_since_stop = false;
  };

  void watch_axis(std::size_t a, const TickView& view, std::vector<EventRecord>& events);
  void watch_limit(std::size_t a, Overrun kind, double value, double limit, Ticks tick,
                   std::vector<EventRecord>& events);
  void watch_plant(std::size_t a, const TickView& view);
  void watch_path_error(const TickView& view);
  void watch_stop(const TickView& view, std::vector<EventRecord>& events);
  void end_slips(std::int64_t after_ticks, Ticks now, std::vector<EventRecord>& events);
  void end_stop(Ticks now, std::vector<EventRecord>& events);
  void end_block(Ticks tick, std::vector<BlockEndRecord>& block_ends);
  EventRecord event_here(Ticks tick, EventKind kind, std::size_t axis, double value, double limit) const;

  const planner::Path& path_;
  const machine::MachineModel& machine_;
  double tau_s_;
  std::vector<Axis> axes_;
  std::vector<double> tangent_;
  std::size_t segment_ = 0;
  std::uint32_t block_ = 0;
  bool block_open_ = false;
  bool energy_ = false;
  std::int64_t ticks_ = 0;
  std::size_t speed_segment_ = 0;
  int joint_ticks_ago_ = 1000;  // control ticks since a joint was passed
  bool moving_ = false, stopped_ = false;
  std::size_t stop_segment_ = 0;
  double path_error_u_ = 0, peak_feed_u_s_ = 0, held_error_u_ = 0;
  std::size_t alarms_ = 0;
};

}  // namespace kadr::emulator
