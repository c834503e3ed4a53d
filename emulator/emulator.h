#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/log/records.h"
#include "emulator/log/run_log.h"
#include "gcode/gcode.h"
#include "machine/machine_file.h"
#include "planner/laws/feed_plan.h"
#include "planner/limits/plan_error.h"
#include "planner/path/path.h"

/// The cycle: program -> path -> law -> step pulses -> plant -> log, event to event.
namespace kadr::cycle {

/// How a wait ends (M66).
struct WaitOutcome {
  bool reached = false;  ///< the awaited level or edge came; always of an immediate reading
  double value = 0;      ///< of the input as the wait ends
  double waited_s = 0;
};

/// What happens between motions, in program order.
struct ProgramEvent {
  gcode::Block block;             ///< dwell, spindle, coolant, tool, output, wait, message, stop, end ...
  std::size_t after_segment = 0;  ///< number of path segments before it
  WaitOutcome wait = {};          ///< of a wait
};

/// A step of the scenario's timeline: what an input reads from a control tick on, until its next step.
struct InputStep {
  ControlTicks tick;
  bool analog = false;
  int number = 0;
  double value = 0;  ///< digital: 0 or 1
  Span span;         ///< in the scenario file
};

/// What an operator, the spindle or the emergency stop does.
enum class OperatorAction : std::uint8_t {
  feed_override,   ///< value: ratio, 0..2
  rapid_override,  ///< value: ratio, 0..1
  hold,
  resume,
  spindle_load,  ///< value: ratio of the rated load
  emergency_stop,
};

/// Position on the path at which a step of the timeline comes into force.
struct PathPlace {
  enum class Kind : std::uint8_t { line, block, length } kind = Kind::length;
  double number = 0;   ///< line from 1, running block number from 0, or length of path, mm or deg
  int pass = 1;        ///< line: which of its motions, from 1
  double after_u = 0;  ///< behind the beginning of the line's or block's motion, as its feed measures
};

/// A step of the timeline that changes how the program is run: in force for the control tick that begins at
/// its tick, or for the first one that begins at or behind its place.
struct OperatorStep {
  OperatorAction action = OperatorAction::feed_override;
  double value = 1;
  ControlTicks tick;  ///< unless place is given
  std::optional<PathPlace> place;
  Span span;  ///< in the scenario file
};

/// A technology point where the first motion of a program line begins.
struct LineLimit {
  std::uint32_t line = 0;
  double max_u_s = 0;
  Span span;
};

/// A technology point at a length of the path.
struct PlaceLimit {
  double at_u = 0;
  double max_u_s = 0;  ///< along what F measures
  Span span;
};

/// What a job is given. Nothing changes it from then on.
struct JobInputs {
  std::uint32_t program = 0;  ///< file in the sources
  machine::MachineFile machine;
  gcode::Reading reading;                    ///< of the program
  std::vector<InputStep> inputs;             ///< what M66 meets; ascending by tick
  std::vector<OperatorStep> operator_steps;  ///< by tick those that have one, in the file's order the others
  /// Highest feed override that the run is prepared for, a ratio from 1 to 2; empty: the highest of operator_steps.
  /// The override keeps every limit up to it, so the record of a live run gives the same run only with the same number.
  std::optional<double> most_override;
  std::vector<LineLimit> line_limits;  ///< technology points of a scenario
  std::vector<PlaceLimit> place_limits;
};

/// What the program says: made of the inputs by lay_out().
struct ReadProgram {
  planner::Path path;                       ///< technology points included
  std::vector<ProgramEvent> events;         ///< ascending in after_segment
  std::uint32_t blocks = 0;                 ///< motion blocks
  std::vector<std::uint32_t> called_files;  ///< in the sources, in the order of their first call
  /// The way from home to where the program is entered (gcode::Reading::from_line): none of the blocks, the first
  /// segments of the path. None: the program is run from its beginning.
  std::optional<gcode::Block> approach = {};
};

/// How the program will move: made of what was read by plan_program().
struct PlannedProgram {
  planner::FeedPlan plan;             ///< pauses included
  std::vector<double> step_places_u;  ///< [operator_steps] path length of those that have a place
};

/// A program that can be run: given, read, planned and verified.
struct Job {
  const SourceSet& sources;
  const JobInputs& given;
  ReadProgram read;
  PlannedProgram planned;
};

/// Whether a soft limit that the program leaves is an error (`kadr check`: the answer is no) or a warning
/// (`kadr run`: the emulator shows what happens and raises an alarm there).
enum class SoftLimitRule : std::uint8_t { error, warning };

/// What a test puts in the place of planner::plan(); empty: that one.
using PlanFunction = std::function<tl::expected<planner::FeedPlan, planner::PlanError>(
    const planner::Path&, const machine::MachineModel&, std::span<const planner::Pause>)>;

/// Reads and interprets the program for the machine: path, events, technology points; soft limits are
/// checked. Diagnostics are of the program as a whole.
/// @param sources  files that the program calls are added
/// @return nothing if there were errors before the soft limits were looked at
std::optional<ReadProgram> lay_out(const JobInputs& given, SourceSet& sources, Diagnostics& diagnostics,
                                   SoftLimitRule soft_limits = SoftLimitRule::error);

/// Plans what was read, verifies the plan (require_sound_plan), and finds the operator's steps on the path.
/// @return nothing if it can't be planned, or a step's place is not on the path
/// @throws BrokenPromise for a plan that breaks a limit or its own law
std::optional<PlannedProgram> plan_program(const JobInputs& given, const SourceSet& sources,
                                           const ReadProgram& read, Diagnostics& diagnostics,
                                           const PlanFunction& plan = {});

/// lay_out() and plan_program(). The job refers to `given` and `sources`.
std::optional<Job> prepare(const JobInputs& given, SourceSet& sources, Diagnostics& diagnostics,
                           SoftLimitRule soft_limits = SoftLimitRule::error, const PlanFunction& plan = {});

/// planner::verify() of a plan with its pauses, as planner::production_check() says.
/// @throws BrokenPromise with program line, place on the path, and what was measured and allowed
void require_sound_plan(const JobInputs& given, const SourceSet& sources, const ReadProgram& read,
                        const planner::FeedPlan& plan);

/// Time that a dwell, a wait or a tool change holds the machine, seconds; a whole number of control ticks
/// where motions end on them too. 0 for everything else.
double hold_time_s(const ProgramEvent& event, const machine::MachineModel& machine);

/// The standstills that the program asks of plan(), ascending.
std::vector<planner::Pause> pauses(const std::vector<ProgramEvent>& events,
                                   const machine::MachineModel& machine);

/// What one motion block comes to, over all of its segments.
struct BlockSummary {
  std::size_t end_segment = 0;  ///< one past its last segment
  double length_u = 0;          ///< that its feed measures
  double programmed_u_s = 0;    ///< 0 for a rapid
  double peak_u_s = 0;
  double end_u_s = 0;
  double begin_s = 0;
  double time_s = 0;
  planner::LimitedBy limited_by = planner::LimitedBy::program;  ///< what held its fastest segment
  std::int8_t limiting_axis = -1;
};
/// @param segment  the first one of a block
BlockSummary block_summary(const planner::Path& path, const planner::FeedPlan& plan, std::size_t segment);

/// Planned time by what held the feed, longest first; dwells count as "dwell".
std::vector<log::LimitShare> limit_shares(const planner::MotionLaw& law,
                                          const machine::MachineModel& machine);
/// "program", "junction", "axis X speed", ...
std::string limited_by_text(planner::LimitedBy reason, int axis, const machine::MachineModel& machine);

/// How a session is run (emulator/cycle/session.h).
struct SessionOptions {
  bool plant = true;
  bool live_operator = false;  ///< Session::operate() may come: a hold does not end the run
  std::size_t warnings = 0;    ///< of the program: RunSummary::warnings
  /// What the run's command will answer to the shell: RunSummary::exit_code. None: 0.
  std::function<int(const log::RunSummary&)> exit_code;
};

/// How a program is run to its end.
struct RunOptions : SessionOptions {
  int threads = 1;                      ///< 1, or 2: the second encodes and writes; same bytes
  double until_s = machine::kInfinity;  ///< stop after that much machine time
  std::function<void(double done_fraction, std::uint32_t line, double sim_s)>
      progress;                                  ///< called about every 1000 ticks
  const std::atomic<bool>* interrupt = nullptr;  ///< set by a signal handler
};

/// I/O error that ended a run: its log could not be written.
struct RunFailure {
  std::string what;  ///< sentence for the user
};

/// Runs a prepared job to its end: a loop over a Session. Records go to `log` (may be null).
tl::expected<log::RunSummary, RunFailure> run(const Job& job, log::RunLog* log, const RunOptions& options);

}  // namespace kadr::cycle
