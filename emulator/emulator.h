#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/log/records.h"
#include "emulator/log/run_log.h"
#include "gcode/gcode.h"
#include "machine/machine.h"
#include "planner/planner.h"

/// The cycle: program -> path -> law -> step pulses -> plant -> log, event to event.
namespace kadr::emulator {

/// What happens between motions, in program order.
struct ProgramEvent {
  gcode::Block block;             ///< dwell, spindle, coolant, tool, message, stop, end
  std::size_t after_segment = 0;  ///< number of path segments before it
};

/// A program read, planned and verified-ready; everything the cycle needs.
struct Job {
  SourceSet sources;
  std::uint32_t program = 0;  ///< index of the program in sources
  machine::MachineFile machine;
  std::optional<gcode::ToolTable> tools;  ///< none: tools have no length and no radius
  gcode::Dialect dialect = gcode::Dialect::linuxcnc;
  std::vector<ProgramEvent> events;  ///< ascending in after_segment
  planner::Path path{0};
  planner::FeedPlan plan;    ///< laws of the runs, in path order, pauses not included
  std::uint32_t blocks = 0;  ///< motion blocks
  double motion_s = 0, dwell_s = 0;
};

/// Whether a soft limit that the program leaves is an error (`kadr check`: the answer is no) or a warning
/// (`kadr run`: the emulator shows what happens and raises an alarm there).
enum class SoftLimitRule : std::uint8_t { error, warning };

/// Reads and interprets job.sources[job.program] for job.machine, plans it and checks soft limits.
/// Diagnostics go to `diagnostics`, all of the program at once.
/// @return false if there were errors before planning; job.plan is not valid then
bool prepare(Job& job, Diagnostics& diagnostics, SoftLimitRule soft_limits = SoftLimitRule::error);

/// Time that a dwell or tool change holds the machine, seconds; a whole number of control ticks where motions
/// end on them too. 0 for everything else.
double hold_time_s(const gcode::Block& block, const machine::MachineModel& machine);

/// Planned time by what held the feed, longest first; dwells count as "dwell".
std::vector<LimitShare> limit_shares(const Job& job);
/// "program", "junction", "axis X speed", ...
std::string limited_by_text(planner::LimitedBy reason, int axis, const machine::MachineModel& machine);

struct RunOptions {
  bool plant = true;
  int threads = 1;                      ///< 1, or 2: the second encodes and writes; same bytes
  double until_s = machine::kInfinity;  ///< stop after that much machine time
  std::function<void(double done_fraction, std::uint32_t line, double sim_s)>
      progress;                                  ///< called about every 1000 ticks
  const std::atomic<bool>* interrupt = nullptr;  ///< set by a signal handler
};

/// How a run ended apart from its summary.
struct RunFailure {
  std::string what;    ///< sentence for the user
  bool world = false;  ///< disk, network (exit 2); else numerics (exit 3)
};

/// Runs a prepared job; records go to `log` (may be null).
tl::expected<RunSummary, RunFailure> run(const Job& job, RunLog* log, const RunOptions& options);

}  // namespace kadr::emulator
