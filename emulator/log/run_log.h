#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "emulator/log/records.h"

namespace kadr::log {

/// An I/O error while writing: path, reason, and up to which tick the file is valid.
struct LogError {
  std::string path;
  std::string reason;
  Ticks valid_until;
};

/// Where the cycle's records go. The cycle calls in tick order; one call per control tick.
class RunLog {
 public:
  virtual ~RunLog() = default;
  virtual tl::expected<void, LogError> begin(const RunHeader& header) = 0;
  virtual tl::expected<void, LogError> block(const BlockRecord& record) = 0;
  virtual tl::expected<void, LogError> tick(const TickRecord& record, const StepBatch& batch) = 0;
  virtual tl::expected<void, LogError> block_end(const BlockEndRecord& record) = 0;
  virtual tl::expected<void, LogError> event(const EventRecord& record) = 0;
  virtual tl::expected<void, LogError> diagnostic(const Diagnostic& d, Ticks tick) = 0;
  virtual tl::expected<void, LogError> end(const RunSummary& summary) = 0;
};

/// Size of a log in bytes before it is written, from planned time and pulse count; within 15 % of what is
/// written then.
/// @param plant       the run has a plant (its states are logged)
/// @param text_bytes  program, machine, scenario and settings texts together
/// @param list_bytes  of the list of files read
std::int64_t estimate_log_bytes(const machine::MachineModel& machine, double planned_s, std::int64_t pulses,
                                std::size_t blocks, bool plant = true, std::size_t text_bytes = 0,
                                std::size_t list_bytes = 0);

struct LcmLogOptions {
  std::string path;  ///< event log to write ("" : none), by the rules of OutputFile: as path + ".part", which
                     ///< stays if the run ends early; end() renames it unless the outcome is "interrupted"
  std::string publish_url;  ///< LCM provider to publish to as well ("" : none); "ttl=0" is added to a udpm
                            ///< URL without a ttl; file:// is refused
  std::uint64_t most_bytes = 0;  ///< a longer log is an error, at the first event beyond it; 0: no bound
};

/// LCM event log with simulated time stamps (docs/log_format.md). Encodes and writes on the calling thread;
/// each whole block of log.block_ticks control ticks is handed to the kernel at once, so that a kill loses no
/// more than the block under way. A log of a finished run is handed to the disk before end() returns. After an error every call gives that error again and nothing more is written.
tl::expected<std::unique_ptr<RunLog>, LogError> open_lcm_log(const LcmLogOptions& options);

}  // namespace kadr::log
