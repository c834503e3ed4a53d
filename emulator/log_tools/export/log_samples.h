#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/log_tools/diff/log_frames.h"
#include "emulator/log_tools/export/export_options.h"

/// A log as named signals over time, for exports, plots and the report page (docs/report.md).
namespace kadr::log_tools {

/// One column. Names are those of the viewer channels in lower case, the unit at the end:
/// KADR_FEED.commanded is "feed.commanded_mm_s", KADR_AXIS_X.load is "axis.X.load_mm".
struct Signal {
  std::string name;
  std::string unit;                  ///< "mm/s"; empty: a count or a code
  bool whole = false;                ///< a whole number
  std::vector<std::string> words{};  ///< of a code: the meanings of its values 0, 1 ...; else empty
  bool further = false;              ///< a column straight from the log, without a chart designed for it
};

/// One control tick, at its end.
struct Sample {
  std::int64_t control_tick = 0;
  Ticks end;
  double t_s = 0;             ///< of `end`
  std::vector<double> value;  ///< [chosen signals]; NaN: nothing to tell, e.g. the programmed feed of a rapid
  const LogFrame* frame = nullptr;  ///< pulses, events and block of this control tick; until the next call
};

/// Reads one log from its beginning, a control tick a step; memory is that of one log block.
class LogSamples {
 public:
  static tl::expected<LogSamples, log::LogReadError> open(const std::string& path);
  LogSamples(LogSamples&&) noexcept;
  ~LogSamples();

  const log::LogHeader& header() const;
  /// All that the log can tell: without plant nothing of the load, without an operator's steps nothing of
  /// what was asked for.
  const std::vector<Signal>& signals() const;
  /// @return a sentence that names the chosen signals that the log lacks
  tl::expected<void, std::string> choose(const SampleChoice& choice);
  /// The same with signals by their exact names, in this order; a name of a log of unknown origin may hold a
  /// comma or a star.
  void choose(const SampleChoice& window, const std::vector<std::string>& names);
  const std::vector<Signal>& chosen() const;
  double control_tick_s() const;
  double from_s() const;  ///< of the choice
  /// Number of control ticks from one sample to the next.
  std::int64_t every() const;

  /// The next sample of the choice.
  bool next(Sample& sample);
  /// Is called for every control tick that is read, also for those that the choice leaves out.
  void watch(std::function<void(const LogFrame&)> each);
  /// Why the log breaks off anywhere, also where it is not read; empty if it does not.
  const std::string& remainder() const;
  /// How the log ends, once next() said no; null: it stopped at the window's end, the rest was not read.
  const log::LogEnd* end() const;
  const std::optional<log::LogSummary>& summary() const;

 private:
  struct Impl;
  explicit LogSamples(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Whether a name fits a pattern in which `*` matches any text.
bool matches_pattern(std::string_view name, std::string_view pattern);

}  // namespace kadr::log_tools
