#pragma once
#include <optional>
#include <vector>

#include "emulator/emulator.h"

namespace kadr::cycle {

/// Writes the records of a run in tick order. Each call answers with the log's failure, or nothing.
class RecordWriter {
 public:
  /// @param log  null: nothing is written; outlives this
  RecordWriter(log::RunLog* log, const machine::ClockModel& clock) : log_(log), clock_(clock) {}
  bool writes() const { return log_ != nullptr; }
  /// What happened in a control tick: blocks that began and events, in tick order (a block before the events
  /// at its tick), then the blocks that ended. Blocks and events are each ascending by tick.
  std::optional<RunFailure> happenings(const std::vector<log::BlockRecord>& blocks,
                                       const std::vector<log::EventRecord>& events,
                                       const std::vector<log::BlockEndRecord>& block_ends) const;
  std::optional<RunFailure> tick(const log::TickRecord& record, const StepBatch& batch) const;
  std::optional<RunFailure> end(const log::RunSummary& summary) const;

 private:
  std::optional<RunFailure> failure_of(const tl::expected<void, log::LogError>& written) const;

  log::RunLog* log_;
  const machine::ClockModel& clock_;
};

}  // namespace kadr::cycle
