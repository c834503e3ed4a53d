#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/log/log_types.h"
#include "emulator/log/records.h"

/// Reads kadr logs (docs/log_format.md), whole, cut off or damaged: every message up to the first byte that
/// is not a log's. Nothing in a file can make it crash, hang or allocate more than a small multiple of the
/// file's size.
namespace kadr::emulator {

struct LogAxis {
  std::string name;  ///< "X"
  std::string unit;  ///< "mm" or "deg"
  double step_u = 0;
  double home_u = 0;
  bool has_plant = false;
};

/// KADR_RUN
struct LogHeader {
  std::int32_t log_format = 0;
  std::string kadr_version;
  std::int64_t base_hz = 0;
  std::int64_t control_tick_ticks = 0;  ///< tau
  std::string program_name;
  std::string program_text;  ///< empty if the program was longer than 1 MiB
  std::int64_t program_bytes = 0;
  std::uint64_t program_hash = 0;
  std::string machine_toml, scenario_toml, settings_toml;
  std::uint64_t inputs_hash = 0;
  std::string machine_name;
  bool logs_ticks = false, logs_steps = false;
  std::int32_t block_ticks = 0;
  std::int32_t viewer_every_ticks = 0;
  std::vector<LogAxis> axis;
  double seconds(Ticks t) const { return static_cast<double>(t.value) / static_cast<double>(base_hz); }
};

/// One axis of a TickBlock; the plant's columns are empty in a run without plant.
struct AxisTicks {
  std::vector<std::int64_t> steps;  ///< [ticks] lattice node at the tick's end, from machine zero
  std::vector<double> command_u;    ///< [ticks] before the lattice
  std::vector<double> base_u, base_u_s, link_u, link_u_s, motor_force_N;  ///< [ticks] x0, v0, x1, v1, force
};

/// KADR_TICKS; element i is the end of control tick first + i.
struct TickBlock {
  Ticks begin;
  ControlTicks first;
  std::vector<double> feed_u_s, accel_u_s2, path_u;                ///< [ticks]
  std::vector<double> override_requested, override_used, limiter;  ///< [ticks] ratios
  std::vector<std::int8_t> override_note;                          ///< [ticks] OverrideNote
  std::vector<std::int8_t> limited_by, limiting_axis;              ///< [ticks] LimitedBy; axis or -1
  std::vector<std::uint32_t> block;                                ///< [ticks]
  std::vector<AxisTicks> axis;                                     ///< [axes]
  bool has_plant = false;
  std::size_t size() const { return feed_u_s.size(); }
};

/// KADR_STEPS; batches[i] holds the pulses of control tick first + i (their AxisCommand is not in the log:
/// see TickBlock).
struct StepBlock {
  Ticks begin;
  ControlTicks first;
  std::vector<StepBatch> batches;
};

/// KADR_FEED
struct FeedSample {
  Ticks tick;
  double t_s = 0;
  std::uint32_t block = 0;
  double path_u = 0, commanded_u_s = 0, acceleration_u_s2 = 0, jerk_u_s3 = 0, override_used_pct = 0;
  std::int8_t phase = 0;  ///< 0 at rest, 1 accelerate, 2 cruise, 3 brake
  std::int8_t limited_by = 0;
};

/// KADR_AXIS_*
struct AxisSample {
  int axis = -1;
  Ticks tick;
  double t_s = 0;
  std::int64_t steps = 0;
  double ideal = 0, commanded = 0, motor = 0, load = 0, load_rate = 0, load_minus_ideal_um = 0,
         motor_force_N = 0;
};

/// KADR_DIAG
struct LogDiagnostic {
  Ticks tick;  ///< -1 if before the run
  Severity severity = Severity::error;
  std::string code;  ///< "K2107"
  Span span;
  std::string message, label;
  std::vector<std::string> notes;
  std::string help;
};

/// KADR_SUMMARY
struct LogSummary {
  RunSummary run;
  std::uint64_t content_hash = 0;
};

/// A channel that this version does not know; its bytes are in LogReader::event().
struct UnknownMessage {};

using LogMessage = std::variant<LogHeader, BlockRecord, BlockEndRecord, TickBlock, StepBlock, FeedSample,
                                AxisSample, EventRecord, LogDiagnostic, LogSummary, UnknownMessage>;

/// Why a file can't be read as a kadr log at all.
enum class LogReadFault : std::uint8_t {
  cannot_open,
  not_a_log,      ///< no LCM event log: empty, or other bytes
  other_log,      ///< an LCM log, not of kadr
  other_format,   ///< a kadr log of another format version
  cut_in_header,  ///< a kadr log that was cut or damaged in its first message
};
struct LogReadError {
  LogReadFault fault;
  std::string path;
  std::string reason;  ///< a sentence
};

/// How a log ends.
enum class LogState : std::uint8_t {
  complete,
  interrupted,  ///< closed after a signal: valid to its end, but the program's end is missing
  cut_off,      ///< no KADR_SUMMARY: killed, or the disk was full
  damaged,      ///< bytes that are no log
};
struct LogEnd {
  LogState state = LogState::cut_off;
  Ticks valid_until;             ///< exact data and events are complete up to here
  std::int64_t valid_bytes = 0;  ///< length of the whole events read
  std::int64_t file_bytes = 0;
  std::string detail;  ///< a sentence, empty if complete
};

/// One event of an LCM log as it stands in the file.
struct LogEventView {
  std::string_view channel;
  std::int64_t number = 0;
  std::int64_t time_us = 0;
  std::span<const std::uint8_t> data;
  std::int64_t bytes() const {
    return static_cast<std::int64_t>(kEventHeaderBytes + channel.size() + data.size());
  }
};

/// Reads one log from its beginning.
class LogReader {
 public:
  static tl::expected<LogReader, LogReadError> open(const std::string& path);
  LogReader(LogReader&&) noexcept;
  LogReader& operator=(LogReader&&) noexcept;
  ~LogReader();

  const LogHeader& header() const;
  /// The next message, the header first; nothing at the end of what is valid. The storage of `message` is
  /// replaced.
  bool next(LogMessage& message);
  /// The event that the last message came from; valid until the next call of next().
  const LogEventView& event() const;
  /// How the log ends; only after next() said no.
  const LogEnd& end() const;
  /// Hash of the messages before KADR_SUMMARY as read; equals LogSummary::content_hash if no bit was changed.
  std::uint64_t content_hash() const;

 private:
  struct Impl;
  explicit LogReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kadr::emulator
