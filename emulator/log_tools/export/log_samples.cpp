#include "emulator/log_tools/export/log_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/log_tools/export/signal_table.h"

namespace kadr::log_tools {

bool matches_pattern(std::string_view name, std::string_view pattern) {
  std::size_t n = 0, p = 0, star = std::string_view::npos, behind = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      behind = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++n;
      ++p;
    } else if (star != std::string_view::npos) {
      // the last star takes one more
      n = ++behind;
      p = star + 1;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

struct LogSamples::Impl {
  explicit Impl(LogFrames f) : frames(std::move(f)) {}

  LogFrames frames;
  LogFrame now, before;             // data of a sample, and the control tick before it
  std::optional<LogFrame> waiting;  // read while opening
  TickContext context;
  double tau_s = 0;
  std::vector<Signal> all, chosen;
  std::vector<SignalSource> table;
  std::vector<std::size_t> choice;  // indices in table
  double from_s = 0, to_s = std::numeric_limits<double>::infinity();
  std::int64_t every = 1;
  bool stopped = false;  // at the window's end
  std::function<void(const LogFrame&)> each;

  bool read() {
    before = std::move(now);
    if (context.frame != nullptr) context.frame = &before;
    if (waiting) {
      now = std::move(*waiting);
      waiting.reset();
      return true;
    }
    return frames.next(now);
  }

  void take_window(const SampleChoice& window) {
    from_s = window.from_s;
    to_s = window.to_s;
    if (!(window.rate_hz > 0)) return;
    const double ratio = 1 / (tau_s * window.rate_hz);
    every = ratio < 1 ? 1 : ratio > 1e12 ? std::int64_t{1'000'000'000'000} : std::llround(ratio);
  }

  void take(std::size_t signal) {
    if (std::find(choice.begin(), choice.end(), signal) != choice.end()) return;
    choice.push_back(signal);
    chosen.push_back(all[signal]);
  }

  void take_none() {
    choice.clear();
    chosen.clear();
  }

  /// Rest between control ticks that the log skips.
  void skip_gap() {
    if (context.frame == nullptr || now.control_tick == before.control_tick + 1) return;
    for (CommandedAxis& m : context.axis) m = {m.command_u, 0, 0, 0};
  }

  void take_all() {
    choice.resize(table.size());
    for (std::size_t i = 0; i < choice.size(); ++i) choice[i] = i;
    chosen = all;
  }
};

LogSamples::LogSamples(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LogSamples::LogSamples(LogSamples&&) noexcept = default;
LogSamples::~LogSamples() = default;

tl::expected<LogSamples, log::LogReadError> LogSamples::open(const std::string& path) {
  auto frames = LogFrames::open(path);
  if (!frames) return tl::unexpected(frames.error());
  auto impl = std::make_unique<Impl>(std::move(*frames));
  const log::LogHeader& header = impl->frames.header();
  if (!header.logs_ticks)
    return tl::unexpected(
        log::LogReadError{log::LogReadFault::not_a_log, path,
                          "the log has no KADR_TICKS; run with log.ticks = true in the machine file"});
  impl->context.header = &header;
  impl->tau_s = header.seconds(Ticks{header.control_tick_ticks});
  LogFrame first;
  // every control tick of a proved log has the columns of the first; a log of events alone has none
  if (impl->frames.next(first)) {
    if (first.ticks) impl->table = signal_table(header, first);
    impl->waiting = std::move(first);
  }
  for (const SignalSource& source : impl->table) impl->all.push_back(source.signal);
  impl->take_all();
  return LogSamples(std::move(impl));
}

const log::LogHeader& LogSamples::header() const { return impl_->frames.header(); }
const std::vector<Signal>& LogSamples::signals() const { return impl_->all; }
const std::vector<Signal>& LogSamples::chosen() const { return impl_->chosen; }
double LogSamples::control_tick_s() const { return impl_->tau_s; }
double LogSamples::from_s() const { return impl_->from_s; }
std::int64_t LogSamples::every() const { return impl_->every; }
void LogSamples::watch(std::function<void(const LogFrame&)> each) { impl_->each = std::move(each); }
const std::string& LogSamples::remainder() const { return impl_->frames.remainder(); }
const log::LogEnd* LogSamples::end() const { return impl_->stopped ? nullptr : &impl_->frames.end(); }
const std::optional<log::LogSummary>& LogSamples::summary() const { return impl_->frames.summary(); }

tl::expected<void, std::string> LogSamples::choose(const SampleChoice& choice) {
  Impl& m = *impl_;
  m.take_window(choice);
  if (choice.signals.empty()) return {};
  m.take_none();
  std::string_view rest = choice.signals;
  while (!rest.empty()) {
    const auto comma = rest.find(',');
    const std::string_view pattern = rest.substr(0, comma);
    rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
    bool found = false;
    for (std::size_t i = 0; i < m.all.size(); ++i) {
      if (!matches_pattern(m.all[i].name, pattern)) continue;
      found = true;
      m.take(i);
    }
    if (!found)
      return tl::unexpected(
          fmt::format("the log has no signal '{}' (`kadr export LOG --list` lists them all)", pattern));
  }
  return {};
}

void LogSamples::choose(const SampleChoice& window, const std::vector<std::string>& names) {
  Impl& m = *impl_;
  m.take_window(window);
  m.take_none();
  for (const std::string& name : names)
    for (std::size_t i = 0; i < m.all.size(); ++i)
      if (m.all[i].name == name) m.take(i);
}

bool LogSamples::next(Sample& sample) {
  Impl& m = *impl_;
  while (m.read()) {
    if (m.each) m.each(m.now);
    if (!m.now.ticks) continue;
    m.skip_gap();
    advance(m.context, m.now, m.tau_s);
    // the first control tick is number 0 and its sample is taken at its end
    sample.control_tick = m.now.control_tick;
    sample.end = Ticks{(m.now.control_tick + 1) * header().control_tick_ticks};
    sample.t_s = header().seconds(sample.end);
    if (sample.t_s > m.to_s) {
      if (m.each) continue;
      m.stopped = true;
      return false;
    }
    if (sample.t_s < m.from_s || m.now.control_tick % m.every != 0) continue;
    sample.value.resize(m.choice.size());
    for (std::size_t k = 0; k < m.choice.size(); ++k) sample.value[k] = m.table[m.choice[k]].value(m.context);
    sample.frame = &m.now;
    return true;
  }
  return false;
}

}  // namespace kadr::log_tools
