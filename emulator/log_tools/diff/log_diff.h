#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/log/log_reader.h"
#include "emulator/log_tools/diff/diff_inputs.h"
#include "emulator/log_tools/diff/diff_options.h"
#include "emulator/log_tools/diff/frame_compare.h"

/// `kadr diff`: two logs side by side, control tick by control tick (docs/diff.md). Memory does not grow with the logs.
namespace kadr::log_tools {

/// A control tick that is not the same in both logs.
struct TickDifference {
  std::int64_t control_tick = 0;
  std::uint32_t block = 0;  ///< running number in log A (B if A has none)
  ProgramPlace place_a, place_b;
  std::vector<FieldDifference> fields;  ///< in the order of comparison, never empty
};

/// A control tick near the first difference: one field of KADR_TICKS in both logs.
struct ContextRow {
  std::int64_t control_tick = 0;
  std::string place;  ///< in log A
  std::string a, b;
};

struct FirstDifference {
  TickDifference tick;
  /// feed, path, override ... of that control tick, as far as they are the same
  std::vector<FieldDifference> same;
  std::string context_name, context_unit;  ///< of the field that the rows show
  std::vector<ContextRow> rows;            ///< before, at and after it
  std::string input;  ///< the operator's input before it, if there was one; with its tick
  std::string event;  ///< the event before it, if there was one; with its tick
};

struct ChannelTotals {
  std::int64_t differing = 0;            ///< control ticks
  std::optional<FieldDifference> first;  ///< its first difference
  std::int64_t first_control_tick = 0;
};

struct LogSide {
  std::string path;
  log::LogHeader header;
  log::LogEnd end;
  std::int64_t control_ticks = 0;  ///< valid ones
  std::optional<log::LogSummary> summary;
};

struct LogDiff {
  LogSide a, b;
  std::vector<InputDifference> inputs;
  bool compared = true;   ///< false: clocks differ, so no control tick was compared
  std::int64_t both = 0;  ///< control ticks in both logs
  std::optional<FirstDifference> first;
  std::array<ChannelTotals, kDiffChannels> channels;
  std::vector<FieldDifference> summary;  ///< differences in KADR_SUMMARY
  std::vector<LoadPeak> load_peaks;

  bool inputs_differ() const;
  /// One log has more control ticks than the other.
  bool lengths_differ() const;
  /// Anything but the inputs differs.
  bool differ() const { return !compared || first || lengths_differ() || !summary.empty(); }
};

/// Where the comparison hands things on while it runs; both may be empty.
struct TickDiffSinks {
  std::function<void(const LogDiff&)> begin;  ///< headers and inputs are known, nothing else yet
  /// every control tick that differs, in order, if options.all
  std::function<void(const TickDifference&)> each;
};

/// Compares two logs by control tick.
/// @return the reason why a file can't be read as a log
tl::expected<LogDiff, log::LogReadError> diff_logs(const std::string& a, const std::string& b,
                                                   const DiffOptions& options,
                                                   const TickDiffSinks& sinks = {});

}  // namespace kadr::log_tools
