#include "emulator/log/log_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "emulator/log/content_hash.h"
#include "emulator/log/event_file.h"
#include "emulator/log/log_decode.h"
#include "emulator/log/log_proof.h"
#include "machine/base/require.h"

namespace kadr::log {
namespace {
constexpr std::string_view kRunChannel = Channel<LogHeader>::info.name;
}

struct LogReader::Impl {
  explicit Impl(EventFile file) : events(std::move(file)) {}

  EventFile events;
  LogEventView view;
  LogHeader header;
  std::optional<LogProof> proof;
  ContentHash content;
  HashesRead hashes;
  std::string denied;  // by the summary's hashes; a sentence
  bool header_given = false;
  bool finished = false;
  std::optional<LogState> summary;  // of the KADR_SUMMARY that was read
  Ticks ticks_until, steps_until, seen_until;
  LogEnd end;

  void take_header(LogHeader read) {
    header = std::move(read);
    proof.emplace(header);
  }

  void stop(LogState state, std::string detail) {
    finished = true;
    end.state = state;
    end.detail = std::move(detail);
    end.valid_bytes = valid_bytes;
    end.file_bytes = events.size();
    end.valid_until = valid_until();
  }

  /// Exact data come after the events and viewer messages of their ticks: they say how far everything is complete.
  Ticks valid_until() const {
    if (summary) return seen_until;
    if (header.logs_ticks && header.logs_steps) return std::min(ticks_until, steps_until);
    if (header.logs_ticks) return ticks_until;
    if (header.logs_steps) return steps_until;
    return seen_until;
  }

  void note_progress(const LogMessage& message) {
    const auto tau = header.control_tick_ticks;
    if (const auto* t = std::get_if<TickBlock>(&message))
      ticks_until = Ticks{t->begin.value + static_cast<std::int64_t>(t->size()) * tau};
    if (const auto* s = std::get_if<StepBlock>(&message))
      steps_until = Ticks{s->begin.value + static_cast<std::int64_t>(s->batches.size()) * tau};
    if (const auto* f = std::get_if<FeedSample>(&message)) seen_until = std::max(seen_until, f->tick);
    if (const auto* e = std::get_if<EventRecord>(&message)) seen_until = std::max(seen_until, e->tick);
    if (const auto* b = std::get_if<BlockRecord>(&message)) seen_until = std::max(seen_until, b->tick);
    if (const auto* s = std::get_if<LogSummary>(&message)) {
      seen_until = s->run.ticks;
      summary = s->run.outcome == Outcome::interrupted ? LogState::interrupted : LogState::complete;
    }
  }

  /// Says once what is not known of a channel.
  void pass_over(std::string note) {
    if (end.passed_over.size() < kMostNotes &&
        std::find(end.passed_over.begin(), end.passed_over.end(), note) == end.passed_over.end())
      end.passed_over.push_back(std::move(note));
  }
  void note_newer(std::string_view channel) {
    pass_over(fmt::format("{} has fields that this version does not know: they are passed over",
                          printable(channel)));
  }
  void note_unknown(std::string_view channel) {
    pass_over(fmt::format("channel {} is not known: it is passed over", printable(channel)));
  }

  /// Takes the event into the hashes, which are compared at the summary.
  void hash_event(const LogMessage& message) {
    if (const auto* s = std::get_if<LogSummary>(&message)) {
      hashes = hashes_at_summary(content, view.time_us, view.channel, view.data, *s);
      denied = denial(hashes, *s);
    } else {
      content.add(view.time_us, view.channel, view.data);
    }
  }

  /// Reads the file once, from its beginning to its summary, and back to the first message.
  /// @return a sentence if its hashes deny what was read; empty: they don't, or there are none
  std::string denial_of_file() {
    ContentHash hash;
    std::string sentence;
    events.rewind();
    bool summed_up = false;
    LogEventView event;
    EventFile::Next got = events.next(event);
    for (; !summed_up && got == EventFile::Next::event; got = events.next(event)) {
      if (event.channel != Channel<LogSummary>::info.name) {
        hash.add(event.time_us, event.channel, event.data);
        continue;
      }
      const auto read = decode<LogSummary>(event.data, event.channel, header);
      if (read)
        sentence = denial(hashes_at_summary(hash, event.time_us, event.channel, event.data, read->record),
                          read->record);
      summed_up = true;
    }
    note_remainder(got, summed_up);
    events.rewind();
    events.next(view);
    return sentence;
  }

  /// Keeps why the events of the whole file break off, for those who read a part of them.
  void note_remainder(EventFile::Next got, bool summed_up) {
    if (got == EventFile::Next::damaged)
      remainder = "damaged: " + events.detail();
    else if (got == EventFile::Next::event)
      remainder = "damaged: an event follows the summary";
    else if (got == EventFile::Next::cut || !summed_up)
      remainder = "cut off: " + (got == EventFile::Next::end ? "no KADR_SUMMARY" : events.detail());
  }

