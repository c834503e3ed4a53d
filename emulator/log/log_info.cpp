#include "emulator/log/log_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <unordered_map>

#include "machine/base/hash.h"

namespace kadr::log {
namespace {

std::uint64_t hash_of_file(const std::string& path, std::int64_t bytes) {
  struct Close {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  Hash64 hash;
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
  std::vector<unsigned char> buffer(std::size_t{1} << 18);
  while (file && bytes > 0) {
    const std::size_t want = std::min(buffer.size(), static_cast<std::size_t>(bytes));
    const std::size_t got = std::fread(buffer.data(), 1, want, file.get());
    if (got == 0) break;
    hash.bytes(buffer.data(), got);
    bytes -= static_cast<std::int64_t>(got);
  }
  return hash.digest();
}

/// Counts the messages of each channel, in the order of the first ones.
class ChannelCounts {
 public:
  explicit ChannelCounts(std::vector<ChannelInfo>& channels) : channels_(channels) {}
  void add(const LogEventView& event) {
    const auto [it, fresh] = place_.try_emplace(std::string(event.channel), channels_.size());
    if (fresh) channels_.push_back({it->first, 0, 0});
    ChannelInfo& channel = channels_[it->second];
    ++channel.messages;
    channel.bytes += event.bytes();
  }

 private:
  std::vector<ChannelInfo>& channels_;
  std::unordered_map<std::string, std::size_t> place_;
};

/// Adds the facts of one message.
class Collector {
 public:
  explicit Collector(LogInfo& info) : info_(info) { info_.pulses.resize(info.header.axis.size()); }

  void operator()(const TickBlock& b) { info_.control_ticks += static_cast<std::int64_t>(b.size()); }
  void operator()(const StepBlock& b) {
    if (!info_.header.logs_ticks) info_.control_ticks += static_cast<std::int64_t>(b.batches.size());
    for (const StepBatch& batch : b.batches)
      for (std::size_t a = 0; a < batch.axis.size(); ++a)
        info_.pulses[a] += static_cast<std::int64_t>(batch.axis[a].count());
  }
  void operator()(const EventRecord& e) {
    ++info_.events;
    if (e.kind == EventKind::alarm) ++info_.alarms;
  }
  void operator()(const BlockRecord&) { ++info_.blocks; }
  void operator()(const LogDiagnostic&) { ++info_.diagnostics; }
  void operator()(const LogSummary& s) { info_.summary = s; }
  template <class Other>
  void operator()(const Other&) {}

 private:
  LogInfo& info_;
};

std::string grouped(std::int64_t value) {
  std::string digits = fmt::format("{}", value);
  const std::ptrdiff_t first = value < 0 ? 1 : 0;
  for (auto at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > first; at -= 3)
    digits.insert(static_cast<std::size_t>(at), 1, ' ');
  return digits;
}

std::string counted(std::int64_t n, const char* word) {
  return grouped(n) + ' ' + word + (n == 1 ? "" : "s");
}

std::string agreement(std::optional<bool> agrees) {
  return !agrees ? "" : *agrees ? "  agrees with the summary" : "  DIFFERS from the summary";
}

}  // namespace

std::optional<bool> LogInfo::steps_hash_agrees() const {
  if (!summary || !steps_hash) return std::nullopt;
  return *steps_hash == summary->run.steps_hash;
}

std::optional<bool> LogInfo::content_hash_agrees() const {
  if (!summary) return std::nullopt;
  return content_hash == summary->content_hash;
}

std::optional<bool> LogInfo::log_hash_agrees() const {
  if (!summary || !log_hash) return std::nullopt;
  return *log_hash == summary->log_hash;
}

tl::expected<LogInfo, LogReadError> log_info(const std::string& path) {
  auto reader = LogReader::inspect(path);
  if (!reader) return tl::unexpected(reader.error());
  LogInfo info;
  info.path = path;
  info.header = reader->header();
  Collector collect(info);
  ChannelCounts channels(info.channels);
  for (LogMessage message; reader->next(message);) {
    channels.add(reader->event());
    std::visit(collect, message);
  }
  info.end = reader->end();
  info.last_tick = info.end.valid_until.value;
  info.span_s = info.header.seconds(info.end.valid_until);
  info.content_hash = reader->content_hash();
  info.log_hash = reader->log_hash();
  if (info.header.logs_steps) info.steps_hash = reader->steps_hash();
  info.file_hash = hash_of_file(path, info.end.file_bytes);
  return info;
}

std::string log_state_name(LogState state) {
  switch (state) {
    case LogState::complete:
      return "complete";
    case LogState::interrupted:
      return "interrupted";
    case LogState::cut_off:
      return "cut off";
    case LogState::damaged:
      return "damaged";
    case LogState::altered:
      return "altered";
  }
  return "";
}

std::string render_log_info(const LogInfo& info) {
  const LogHeader& h = info.header;
  const std::string state = info.end.state == LogState::complete  ? "complete"
                            : info.end.state == LogState::altered ? "altered: " + info.end.detail
                                                                  : info.end.detail;
  std::string out = fmt::format("{}: {}\n", info.path, state);
  const auto line = [&](const char* name, const std::string& text) {
    out += fmt::format("  {:<12}{}\n", name, text);
  };
  line("program",
       fmt::format("{}, {}, on {} (kadr {}, log format {})", h.program_name, counted(h.program_bytes, "byte"),
                   h.machine_name, h.kadr_version, h.log_format));
  line("clock", fmt::format("{} Hz, control tick {} base ticks ({:.6g} ms)", grouped(h.base_hz),
                            grouped(h.control_tick_ticks), 1000 * h.seconds(Ticks{h.control_tick_ticks})));
  line("span", fmt::format("ticks {} to {}, {:.6f} s, {}", grouped(info.first_tick), grouped(info.last_tick),
                           info.span_s, counted(info.control_ticks, "control tick")));
  if (info.summary)
    line("outcome",
         fmt::format("{}, exit {}", info.summary->run.outcome.text(), info.summary->run.exit_code));
  line("records", fmt::format("{}, {}, {}, {}", counted(info.blocks, "block"), counted(info.events, "event"),
                              counted(info.alarms, "alarm"), counted(info.diagnostics, "diagnostic")));
  for (std::size_t a = 0; a < h.axis.size() && h.logs_steps; ++a)
    line(a == 0 ? "pulses" : "", fmt::format("{} {:>14}  of {:.9g} {}", h.axis[a].name,
                                             grouped(info.pulses[a]), h.axis[a].step_u, h.axis[a].unit));
  line("inputs hash", hash_text(h.inputs_hash));
  if (info.steps_hash) line("steps hash", hash_text(*info.steps_hash) + agreement(info.steps_hash_agrees()));
  line("content", hash_text(info.content_hash) + agreement(info.content_hash_agrees()));
  if (info.log_hash) line("log", hash_text(*info.log_hash) + agreement(info.log_hash_agrees()));
  line("file", fmt::format("{}  {} bytes", hash_text(info.file_hash), grouped(info.end.file_bytes)));
  for (const std::string& note : info.end.passed_over) line("newer", note);
  out += fmt::format("  {:<20}{:>12}{:>16}{:>9}\n", "channel", "messages", "bytes", "share");
  for (const ChannelInfo& c : info.channels)
    out += fmt::format("  {:<20}{:>12}{:>16}{:>7.1f} %\n", c.name, grouped(c.messages), grouped(c.bytes),
                       100.0 * static_cast<double>(c.bytes) / static_cast<double>(info.end.file_bytes));
  return out;
}

}  // namespace kadr::log
