#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <lcm/lcm-cpp.hpp>
#include <optional>

#include "emulator/log/block_builder.h"
#include "emulator/log/content_hash.h"
#include "emulator/log/log_types.h"
#include "emulator/log/run_log.h"
#include "emulator/log/wire.h"
#include "machine/base/output_file.h"
#include "machine/base/require.h"
#include "machine/machine.h"

namespace kadr::log {
namespace {

using Done = tl::expected<void, LogError>;

std::string error_text(int number) { return number == 0 ? "unknown error" : std::strerror(number); }

/// Multicast must not leave this host unless requested: a udpm URL without a ttl gets ttl=0.
std::string with_local_ttl(const std::string& url) {
  if (url.compare(0, 5, "udpm:") != 0 || url.find("ttl=") != std::string::npos) return url;
  return url + (url.find('?') == std::string::npos ? "?ttl=0" : "&ttl=0");
}

/// The event file and the live channel; every write is checked.
class Sink {
 public:
  explicit Sink(const LcmLogOptions& options)
      : path_(options.path), url_(with_local_ttl(options.publish_url)), most_bytes_(options.most_bytes) {}

  Done open() {
    // LCM would open it over whatever is there, and stamp it with the time of the day
    if (url_.starts_with("file:"))
      return fail(url_, "a live channel is not a file (udpm://, tcpq://, memq://); -o writes the log");
    if (!url_.empty()) {
      errno = 0;
      live_.emplace(url_);
      if (!live_->good()) return fail(url_, "cannot open this LCM provider (udpm://, tcpq://, memq://)");
    }
    if (!path_.empty()) {
      auto file = OutputFile::open(path_, {.keeps_part = true});
      if (!file) return fail(file.error().path, file.error().reason);
      file_.emplace(std::move(*file));
    }
    return {};
  }

  template <class R>
  Done write(const std::string& channel, std::int64_t time_us, const R& record, const LogHeader& header) {
    if (error_) return tl::unexpected(*error_);
    encode(record, header, bytes_);
    content_.add(time_us, channel, bytes_);
    return write_bytes(channel, time_us);
  }
  /// The last message: it is encoded once more with the hash of the whole log.
  Done write_summary(const RunSummary& run, std::int64_t time_us, const LogHeader& header) {
    if (error_) return tl::unexpected(*error_);
    const std::string channel(Channel<LogSummary>::info.name);
    LogSummary summary{run, content_.digest()};
    encode(summary, header, bytes_);
    // with zeros in its place
    content_.add(time_us, channel, bytes_);
    summary.log_hash = content_.digest();
    encode(summary, header, bytes_);
    return write_bytes(channel, time_us);
  }

  /// Hands everything to the kernel; from then on the file is valid up to `tick`.
  Done flush(Ticks tick) {
    if (error_) return tl::unexpected(*error_);
    if (file_)
      if (auto done = file_->flush(); !done) return fail(done.error().path, done.error().reason);
    valid_until_ = tick;
    return {};
  }

  /// Closes the file; with `whole` it gets its name.
  Done close(bool whole) {
    live_.reset();
    if (!file_) return {};
    const auto done = whole ? file_->finish() : file_->leave();
    return done ? Done{} : fail(done.error().path, done.error().reason);
  }

 private:
  Done write_bytes(const std::string& channel, std::int64_t time_us) {
    const auto size = static_cast<std::int32_t>(bytes_.size());
    const auto channel_size = static_cast<std::int32_t>(channel.size());
    if (file_) {
      WireWriter head(head_);
      head.i32(static_cast<std::int32_t>(kEventSync));
      head.i64(events_++);
      head.i64(time_us);
      head.i32(channel_size);
      head.i32(size);
      file_bytes_ += head_.size() + channel.size() + bytes_.size();
      if (most_bytes_ > 0 && file_bytes_ > most_bytes_)
        return fail(written_as(path_), fmt::format("the log is longer than {} bytes; --limit log_bytes=N "
                                                   "allows more, 0 any length",
                                                   most_bytes_));
      for (const std::string_view piece : {text_of(head_), std::string_view(channel), text_of(bytes_)})
        if (auto done = file_->write(piece); !done) return fail(done.error().path, done.error().reason);
    }
    if (live_) {
      errno = 0;
      if (live_->publish(channel, bytes_.data(), static_cast<unsigned>(size)) != 0) return fail(url_, errno);
    }
    return {};
  }

