#pragma once
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "emulator/log/run_log.h"

namespace kadr::emulator {

/// Stands between the cycle and a log (which may be missing) and keeps the alarms for the summary.
class AlarmList final : public RunLog {
 public:
  /// Alarms kept with their text; all are counted.
  static constexpr std::size_t kKept = 1000;

  explicit AlarmList(RunLog* next) : next_(next) {}
  const std::vector<EventRecord>& alarms() const { return alarms_; }
  /// How often each code came, ascending.
  const std::map<Code, std::size_t>& counts() const { return counts_; }

  tl::expected<void, LogError> begin(const RunHeader& header) override;
  tl::expected<void, LogError> block(const BlockRecord& record) override;
  tl::expected<void, LogError> tick(const TickRecord& record, const StepBatch& batch) override;
  tl::expected<void, LogError> block_end(const BlockEndRecord& record) override;
  tl::expected<void, LogError> event(const EventRecord& record) override;
  tl::expected<void, LogError> diagnostic(const Diagnostic& d, Ticks tick) override;
  tl::expected<void, LogError> end(const RunSummary& summary) override;

 private:
  RunLog* next_;
  std::vector<EventRecord> alarms_;
  std::map<Code, std::size_t> counts_;
};

}  // namespace kadr::emulator
