#include <algorithm>
#include <cmath>
#include <utility>

#include "emulator/cycle/operator/place_on_path.h"
#include "emulator/cycle/place_limits.h"
#include "emulator/cycle/program_reader.h"
#include "emulator/cycle/soft_limits.h"
#include "emulator/emulator.h"
#include "machine/base/require.h"
#include "planner/planner.h"

namespace kadr::cycle {
namespace {

using gcode::Block;

gcode::InterpretOptions interpret_options(const JobInputs& given) {
  const machine::MachineModel& machine = given.machine.model;
  gcode::InterpretOptions options;
  static_cast<gcode::Reading&>(options) = given.reading;
  options.inches = machine.units == machine::StartUnits::inch;
  options.units_said = machine.units.has_value();
  options.startup = machine.startup;
  options.codes = machine.codes;
  options.axis_letters.clear();
  for (const machine::AxisModel& axis : machine.axis) {
    options.axis_letters += axis.letter;
    options.home[static_cast<std::size_t>(axis_index(axis.letter))] = axis.home_u;
  }
  options.g28 = options.home;
  options.g30 = machine.home2;
  options.approach = machine.approach;
  options.arc_end_tolerance_mm = machine.path.arc_end_tolerance_mm;
  options.arc_end_tolerance_relative = machine.path.arc_end_tolerance_relative;
  if (machine.stock)
    options.stock =
        gcode::StockPlane{axis_index(machine.stock->axis), machine.stock->position_mm, machine.stock->below};
  return options;
}

}  // namespace

double hold_time_s(const ProgramEvent& event, const machine::MachineModel& machine) {
  const auto* dwell = std::get_if<gcode::Dwell>(&event.block.action);
  const double wish_s = dwell != nullptr                            ? dwell->time_s
                        : gcode::is<gcode::InputWait>(event.block)  ? event.wait.waited_s
                        : gcode::is<gcode::ChangeTool>(event.block) ? machine.planner.tool_change_s
                                                                    : 0.0;
  if (!(wish_s > 0) || !machine.planner.whole_ticks) return std::max(wish_s, 0.0);
  const double tau_s = machine.clock.tau_s();
  // 1e-9: a dwell of whole ticks stays whole although it was read from decimals
  return std::ceil(wish_s / tau_s - 1e-9) * tau_s;
}

std::vector<planner::Pause> pauses(const std::vector<ProgramEvent>& events,
                                   const machine::MachineModel& machine) {
  std::vector<planner::Pause> pauses;
  for (const ProgramEvent& event : events)
    if (const double hold_s = hold_time_s(event, machine); hold_s > 0)
      pauses.push_back({event.after_segment, hold_s});
  return pauses;
}

std::optional<ReadProgram> lay_out(const JobInputs& given, SourceSet& sources, Diagnostics& diagnostics,
                                   SoftLimitRule soft_limits) {
  gcode::InterpretOptions options = interpret_options(given);
  ProgramReader reader(given, diagnostics, options.home);
  options.read_input = [&](const gcode::InputWait& wait) { return reader.read_input(wait); };
  const std::size_t known_files = sources.size();
  gcode::interpret(
      sources, given.program, options,
      [&](const Block& block) {
        if (!diagnostics.has_errors()) reader.take(block);
      },
      diagnostics);
  ReadProgram read = reader.finish();
  for (std::size_t file = known_files; file < sources.size(); ++file)
    read.called_files.push_back(static_cast<std::uint32_t>(file));
  if (diagnostics.has_errors()) return std::nullopt;
  const std::size_t errors = diagnostics.errors();
  limit_places(given.place_limits, read, diagnostics);
  if (diagnostics.errors() != errors) return std::nullopt;
  check_soft_limits(read.path, given.machine.model, soft_limits, diagnostics);
  return read;
}

std::optional<PlannedProgram> plan_program(const JobInputs& given, const SourceSet& sources,
                                           const ReadProgram& read, Diagnostics& diagnostics,
                                           const PlanFunction& plan_path) {
  const machine::MachineModel& machine = given.machine.model;
  const std::size_t errors = diagnostics.errors();
  PlannedProgram planned;
  planned.step_places_u =
      place_on_path(given.operator_steps, read.path, read.blocks, given.program, diagnostics);
  if (diagnostics.errors() != errors) return std::nullopt;
  const std::vector<planner::Pause> held = pauses(read.events, machine);
  auto plan = plan_path ? plan_path(read.path, machine, held) : planner::plan(read.path, machine, held);
  if (!plan) {
    diagnostics.add(plan.error().diagnostic);
    return std::nullopt;
  }
  require_sound_plan(given, sources, read, *plan);
  planned.plan = std::move(*plan);
  return planned;
}

std::optional<Job> prepare(const JobInputs& given, SourceSet& sources, Diagnostics& diagnostics,
                           SoftLimitRule soft_limits, const PlanFunction& plan) {
  auto read = lay_out(given, sources, diagnostics, soft_limits);
  if (!read) return std::nullopt;
  auto planned = plan_program(given, sources, *read, diagnostics, plan);
  if (!planned) return std::nullopt;
  return Job{sources, given, std::move(*read), std::move(*planned)};
}

BlockSummary block_summary(const planner::Path& path, const planner::FeedPlan& plan, std::size_t segment) {
  BlockSummary summary;
  summary.end_segment = path.block_end(segment);
  summary.begin_s = plan.segments[segment].begin_time_s;
  for (std::size_t i = segment; i < summary.end_segment; ++i) {
    const planner::PathSegment& s = path.segments[i];
    const planner::SegmentPlan& p = plan.segments[i];
    const double feed_per_s = s.feed_length_u / s.length_u;
    summary.length_u += s.feed_length_u;
    if (!s.rapid) summary.programmed_u_s = s.feed_u_s * feed_per_s;
    summary.end_u_s = p.end_u_s * feed_per_s;
    summary.time_s = p.end_time_s - summary.begin_s;
    if (i > segment && p.peak_u_s * feed_per_s <= summary.peak_u_s) continue;
    summary.peak_u_s = p.peak_u_s * feed_per_s;
    summary.limited_by = p.limited_by;
    summary.limiting_axis = p.limiting_axis;
  }
  return summary;
}

std::string limited_by_text(planner::LimitedBy reason, int axis, const machine::MachineModel& machine) {
  std::string text(planner::kLimitedBy.word(reason));
  if (axis < 0) return text;
  const char letter = machine.axis.at(static_cast<std::size_t>(axis)).letter;
  if (reason == planner::LimitedBy::axis_speed) return std::string("axis ") + letter + " speed";
  return text + " " + letter;
}

std::vector<log::LimitShare> limit_shares(const planner::MotionLaw& law,
                                          const machine::MachineModel& machine) {
  std::vector<log::LimitShare> shares;
  for (const planner::JerkPiece& piece : law.pieces) {
    const bool rest = piece.speed_u_s == 0 && piece.accel_u_s2 == 0 && piece.jerk_u_s3 == 0;
    const std::string name = rest ? "dwell" : limited_by_text(piece.limited_by, piece.limiting_axis, machine);
    auto it = std::find_if(shares.begin(), shares.end(),
                           [&](const log::LimitShare& s) { return s.limited_by == name; });
    if (it == shares.end()) it = shares.insert(shares.end(), log::LimitShare{name, 0.0});
    it->time_s += piece.duration_s;
  }
  std::stable_sort(shares.begin(), shares.end(),
                   [](const log::LimitShare& a, const log::LimitShare& b) { return a.time_s > b.time_s; });
  return shares;
}

}  // namespace kadr::cycle
