#include "log_events.h"

#include "emulator/log/content_hash.h"
#include "emulator/log/log_messages.h"
#include "emulator/log/log_types.h"
#include "emulator/log/wire.h"

namespace kadr::test {
namespace {

std::uint64_t number_at(const std::vector<std::uint8_t>& data, std::size_t at, std::size_t width) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < width; ++i) value = value << 8 | data[at + i];
  return value;
}

log::LogHeader header_of(const LogEvent& first) {
  log::LogHeader header;
  header.base_hz = 10'000'000;
  if (auto read = log::decode<log::LogHeader>(first.data, first.channel, header))
    header = std::move(read->record);
  return header;
}

/// The message with these hashes; one of an older kadr keeps its fields.
void put_hashes(LogEvent& e, const log::LogHeader& header, std::uint64_t content, std::uint64_t log) {
  auto summary = log::decode<log::LogSummary>(e.data, e.channel, header);
  if (!summary || summary->newer) return;
  summary->record.content_hash = content;
  summary->record.log_hash = log;
  std::vector<std::uint8_t> bytes;
  log::encode(summary->record, header, bytes);
  constexpr std::size_t kFingerprint = 8;
  if (bytes.size() < e.data.size()) return;
  std::copy_n(bytes.begin() + kFingerprint, e.data.size() - kFingerprint, e.data.begin() + kFingerprint);
}

}  // namespace

std::vector<LogEvent> events_of(const std::vector<std::uint8_t>& log) {
  std::vector<LogEvent> events;
  for (std::size_t at = 0; at + log::kEventHeaderBytes <= log.size();) {
    const std::size_t channel = number_at(log, at + 20, 4), size = number_at(log, at + 24, 4);
    const std::size_t begin = at + log::kEventHeaderBytes;
    if (number_at(log, at, 4) != log::kEventSync || channel > log.size() - begin ||
        size > log.size() - begin - channel)
      break;
    const auto* text = reinterpret_cast<const char*>(log.data() + begin);
    const auto data = log.begin() + static_cast<std::ptrdiff_t>(begin + channel);
    events.push_back({{text, channel},
                      static_cast<std::int64_t>(number_at(log, at + 12, 8)),
                      {data, data + static_cast<std::ptrdiff_t>(size)}});
    at = begin + channel + size;
  }
  return events;
}

std::vector<std::uint8_t> log_of(const std::vector<LogEvent>& events) {
  std::vector<std::uint8_t> log, head;
  std::int64_t number = 0;
  for (const LogEvent& e : events) {
    log::WireWriter out(head);
    out.i32(static_cast<std::int32_t>(log::kEventSync));
    out.i64(number++);
    out.i64(e.time_us);
    out.i32(static_cast<std::int32_t>(e.channel.size()));
    out.i32(static_cast<std::int32_t>(e.data.size()));
    log.insert(log.end(), head.begin(), head.end());
    log.insert(log.end(), e.channel.begin(), e.channel.end());
    log.insert(log.end(), e.data.begin(), e.data.end());
  }
  return log;
}

void seal(std::vector<LogEvent>& events) {
  log::ContentHash hash;
  for (LogEvent& e : events) {
    if (e.channel == log::Channel<log::LogSummary>::info.name) {
      const log::LogHeader header = header_of(events.front());
      const std::uint64_t content = hash.digest();
      put_hashes(e, header, content, 0);
      hash.add(e.time_us, e.channel, e.data);
      put_hashes(e, header, content, hash.digest());
      return;
    }
    hash.add(e.time_us, e.channel, e.data);
  }
}

}  // namespace kadr::test
