#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/log_tools/export/log_samples.h"
#include "emulator/log_tools/report/path_corners.h"
#include "machine/machine.h"

/// Data of a report page about a run, gathered in one pass over its log; memory does not grow with the log
/// beyond kMostPieces values per signal.
namespace kadr::log_tools {

inline constexpr std::size_t kMostPieces = std::size_t{1} << 20;
inline constexpr std::size_t kMostEvents = 5000;
inline constexpr std::size_t kMostBlocks = 200'000;
inline constexpr std::size_t kMostCorners = std::size_t{1} << 17;
inline constexpr double kChord_mm = 0.005;  ///< of the path's corners, as long as they are not too many

/// One signal over the run: lowest and highest value of every piece of `every` control ticks.
struct Track {
  Signal signal;
  std::vector<float> low, high;  ///< [pieces]; equal while a piece is one control tick
};

/// A motion block as run.
struct PageBlock {
  Ticks begin;
  std::uint32_t block = 0, line = 0;
  double length_u = 0, planned_s = 0, programmed_u_s = 0, planned_peak_u_s = 0;
  std::string limited_by, motion, text;
};

/// Mechanical work of an axis' motor: sums of force times speed of the motor's mass over control ticks.
struct AxisWork {
  double driving_J = 0;  ///< where force and speed have one direction
  double braking_J = 0;  ///< where they do not, <= 0
};

/// Control ticks [first, first + ticks) since the page's first.
struct Stretch {
  std::int64_t first = 0, ticks = 0;
};

/// Stretches of a run with every control tick, where all of them would be too many.
struct FullRate {
  std::vector<Stretch> stretches;                ///< ascending, apart from each other
  std::vector<std::vector<float>> tracks;        ///< [tracks][control ticks of all stretches]
  std::vector<std::vector<std::int32_t>> nodes;  ///< [axes][control ticks of all stretches]
};

struct PageData {
  log::LogHeader header;
  log::LogEnd end;
  std::optional<log::LogSummary> summary;
  std::optional<machine::MachineModel> machine;  ///< by the settings in the log; none: they can't be read
  std::int64_t control_ticks = 0;                ///< in the log
  std::int64_t first_control_tick = 0;
  std::int64_t every = 1;  ///< control ticks a piece
  std::vector<Track> tracks;
  std::vector<std::vector<std::int32_t>> nodes;  ///< [axes][pieces] lattice node at the end of each piece
  std::vector<std::int32_t> path_milli;  ///< [pieces] length of path at its end, thousandths of its unit
  PathCorners corners;
  FullRate full_rate;
  std::vector<AxisWork> work;  ///< [axes]; empty without plant
  std::vector<PageBlock> blocks;
  std::vector<log::EventRecord> events;  ///< alarms all, others up to kMostEvents
  std::vector<log::LogDiagnostic> diagnostics;
  std::size_t blocks_left_out = 0, events_left_out = 0;
  std::size_t pieces() const { return nodes.empty() ? 0 : nodes.front().size(); }
};

/// Reads a log for a page.
/// @param choice  part of the run; its signals are the page's own
tl::expected<PageData, log::LogReadError> read_page_data(const std::string& path, const SampleChoice& choice);

/// Reads some stretches once more, now control tick by control tick.
/// @param choice  the one that `data` was read with
tl::expected<FullRate, log::LogReadError> read_full_rate(const std::string& path, const SampleChoice& choice,
                                                         const PageData& data,
                                                         const std::vector<Stretch>& stretches);

/// Where every control tick is worth its room: 1 s round alarms, warnings and each signal's largest value,
/// then round other events, as long as all of it is at most `most` control ticks.
std::vector<Stretch> stretches_of_interest(const PageData& data, std::int64_t most);

/// A value as a page keeps it: beyond the range of a float the farthest one.
float narrowed(double value);

/// mm a lattice step of each axis; 0: not an axis of the picture.
std::vector<double> picture_steps_mm(const log::LogHeader& header);

/// Each two pieces become one: half the size, no peak lost.
void halve(PageData& data);

}  // namespace kadr::log_tools
