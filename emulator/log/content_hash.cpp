#include "emulator/log/content_hash.h"

#include <fmt/format.h>

#include <array>

#include "emulator/log/channels/summary.h"

namespace kadr::log {

void ContentHash::add_head(std::int64_t time_us, std::string_view channel, std::size_t data_bytes) {
  hash_.integer(time_us);
  hash_.integer(static_cast<std::int64_t>(channel.size()));
  hash_.bytes(channel.data(), channel.size());
  hash_.integer(static_cast<std::int64_t>(data_bytes));
}

void ContentHash::add(std::int64_t time_us, std::string_view channel, std::span<const std::uint8_t> data) {
  add_head(time_us, channel, data.size());
  hash_.bytes(data.data(), data.size());
}

void ContentHash::add_summary(std::int64_t time_us, std::string_view channel,
                              std::span<const std::uint8_t> data, std::size_t log_hash_at) {
  static constexpr std::array<std::uint8_t, 8> kZeros{};
  add_head(time_us, channel, data.size());
  hash_.bytes(data.data(), log_hash_at);
  hash_.bytes(kZeros.data(), kZeros.size());
  const auto rest = data.subspan(log_hash_at + kZeros.size());
  hash_.bytes(rest.data(), rest.size());
}

HashesRead hashes_at_summary(ContentHash& before, std::int64_t time_us, std::string_view channel,
                             std::span<const std::uint8_t> data, const LogSummary& summary) {
  HashesRead read{before.digest(), std::nullopt};
  if (summary.log_hash_at == 0) return read;
  before.add_summary(time_us, channel, data, summary.log_hash_at);
  read.log = before.digest();
  return read;
}

std::string denial(const HashesRead& read, const LogSummary& summary) {
  const auto sentence = [](std::string_view of, std::uint64_t is, std::uint64_t says) {
    return fmt::format(
        "its numbers are not those that were written: {} has the hash {}, KADR_SUMMARY says {}", of,
        hash_text(is), hash_text(says));
  };
  if (read.content != summary.content_hash)
    return sentence("its content", read.content, summary.content_hash);
  if (read.log && *read.log != summary.log_hash) return sentence("the log", *read.log, summary.log_hash);
  return {};
}

}  // namespace kadr::log