  void stop_at(EventFile::Next why) {
    const auto at_s = [&] { return header.seconds(valid_until()); };
    if (why == EventFile::Next::damaged)
      return stop(LogState::damaged, fmt::format("damaged: {}; valid up to tick {} ({:.6f} s)",
                                                 events.detail(), valid_until().value, at_s()));
    if (summary && !denied.empty() && why == EventFile::Next::end) return stop(LogState::altered, denied);
    if (summary == LogState::complete && why == EventFile::Next::end) return stop(LogState::complete, "");
    if (summary == LogState::interrupted && why == EventFile::Next::end)
      return stop(LogState::interrupted,
                  fmt::format("interrupted at tick {} ({:.6f} s)", valid_until().value, at_s()));
    stop(LogState::cut_off, fmt::format("cut off: {}; valid up to tick {} ({:.6f} s)",
                                        why == EventFile::Next::end ? "no KADR_SUMMARY" : events.detail(),
                                        valid_until().value, at_s()));
  }

  void stop_in_event(const std::string& reason) {
    stop(LogState::damaged,
         fmt::format("damaged: event {} ({}) at byte {}: {}; valid up to tick {} ({:.6f} s)", view.number,
                     printable(view.channel), valid_bytes, reason, valid_until().value,
                     header.seconds(valid_until())));
  }

  bool next(LogMessage& message) {
    if (finished) return false;
    if (!header_given) {
      header_given = true;
      message = header;
      hash_event(message);
      valid_bytes = events.position();
      return true;
    }
    if (const auto got = events.next(view); got != EventFile::Next::event) return stop_at(got), false;
    if (summary) return stop_in_event("an event follows the summary"), false;
    auto decoded = decode_message(view, header);
    if (!decoded) return stop_in_event(decoded.error()), false;
    hash_event(decoded->record);
    if (const Breach wrong = proof->add(view, decoded->record, !denied.empty()))
      return stop_in_event(*wrong), false;
    if (decoded->newer) note_newer(view.channel);
    message = std::move(decoded->record);
    if (std::holds_alternative<UnknownMessage>(message)) note_unknown(view.channel);
    valid_bytes = events.position();
    note_progress(message);
    return true;
  }

  std::int64_t valid_bytes = 0;
  std::string remainder;  ///< empty: the events go on to a summary and end there
};

namespace {

LogReadError fault(LogReadFault kind, const std::string& path, std::string reason) {
  return {kind, path, std::move(reason)};
}

LogReadError not_kadr(EventFile::Next got, const EventFile& events, const LogEventView& view,
                      const std::string& path) {
  if (events.size() == 0) return fault(LogReadFault::not_a_log, path, "the file is empty");
  if (got == EventFile::Next::cut && !view.channel.empty() && view.channel == kRunChannel)
    return fault(LogReadFault::cut_in_header, path, "the log was cut off in its first message");
  if (got == EventFile::Next::cut && kRunChannel.substr(0, view.channel.size()) == view.channel)
    return fault(LogReadFault::not_a_log, path, "the file ends before its first message: nothing to read");
  return fault(LogReadFault::not_a_log, path, "not an LCM event log: " + events.detail());
}

}  // namespace

tl::expected<LogReader, LogReadError> LogReader::open(const std::string& path) {
  auto reader = inspect(path);
  if (!reader) return reader;
  if (std::string denied = reader->impl_->denial_of_file(); !denied.empty())
    return tl::unexpected(fault(LogReadFault::altered, path, std::move(denied)));
  return reader;
}

tl::expected<LogReader, LogReadError> LogReader::inspect(const std::string& path) {
  auto file = EventFile::open(path);
  if (!file) return tl::unexpected(fault(LogReadFault::cannot_open, path, file.error()));
  auto impl = std::make_unique<Impl>(std::move(*file));
  if (const auto got = impl->events.next(impl->view); got != EventFile::Next::event)
    return tl::unexpected(not_kadr(got, impl->events, impl->view, path));
  if (impl->view.channel != kRunChannel)
    return tl::unexpected(
        fault(LogReadFault::other_log, path,
              "an LCM log, but not of kadr: its first channel is " + printable(impl->view.channel)));
  auto header = decode_header(impl->view.data);
  if (!header) return tl::unexpected(fault(header.error().fault, path, header.error().reason));
  if (const Breach wrong = LogProof::of_header(header->record))
    return tl::unexpected(
        fault(LogReadFault::cut_in_header, path, "the log's first message is damaged: " + *wrong));
  impl->take_header(std::move(header->record));
  if (header->newer) impl->note_newer(kRunChannel);
  return LogReader(std::move(impl));
}

LogReader::LogReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LogReader::LogReader(LogReader&&) noexcept = default;
LogReader& LogReader::operator=(LogReader&&) noexcept = default;
LogReader::~LogReader() = default;

const LogHeader& LogReader::header() const { return impl_->header; }
bool LogReader::next(LogMessage& message) { return impl_->next(message); }
const LogEventView& LogReader::event() const { return impl_->view; }
std::uint64_t LogReader::content_hash() const {
  return impl_->summary ? impl_->hashes.content : impl_->content.digest();
}
std::optional<std::uint64_t> LogReader::log_hash() const { return impl_->hashes.log; }
std::uint64_t LogReader::steps_hash() const { return impl_->proof->steps_hash(); }
const std::string& LogReader::remainder() const { return impl_->remainder; }
std::uint64_t LogReader::file_hash() const { return impl_->events.hash(); }
const LogEnd& LogReader::end() const {
  require(impl_->finished, "a log's end is known after its last message");
  return impl_->end;
}

}  // namespace kadr::log
