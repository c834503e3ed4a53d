#include "emulator/scenario/signals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kadr::scenario {
namespace {

constexpr std::string_view kPathSignals[] = {"feed",         "acceleration",           "jerk",   "path",
                                             "override_pct", "override_requested_pct", "limiter"};
constexpr std::string_view kPathUnits[] = {"mm/s", "mm/s2", "mm/s3", "mm", "%", "%", ""};
constexpr std::size_t kFeed = 0, kAcceleration = 1, kJerk = 2, kPath = 3, kUsed = 4, kRequested = 5,
                      kLimiter = 6;
constexpr std::size_t kFirstAxis = 7;

}  // namespace

std::vector<std::string> signal_names(const machine::MachineModel& machine) {
  std::vector<std::string> names(std::begin(kPathSignals), std::end(kPathSignals));
  for (const machine::AxisModel& axis : machine.axis)
    names.push_back(fmt::format("axis.{}.speed", axis.letter));
  return names;
}

std::string signal_unit(std::string_view signal, const machine::MachineModel& machine) {
  for (std::size_t i = 0; i < std::size(kPathSignals); ++i)
    if (kPathSignals[i] == signal) return std::string(kPathUnits[i]);
  const int axis = signal.size() > 5 ? machine.find_axis(signal[5]) : -1;
  const bool rotary =
      axis >= 0 && machine.axis[static_cast<std::size_t>(axis)].kind == machine::AxisKind::rotary;
  return rotary ? "deg/s" : "mm/s";
}

SignalRecorder::SignalRecorder(const machine::MachineModel& machine, log::RunLog* next)
    : log::ForwardingLog(next), machine_(machine), columns_(kFirstAxis + machine.axis.size()) {}

std::optional<ValueRange> SignalRecorder::range(std::string_view signal, double from_s, double to_s) const {
  const auto names = signal_names(machine_);
  const auto it = std::find(names.begin(), names.end(), signal);
  if (it == names.end()) return {};
  const std::vector<double>& column = columns_[static_cast<std::size_t>(it - names.begin())];
  const double tau_s = machine_.clock.tau_s();
  // times are decimals: a tick that ends at from_s up to rounding is outside
  const auto first = static_cast<std::size_t>(std::max(0.0, std::floor(from_s / tau_s + 1e-6)));
  const double last = std::floor(to_s / tau_s + 1e-6);
  std::optional<ValueRange> range;
  for (std::size_t k = first; k < column.size() && static_cast<double>(k) < last; ++k) {
    if (!range) range = ValueRange{column[k], column[k]};
    range->least_u = std::min(range->least_u, column[k]);
    range->most_u = std::max(range->most_u, column[k]);
  }
  return range;
}

log::ForwardingLog::Written SignalRecorder::block(const log::BlockRecord& record) {
  boundaries_.push_back(record);
  return log::ForwardingLog::block(record);
}

log::ForwardingLog::Written SignalRecorder::tick(const log::TickRecord& record, const StepBatch& batch) {
  const TickMotion& m = *record.motion;
  const double tau_s = machine_.clock.tau_s();
  const double accel = (m.speed_end_u_s - m.speed_begin_u_s) / tau_s;
  const double before = columns_[kAcceleration].empty() ? 0.0 : columns_[kAcceleration].back();
  columns_[kFeed].push_back(m.speed_end_u_s);
  columns_[kAcceleration].push_back(accel);
  columns_[kJerk].push_back((accel - before) / tau_s);
  columns_[kPath].push_back(m.s_end_u);
  columns_[kUsed].push_back(100 * m.override_used);
  columns_[kRequested].push_back(100 * m.override_requested);
  columns_[kLimiter].push_back(m.limiter);
  for (std::size_t a = 0; a < machine_.axis.size(); ++a)
    columns_[kFirstAxis + a].push_back(
        (batch.axis[a].command.position_end_u - batch.axis[a].command.position_begin_u) / tau_s);
  return log::ForwardingLog::tick(record, batch);
}

}  // namespace kadr::scenario
