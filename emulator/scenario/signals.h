#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/log/forwarding_log.h"
#include "emulator/scenario/scenario.h"

namespace kadr::scenario {

/// Keeps the signals that scenarios measure: feed, acceleration, jerk, overrides, axis speeds per control tick,
/// and the boundaries between blocks.
class SignalRecorder final : public log::ForwardingLog {
 public:
  /// @param next  also receives the records; both outlive this
  SignalRecorder(const machine::MachineModel& machine, log::RunLog* next);

  /// Least and most of a signal over the control ticks that end in (from_s, to_s]; nothing if there are none.
  std::optional<ValueRange> range(std::string_view signal, double from_s, double to_s) const;
  const std::vector<log::BlockRecord>& boundaries() const { return boundaries_; }

  Written block(const log::BlockRecord& record) override;
  Written tick(const log::TickRecord& record, const StepBatch& batch) override;

 private:
  const machine::MachineModel& machine_;
  std::vector<std::vector<double>> columns_;  ///< [signal][control tick]
  std::vector<log::BlockRecord> boundaries_;
};

/// Names of the signals of a machine: "feed", "acceleration", "jerk", "path", "override_pct",
/// "override_requested_pct", "limiter", "axis.X.speed" ...
std::vector<std::string> signal_names(const machine::MachineModel& machine);
/// "mm/s", "mm/s2", ... ; of an axis its own unit
std::string signal_unit(std::string_view signal, const machine::MachineModel& machine);

}  // namespace kadr::scenario
