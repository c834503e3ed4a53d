#include <algorithm>
#include <cmath>
#include <utility>

#include "emulator/cycle/soft_limits.h"
#include "emulator/emulator.h"
#include "machine/base/require.h"

namespace kadr::emulator {
namespace {

using gcode::Block;
using gcode::BlockKind;

bool is_motion(BlockKind kind) {
  return kind == BlockKind::traverse || kind == BlockKind::feed || kind == BlockKind::arc;
}

/// Events at which the machine stands still: it waits for spindle, coolant or operator.
bool needs_rest(BlockKind kind) {
  switch (kind) {
    case BlockKind::dwell:
    case BlockKind::spindle_clockwise:
    case BlockKind::spindle_counterclockwise:
    case BlockKind::spindle_stop:
    case BlockKind::mist_on:
    case BlockKind::mist_off:
    case BlockKind::flood_on:
    case BlockKind::flood_off:
    case BlockKind::change_tool:
    case BlockKind::program_stop:
    case BlockKind::optional_stop:
    case BlockKind::program_end:
      return true;
    default:
      return false;
  }
}

/// Modal settings are in force in each motion block already; they are no events.
bool is_event(BlockKind kind) {
  return needs_rest(kind) || kind == BlockKind::spindle_speed || kind == BlockKind::select_tool ||
         kind == BlockKind::message || kind == BlockKind::feed_override || kind == BlockKind::speed_override;
}

gcode::InterpretOptions interpret_options(const Job& job) {
  const machine::MachineModel& machine = job.machine.model;
  gcode::InterpretOptions options;
  options.tools = job.tools;
  options.dialect = job.dialect;
  options.axis_letters.clear();
  for (const machine::AxisModel& axis : machine.axis) {
    options.axis_letters += axis.letter;
    options.home[static_cast<std::size_t>(axis_index(axis.letter))] = axis.home_u;
  }
  options.g28 = options.home;
  options.g30 = machine.home2;
  options.arc_end_tolerance_mm = machine.path.arc_end_tolerance_mm;
  options.arc_end_tolerance_relative = machine.path.arc_end_tolerance_relative;
  return options;
}

/// Puts the standstills of dwells and tool changes into the law, and shifts all that comes after.
void insert_pauses(Job& job) {
  planner::FeedPlan& plan = job.plan;
  std::vector<planner::JerkPiece> pieces;
  pieces.reserve(plan.law.pieces.size() + job.events.size());
  std::size_t next_piece = 0, next_segment = 0;
  double shift_s = 0;
  const auto shift_segments = [&](std::size_t end) {
    for (; next_segment < end; ++next_segment) {
      plan.segments[next_segment].begin_time_s += shift_s;
      plan.segments[next_segment].end_time_s += shift_s;
    }
  };
  const auto copy_piece = [&] {
    pieces.push_back(plan.law.pieces[next_piece++]);
    pieces.back().begin_s += shift_s;
  };
  for (const ProgramEvent& event : job.events) {
    const double hold_s = hold_time_s(event.block, job.machine.model);
    if (!(hold_s > 0)) continue;
    const double at_u = job.path.size() == 0 ? 0.0 : job.path.start_s_u[event.after_segment];
    shift_segments(event.after_segment);
    // the run that starts at this joint begins with a piece at rest there
    const double slack_u = 1e-9 * (1.0 + at_u);
    while (next_piece < plan.law.pieces.size() &&
           !(plan.law.pieces[next_piece].s_u >= at_u - slack_u && plan.law.pieces[next_piece].speed_u_s == 0))
      copy_piece();
    planner::JerkPiece pause;
    pause.begin_s = pieces.empty() ? 0.0 : pieces.back().begin_s + pieces.back().duration_s;
    pause.duration_s = hold_s;
    pause.s_u = at_u;
    pause.limited_by = planner::LimitedBy::stop;
    pieces.push_back(pause);
    shift_s += hold_s;
  }
  if (shift_s == 0) return;
  while (next_piece < plan.law.pieces.size()) copy_piece();
  shift_segments(plan.segments.size());
  plan.law.pieces = std::move(pieces);
  plan.law.duration_s += shift_s;
  job.dwell_s = shift_s;
}

}  // namespace

double hold_time_s(const Block& block, const machine::MachineModel& machine) {
  const double wish_s = block.kind == BlockKind::dwell         ? block.dwell_s
                        : block.kind == BlockKind::change_tool ? machine.planner.tool_change_s
                                                               : 0.0;
  if (!(wish_s > 0) || !machine.planner.whole_ticks) return std::max(wish_s, 0.0);
  const double tau_s = machine.clock.tau_s();
  // 1e-9: a dwell of whole ticks stays what it is although it was read from decimals
  return std::ceil(wish_s / tau_s - 1e-9) * tau_s;
}

bool prepare(Job& job, Diagnostics& diagnostics, SoftLimitRule soft_limits) {
  const machine::MachineModel& machine = job.machine.model;
  const gcode::InterpretOptions options = interpret_options(job);
  planner::PathBuilder builder(machine, options.home);
  job.events.clear();
  job.blocks = 0;
  gcode::interpret(
      job.sources, job.program, options,
      [&](const Block& block) {
        if (diagnostics.has_errors()) return;
        if (is_motion(block.kind)) {
          builder.add(block);
          ++job.blocks;
        } else if (is_event(block.kind)) {
          if (needs_rest(block.kind)) builder.stop();
          job.events.push_back({block, builder.path().size()});
        }
      },
      diagnostics);
  if (diagnostics.has_errors()) return false;
  job.path = builder.take();
  check_soft_limits(job.path, machine, soft_limits, diagnostics);

  auto plan = planner::plan(job.path, machine);
  if (!plan) {
    diagnostics.add(plan.error().diagnostic);
    return false;
  }
  job.plan = std::move(*plan);
  job.motion_s = job.plan.law.duration_s;
  job.dwell_s = 0;
  insert_pauses(job);
  return true;
}

std::string limited_by_text(planner::LimitedBy reason, int axis, const machine::MachineModel& machine) {
  std::string text(planner::limited_by_name(reason));
  if (axis < 0) return text;
  const char letter = machine.axis.at(static_cast<std::size_t>(axis)).letter;
  if (reason == planner::LimitedBy::axis_speed) return std::string("axis ") + letter + " speed";
  return text + " " + letter;
}

std::vector<LimitShare> limit_shares(const Job& job) {
  std::vector<LimitShare> shares;
  for (const planner::JerkPiece& piece : job.plan.law.pieces) {
    const bool rest = piece.speed_u_s == 0 && piece.accel_u_s2 == 0 && piece.jerk_u_s3 == 0;
    const std::string name =
        rest ? "dwell" : limited_by_text(piece.limited_by, piece.limiting_axis, job.machine.model);
    auto it =
        std::find_if(shares.begin(), shares.end(), [&](const LimitShare& s) { return s.limited_by == name; });
    if (it == shares.end()) it = shares.insert(shares.end(), LimitShare{name, 0.0});
    it->time_s += piece.duration_s;
  }
  std::stable_sort(shares.begin(), shares.end(),
                   [](const LimitShare& a, const LimitShare& b) { return a.time_s > b.time_s; });
  return shares;
}

}  // namespace kadr::emulator
