#include "emulator/cycle/record_writer.h"

#include <fmt/format.h>

namespace kadr::cycle {

std::optional<RunFailure> RecordWriter::happenings(const std::vector<log::BlockRecord>& blocks,
                                                   const std::vector<log::EventRecord>& events,
                                                   const std::vector<log::BlockEndRecord>& block_ends) const {
  if (!log_) return std::nullopt;
  auto event = events.begin();
  for (const log::BlockRecord& block : blocks) {
    for (; event != events.end() && event->tick < block.tick; ++event)
      if (auto failure = failure_of(log_->event(*event))) return failure;
    if (auto failure = failure_of(log_->block(block))) return failure;
  }
  for (; event != events.end(); ++event)
    if (auto failure = failure_of(log_->event(*event))) return failure;
  for (const log::BlockEndRecord& end : block_ends)
    if (auto failure = failure_of(log_->block_end(end))) return failure;
  return std::nullopt;
}

std::optional<RunFailure> RecordWriter::tick(const log::TickRecord& record, const StepBatch& batch) const {
  return log_ ? failure_of(log_->tick(record, batch)) : std::nullopt;
}

std::optional<RunFailure> RecordWriter::end(const log::RunSummary& summary) const {
  return log_ ? failure_of(log_->end(summary)) : std::nullopt;
}

std::optional<RunFailure> RecordWriter::failure_of(const tl::expected<void, log::LogError>& written) const {
  if (written) return std::nullopt;
  const log::LogError& e = written.error();
  const double valid_s = static_cast<double>(e.valid_until.value) / static_cast<double>(clock_.base_hz);
  return RunFailure{fmt::format("{}: {}; the log is valid up to tick {} ({:.6f} s)", e.path, e.reason,
                                e.valid_until.value, valid_s)};
}

}  // namespace kadr::cycle
