#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "machine/base/hash.h"

namespace kadr::log {

struct LogSummary;

/// The two hashes of a log (docs/log_format.md, section 5), over its events in order.
class ContentHash {
 public:
  void add(std::int64_t time_us, std::string_view channel, std::span<const std::uint8_t> data);
  /// Of the events added.
  std::uint64_t digest() const { return hash_.digest(); }
  /// Adds KADR_SUMMARY, the eight bytes of `log_hash` as zeros; no event follows it.
  /// @param log_hash_at  where they are in `data`
  void add_summary(std::int64_t time_us, std::string_view channel, std::span<const std::uint8_t> data,
                   std::size_t log_hash_at);

 private:
  void add_head(std::int64_t time_us, std::string_view channel, std::size_t data_bytes);

  Hash64 hash_;
};

/// Hashes of the events that were read, beside those that the summary holds.
struct HashesRead {
  std::uint64_t content = 0;         ///< of the events before KADR_SUMMARY
  std::optional<std::uint64_t> log;  ///< of all of them; none: the log is of a kadr that had no such hash
};

/// Both hashes at a log's summary.
/// @param before  of the events before it
HashesRead hashes_at_summary(ContentHash& before, std::int64_t time_us, std::string_view channel,
                             std::span<const std::uint8_t> data, const LogSummary& summary);

/// Says that the summary holds another hash than the one of the events; empty: it agrees.
std::string denial(const HashesRead& read, const LogSummary& summary);

}  // namespace kadr::log
