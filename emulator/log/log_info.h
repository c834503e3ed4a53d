#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/log/log_reader.h"

/// What `kadr info LOG` reports, found by reading the whole file; nothing in it is taken on trust.
namespace kadr::log {

struct ChannelInfo {
  std::string name;
  std::int64_t messages = 0;
  std::int64_t bytes = 0;  ///< with event headers
};

struct LogInfo {
  std::string path;
  LogEnd end;  ///< complete, interrupted, cut off, damaged
  LogHeader header;
  std::vector<ChannelInfo> channels;           ///< in the order of their first message
  std::uint64_t file_hash = 0;                 ///< XXH3 of the file's bytes
  std::int64_t first_tick = 0, last_tick = 0;  ///< span of the valid part
  double span_s = 0;
  std::int64_t control_ticks = 0;    ///< in KADR_TICKS, or KADR_STEPS if those are off
  std::vector<std::int64_t> pulses;  ///< [axes] counted in KADR_STEPS
  std::int64_t events = 0, alarms = 0, diagnostics = 0, blocks = 0;
  std::optional<std::uint64_t> steps_hash;  ///< recomputed from KADR_STEPS; none if they are not in the log
  std::uint64_t content_hash = 0;           ///< recomputed from the messages
  std::optional<std::uint64_t> log_hash;    ///< recomputed from all of them; none: the log holds no such hash
  std::optional<LogSummary> summary;

  /// The recomputed hash equals the summary's; nothing to compare: none.
  std::optional<bool> steps_hash_agrees() const;
  std::optional<bool> content_hash_agrees() const;
  std::optional<bool> log_hash_agrees() const;
};

tl::expected<LogInfo, LogReadError> log_info(const std::string& path);

/// "complete", "interrupted", "cut off", "damaged", "altered"
std::string log_state_name(LogState state);

/// Table for people, lines end in '\n'.
std::string render_log_info(const LogInfo& info);

}  // namespace kadr::log
