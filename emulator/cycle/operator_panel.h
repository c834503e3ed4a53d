#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "emulator/emulator.h"
#include "planner/laws/motion_source.h"

namespace kadr::emulator {

/// Finds the places of steps that stand on the path.
/// Steps at lines or blocks that do not move are told.
void place_on_path(Job& job, Diagnostics& diagnostics);

/// The percent that a spindle's load asks for, control tick by control tick (machine::SpindleReaction).
class SpindleReactor {
 public:
  SpindleReactor(const machine::SpindleReaction& rule, double tau_s);
  /// One control tick under a load (ratio). @return the percent in force in it, as a ratio
  double advance(double load);
  /// The percent can still change under this load.
  bool unsettled(double load) const;

 private:
  std::int64_t high_ticks_, down_ticks_, low_ticks_, up_ticks_;
  double high_load_, low_load_, down_pct_, up_pct_, least_pct_;
  std::int64_t high_ = 0, low_ = 0;
  double percent_ = 100;
};

/// What the operator's panel and the spindle ask for, step by step of the timeline.
class OperatorPanel {
 public:
  OperatorPanel(const std::vector<OperatorStep>& steps, const machine::MachineModel& machine);
  /// The input of the control tick that begins at `tick` and path length `s_u`. Steps that come into force
  /// are appended to `events` (tick, kind, value, text).
  const planner::OperatorInput& advance(ControlTicks tick, double s_u, std::vector<EventRecord>& events);
  /// The spindle's part of the percent, ratio.
  double spindle_percent() const { return spindle_percent_; }
  /// Nothing will change any more while the path rests.
  bool at_its_end() const;

 private:
  void take(const OperatorStep& step, Ticks tick, std::vector<EventRecord>& events);

  const std::vector<OperatorStep>& steps_;
  const machine::MachineModel& machine_;
  SpindleReactor reactor_;
  planner::OperatorInput input_{};
  std::size_t next_ = 0, timed_ = 0;  ///< next of the steps with a tick, and how many they are
  std::vector<std::size_t> placed_;   ///< steps that stand on the path and have not come
  double operator_percent_ = 1, spindle_percent_ = 1, load_ = 0;
};

/// Highest ratio that the timeline asks for, at least 1.
double most_percent(const std::vector<OperatorStep>& steps);

}  // namespace kadr::emulator
