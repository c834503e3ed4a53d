#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/export/log_samples.h"
#include "machine/machine.h"

/// What a report page shows of a run, gathered in one pass over its log; memory does not grow with the log
/// beyond kMostPieces values a signal.
namespace kadr::emulator {

inline constexpr std::size_t kMostPieces = std::size_t{1} << 20;
inline constexpr std::size_t kMostEvents = 5000;
inline constexpr std::size_t kMostBlocks = 200'000;

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

struct PageData {
  LogHeader header;
  LogEnd end;
  std::optional<LogSummary> summary;
  std::optional<machine::MachineModel> machine;  ///< by the settings in the log; none: they can't be read
  std::int64_t control_ticks = 0;                ///< in the log
  std::int64_t first_control_tick = 0;
  std::int64_t every = 1;  ///< control ticks a piece
  std::vector<Track> tracks;
  std::vector<std::vector<std::int32_t>> nodes;  ///< [axes][pieces] lattice node at the end of each piece
  std::vector<AxisWork> work;                    ///< [axes]; empty without plant
  std::vector<PageBlock> blocks;
  std::vector<EventRecord> events;  ///< alarms all, others up to kMostEvents
  std::vector<LogDiagnostic> diagnostics;
  std::size_t blocks_left_out = 0, events_left_out = 0;
  std::size_t pieces() const { return nodes.empty() ? 0 : nodes.front().size(); }
};

/// Reads a log for a page.
/// @param choice  part of the run; its signals are the page's own
tl::expected<PageData, LogReadError> read_page_data(const std::string& path, const SampleChoice& choice);

/// Each two pieces become one: half the size, no peak lost.
void halve(PageData& data);

}  // namespace kadr::emulator