  static std::string_view text_of(const std::vector<std::uint8_t>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  Done fail(const std::string& where, int number) { return fail(where, error_text(number)); }
  Done fail(const std::string& where, const std::string& reason) {
    error_ = LogError{where, reason, valid_until_};
    return tl::unexpected(*error_);
  }

  std::string path_, url_;
  std::optional<OutputFile> file_;
  std::optional<lcm::LCM> live_;
  std::uint64_t most_bytes_;
  std::uint64_t file_bytes_ = 0;
  std::int64_t events_ = 0;
  std::vector<std::uint8_t> head_, bytes_;
  ContentHash content_;
  Ticks valid_until_;
  std::optional<LogError> error_;  // the first one stays: nothing is written after a gap
};

/// Channels that LcmLog writes a message of for each record; those of exact data follow from their tables.
template <class R, class... Written>
constexpr bool kIsOneOf = (std::same_as<R, Written> || ...);
template <class... R>
constexpr bool all_written(Records<R...>) {
  return (
      (detail::TickChannel<R> || kIsOneOf<R, LogHeader, BlockRecord, BlockEndRecord, PulseBlock, FeedSample,
                                          AxisSample, EventRecord, LogDiagnostic, LogSummary>)&&...);
}
static_assert(all_written(Channels{}), "a channel has append_tick(), or a place where LcmLog writes it");

class LcmLog final : public RunLog {
 public:
  explicit LcmLog(const LcmLogOptions& options) : sink_(options) {}
  Done open() { return sink_.open(); }

  Done begin(const RunHeader& run) override {
    require(run.machine != nullptr, "a run has a machine");
    machine_ = *run.machine;
    header_ = log_header(run);
    builder_.emplace(machine_);
    return write(header_, Ticks{0}).and_then([&] { return sink_.flush(Ticks{0}); });
  }

  Done block(const BlockRecord& r) override { return write(r, r.tick); }
  Done block_end(const BlockEndRecord& r) override { return write(r, r.tick); }
  Done event(const EventRecord& r) override { return write(r, r.tick); }
  Done diagnostic(const Diagnostic& d, Ticks tick) override {
    return write(log_diagnostic(d, tick), tick.value < 0 ? Ticks{0} : tick);
  }

  Done tick(const TickRecord& record, const StepBatch& batch) override {
    require(builder_.has_value(), "a log begins before its first tick");
    if (builder_->breaks(record))
      if (auto done = finish_block(); !done) return done;
    builder_->add(record, batch);
    const std::int32_t every = header_.viewer_every_ticks;
    if (every > 0 && (record.tick.value + 1) % every == 0)
      if (auto done = write_viewers(record, batch); !done) return done;
    return builder_->full() ? finish_block() : Done{};
  }

  Done end(const RunSummary& summary) override {
    if (auto done = finish_block(); !done) return done;
    require(builder_.has_value(), "a log begins with its header");
    const std::int64_t time_us = event_time_us(summary.ticks, header_.base_hz);
    if (auto done = sink_.write_summary(summary, time_us, header_); !done) return done;
    if (auto done = sink_.flush(summary.ticks); !done) return done;
    return sink_.close(summary.outcome != Outcome::interrupted);
  }

 private:
  template <class R>
  Done write(const R& record, Ticks tick) {
    require(builder_.has_value(), "a log begins with its header");
    channel_ = Channel<R>::info.name;
    if constexpr (std::same_as<R, AxisSample>)
      channel_ += header_.axis[static_cast<std::size_t>(record.axis)].name;
    return sink_.write(channel_, event_time_us(tick, header_.base_hz), record, header_);
  }

  Done write_viewers(const TickRecord& record, const StepBatch& batch) {
    const FeedSample feed = builder_->feed_sample(record);
    if (auto done = write(feed, feed.tick); !done) return done;
    for (std::size_t a = 0; a < header_.axis.size(); ++a) {
      const AxisSample axis = builder_->axis_sample(record, batch, a);
      if (auto done = write(axis, axis.tick); !done) return done;
    }
    return {};
  }

  Done finish_block() {
    if (!builder_ || builder_->empty()) return {};
    const Ticks end = builder_->end();
    Done done;
    if (header_.logs_ticks)
      for_each_channel(TickChannels{}, [&]<class R>() {
        if (done) done = write(builder_->block<R>(), end);
      });
    if (done && header_.logs_steps) done = write(builder_->pulse_block(), end);
    if (!done) return done;
    builder_->clear();
    return sink_.flush(end);
  }

  Sink sink_;
  machine::MachineModel machine_;
  LogHeader header_;
  std::optional<BlockBuilder> builder_;
  std::string channel_;
};

}  // namespace

tl::expected<std::unique_ptr<RunLog>, LogError> open_lcm_log(const LcmLogOptions& options) {
  auto log = std::make_unique<LcmLog>(options);
  if (auto opened = log->open(); !opened) return tl::unexpected(opened.error());
  return log;
}

}  // namespace kadr::log
