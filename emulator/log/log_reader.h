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

#include "emulator/log/log_messages.h"
#include "emulator/log/log_types.h"

/// Reads kadr logs (docs/log_format.md), whole, cut off or damaged: every message up to the first byte that
/// is not a log's. Nothing in a file can make it crash, hang or allocate more than a small multiple of the file's size.
namespace kadr::log {

/// Why a file can't be read as a kadr log at all.
enum class LogReadFault : std::uint8_t {
  cannot_open,
  not_a_log,      ///< no LCM event log: empty, or other bytes
  other_log,      ///< an LCM log, not of kadr
  other_format,   ///< a kadr log of another format version
  cut_in_header,  ///< a kadr log that was cut or damaged in its first message
  altered,        ///< a whole log whose summary denies its numbers
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
  damaged,      ///< bytes that are no log, or messages that contradict each other
  altered,      ///< whole, but its numbers are not those that were written: its hashes deny them
};
struct LogEnd {
  LogState state = LogState::cut_off;
  Ticks valid_until;             ///< exact data and events are complete up to here
  std::int64_t valid_bytes = 0;  ///< length of the whole events read
  std::int64_t file_bytes = 0;
  std::string detail;  ///< a sentence, empty if complete
  /// Sentences on channels and fields of a newer kadr that this one does not know; each once, at most
  /// kMostNotes of them.
  std::vector<std::string> passed_over;
};
inline constexpr std::size_t kMostNotes = 8;

/// One event of an LCM log as stored in the file.
struct LogEventView {
  std::string_view channel;
  std::int64_t number = 0;
  std::int64_t time_us = 0;
  std::span<const std::uint8_t> data;
  std::int64_t bytes() const {
    return static_cast<std::int64_t>(kEventHeaderBytes + channel.size() + data.size());
  }
};

/// Whether a log is whole to its end and nothing denies what is in it.
constexpr bool is_sound(LogState state) {
  return state == LogState::complete || state == LogState::interrupted;
}

/// Reads one log from its beginning, and proves it as a sequence while it does (log_proof.h).
class LogReader {
 public:
  /// Reads the whole file once for its hashes, before anything of it is given.
  /// @return altered: the summary denies what was read
  static tl::expected<LogReader, LogReadError> open(const std::string& path);
  /// Does without that: a log that its summary denies is read as far as it can be, and end() says so.
  static tl::expected<LogReader, LogReadError> inspect(const std::string& path);
  LogReader(LogReader&&) noexcept;
  LogReader& operator=(LogReader&&) noexcept;
  ~LogReader();

  const LogHeader& header() const;
  /// The next message, the header first; nothing at the end of the valid part. The storage of `message` is replaced.
  bool next(LogMessage& message);
  /// The event that the last message came from; valid until the next call of next().
  const LogEventView& event() const;
  /// How the log ends; only after next() said no.
  const LogEnd& end() const;
  /// Hash of the messages before KADR_SUMMARY as read; equals LogSummary::content_hash if no bit was changed.
  std::uint64_t content_hash() const;
  /// Hash of the whole file that was opened, every byte of it.
  std::uint64_t file_hash() const;
  /// Of a reader by open(): why the file's events break off anywhere, a sentence; empty if they go on to a summary and end
  /// there. It is known before they are read, for whoever reads a part of them.
  const std::string& remainder() const;
  /// Hash of all messages as read, of a log that holds one.
  std::optional<std::uint64_t> log_hash() const;
  /// Hash of the pulses as read.
  std::uint64_t steps_hash() const;

 private:
  struct Impl;
  explicit LogReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kadr::log
