#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/log/log_reader.h"
#include "emulator/log_tools/diff/exact_ticks.h"

namespace kadr::log_tools {

/// Records between the ticks of a log, compared in order.
using LogItem = std::variant<log::BlockRecord, log::EventRecord, log::LogDiagnostic>;

/// Everything that a log says of one control tick. Copies are cheap: the exact data are shared.
struct LogFrame {
  std::int64_t control_tick = 0;
  std::shared_ptr<const ExactTicks> ticks;        ///< null: KADR_TICKS does not hold this tick
  std::size_t tick_index = 0;                     ///< in `ticks`
  std::shared_ptr<const log::StepBlock> steps;    ///< null: KADR_STEPS does not hold this tick
  std::size_t step_index = 0;                     ///< in `steps`
  std::vector<LogItem> items;                     ///< in the log's order
  std::shared_ptr<const log::BlockRecord> block;  ///< the motion block begun last; null before the first

  const StepBatch* batch() const { return steps ? &steps->batches[step_index] : nullptr; }
};

/// A log as a sequence of control ticks, ascending; memory is that of one log block, whatever the log's length.
/// An event belongs to the control tick that its stamp falls in. Of a log that was cut off only ticks whose
/// exact data are complete are given.
class LogFrames {
 public:
  static tl::expected<LogFrames, log::LogReadError> open(const std::string& path);

  const log::LogHeader& header() const { return reader_.header(); }
  /// The next control tick; nothing at the end of the valid part.
  bool next(LogFrame& frame);
  /// How the log ends, and its summary; only after next() said no.
  const log::LogEnd& end() const { return reader_.end(); }
  const std::string& remainder() const { return reader_.remainder(); }
  const std::optional<log::LogSummary>& summary() const { return summary_; }

 private:
  explicit LogFrames(log::LogReader reader) : reader_(std::move(reader)) {}
  bool read();
  void take_ticks(log::TickBlock ticks);
  void flush_block();
  void flush_items(std::int64_t before_tick);
  void add_frame(LogFrame frame);
  std::int64_t control_tick_of(const LogItem& item) const;

  log::LogReader reader_;
  std::shared_ptr<const ExactTicks> ticks_;  // read, its frames not given yet
  std::shared_ptr<const log::StepBlock> steps_;
  TickMessages waiting_;  // other exact data: KADR_TICKS of the same control ticks follows
  std::deque<LogItem> items_;
  std::deque<LogFrame> ready_;
  std::shared_ptr<const log::BlockRecord> block_;
  std::optional<log::LogSummary> summary_;
  bool ended_ = false;
};

/// Base tick of an item, 0 to 2^62; 0 for a diagnostic from before the run.
Ticks tick_of(const LogItem& item);
/// A stamp of a log of unknown origin, brought into 0 to 2^62.
Ticks sane_tick(Ticks tick);

}  // namespace kadr::log_tools
