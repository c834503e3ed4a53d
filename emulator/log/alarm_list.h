#pragma once
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "emulator/log/forwarding_log.h"

namespace kadr::log {

/// Keeps the alarms for the summary.
class AlarmList final : public ForwardingLog {
 public:
  /// Alarms kept with their text; all are counted.
  static constexpr std::size_t kKept = 1000;

  using ForwardingLog::ForwardingLog;
  const std::vector<EventRecord>& alarms() const { return alarms_; }
  /// How often each code came, ascending.
  const std::map<Code, std::size_t>& counts() const { return counts_; }

  Written event(const EventRecord& record) override;

 private:
  std::vector<EventRecord> alarms_;
  std::map<Code, std::size_t> counts_;
};

}  // namespace kadr::log
