#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/log_tools/diff/feed_compare.h"
#include "emulator/log_tools/diff/log_diff.h"
#include "emulator/log_tools/diff/step_sequence.h"

/// `kadr diff --align path`: compares two logs at the same path length, whenever they get there (docs/diff.md).
namespace kadr::log_tools {

/// The first event of the program that is not the same in both logs; "-": one has no more events.
struct EventDifference {
  std::int64_t number = 0;  ///< from 1, of the program's events
  ProgramPlace place;
  std::string a, b;
};

struct PathDiff {
  LogSide a, b;
  std::vector<InputDifference> inputs;
  double path_a_u = 0, path_b_u = 0;  ///< path length at the end
  std::string unit;                   ///< of path length
  double tolerance_u_s = 0;

  bool steps_compared = false, feed_compared = false, events_compared = false;
  std::int64_t blocks = 0, blocks_differing = 0;
  bool given_up = false;  ///< the logs are too far apart to compare step sequences to the end
  std::optional<BlockDifference> first_block;
  std::int64_t spans = 0;
  double span_length_u = 0;
  std::optional<FeedSpan> first_span, largest_span;
  std::int64_t events = 0;
  std::optional<EventDifference> event;

  /// One log's path is longer.
  bool paths_differ() const { return path_a_u != path_b_u; }
  bool inputs_differ() const;
  bool differ() const {
    return blocks_differing > 0 || given_up || spans > 0 || event || (steps_compared && paths_differ());
  }
};

/// Default of `--tolerance feed=`: feeds of control ticks that fall on different positions, mm/s or deg/s.
inline constexpr double kFeedTolerance_u_s = 0.1;

/// Where the comparison hands things on while it runs; all may be empty.
struct PathDiffSinks {
  std::function<void(const PathDiff&)> begin;         ///< headers and inputs are known, nothing else yet
  std::function<void(const BlockDifference&)> block;  ///< every block that differs, if options.all
  std::function<void(const FeedSpan&)> span;          ///< every stretch on which feeds differ, if options.all
};

/// Compares two logs by path length. Memory does not grow with the logs.
/// @return the reason why a file can't be read as a log, or has no path in it
tl::expected<PathDiff, log::LogReadError> diff_paths(const std::string& a, const std::string& b,
                                                     const DiffOptions& options,
                                                     const PathDiffSinks& sinks = {});

}  // namespace kadr::log_tools
