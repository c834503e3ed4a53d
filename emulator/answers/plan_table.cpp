#include "emulator/answers/plan_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/answers/approach.h"
#include "emulator/answers/travel.h"
#include "emulator/cycle/program_event.h"
#include "emulator/text/text.h"
#include "machine/base/numbers.h"
#include "machine/words.h"
#include "planner/positioning/positioning.h"

namespace kadr::answers {
namespace {

constexpr std::size_t kTextWidth = 34;

std::size_t width_of(double largest, int decimals, std::size_t least) {
  return std::max(least, text::fixed(largest, decimals).size());
}

bool is_blockwise(const cycle::Job& job) {
  return job.given.machine.model.planner.scheduler == machine::SchedulerKind::blockwise;
}

/// Rule, kl and jump of a block of one or more segments: those furthest from none, 1 and 0.
void add_ticks(const cycle::Job& job, std::size_t first, std::size_t end, PlanRow& row) {
  row.blockwise = true;
  auto rule = planner::TickRule::none;
  for (std::size_t i = first; i < end; ++i) {
    const planner::SegmentPlan& plan = job.planned.plan.segments[i];
    const planner::PathSegment& segment = job.read.path.segments[i];
    rule = std::max(rule, plan.rule);
    row.kl = std::min(row.kl, plan.kl);
    const double jump_u_s = plan.end_jump_u_s * segment.feed_length_u / segment.length_u;
    if (std::fabs(jump_u_s) > std::fabs(row.end_jump_u_s)) row.end_jump_u_s = jump_u_s;
  }
  row.rule = planner::kTickRules.word(rule);
}

void add_rapid(const cycle::Job& job, const planner::PositionedSegment& rapid,
               planner::PositioningPlanner& planner, PlanRow& row) {
  row.positioned = true;
  row.rapid_law = machine::kRapidShapes.word(rapid.shape);
  row.rapid_reason = rapid.reason;
  row.rapid_loss_s = rapid.loss_s;
  const std::vector<machine::AxisModel>& axis = job.given.machine.model.axis;
  for (const planner::ExcitedMode& m : planner.excited(job.read.path, rapid.segment))
    row.vibrations.push_back({axis[static_cast<std::size_t>(m.axis)].letter,
                              m.driven.mode.omega_rad_s / (2 * kPi), m.driven.mode.zeta});
  for (std::size_t c = 0; c < axis.size(); ++c)
    if (axis[c].has_plant) row.residual_u.emplace_back(axis[c].letter, rapid.residual_u[c]);
}

/// "zv +0.025 s for X 45.00 Hz", and the remaining vibration unless it is zero.
std::string rapid_text(const PlanRow& row) {
  constexpr double kNothing_u = 5e-7;
  std::string out = fmt::format("; {} +{} s", row.rapid_law, text::fixed(row.rapid_loss_s, 3));
  for (std::size_t i = 0; i < row.vibrations.size(); ++i)
    out += fmt::format("{} {} {} Hz", i == 0 ? " for" : ",", row.vibrations[i].axis,
                       text::fixed(row.vibrations[i].hz, 2));
  for (const auto& [axis, residual_u] : row.residual_u)
    if (residual_u > kNothing_u)
      out += fmt::format(", {} swings {} um", axis, text::fixed(1e3 * residual_u, 1));
  return out;
}

/// What of the program makes the motion stop before segment `next`, other than a pause, which has a row of its own.
std::string stop_before(const cycle::Job& job, std::size_t next, std::size_t first_event) {
  if (next >= job.read.path.size()) return {};
  const std::vector<cycle::ProgramEvent>& events = job.read.events;
  for (std::size_t i = first_event; i < events.size() && events[i].after_segment <= next; ++i) {
    const bool here = events[i].after_segment == next && cycle::needs_rest(events[i].block);
    if (!here || cycle::hold_time_s(events[i], job.given.machine.model) > 0) continue;
    return fmt::format("{} (line {})", gcode::kBlockKinds.word(events[i].block.kind()),
                       events[i].block.span.line);
  }
  return {};
}

PlanRow approach_plan_row(const cycle::Job& job, const ApproachRow& approach) {
  PlanRow row;
  row.line = approach.line;
  row.text = job.sources[job.given.program].line(row.line);
  row.motion = gcode::kBlockKinds.word(gcode::BlockKind::approach);
  row.time_s = approach.time_s;
  row.ways = approach.ways;
  row.blockwise = is_blockwise(job);
  return row;
}

}  // namespace

void for_each_plan_row(const cycle::Job& job, const std::function<void(const PlanRow&)>& sink) {
  const machine::MachineModel& machine = job.given.machine.model;
  std::size_t next_event = 0;
  double time_s = 0;
  auto rapid = job.planned.plan.positioned.begin();
  planner::PositioningPlanner rapids(machine);
  const auto pauses_before = [&](std::size_t segment) {
    for (; next_event < job.read.events.size() && job.read.events[next_event].after_segment <= segment;
         ++next_event) {
      const gcode::Block& block = job.read.events[next_event].block;
      PlanRow row;
      row.time_s = cycle::hold_time_s(job.read.events[next_event], machine);
      if (!(row.time_s > 0)) continue;
      row.line = block.span.line;
      row.text = job.sources[block.span.file].line(row.line);
      row.motion = gcode::kBlockKinds.word(block.kind());
      row.begin_s = time_s;
      row.blockwise = is_blockwise(job);
      time_s += row.time_s;
      sink(row);
    }
  };
  if (const auto approach = approach_row(job)) {
    PlanRow row = approach_plan_row(job, *approach);
    time_s = row.time_s;
    sink(row);
  }
  const std::size_t begin = job.read.path.approach_size();
  while (rapid != job.planned.plan.positioned.end() && rapid->segment < begin) ++rapid;
  for (std::size_t i = begin; i < job.read.path.size();) {
    pauses_before(i);
    const planner::PathSegment& segment = job.read.path.segments[i];
    const cycle::BlockSummary block = cycle::block_summary(job.read.path, job.planned.plan, i);
    PlanRow row;
    row.line = segment.span.line;
    row.text = job.sources[segment.span.file].line(row.line);
    row.motion = planner::motion_name(segment);
    row.unit = segment_unit(job.read.path, i, machine);
    row.length_u = block.length_u;
    row.begin_s = block.begin_s;
    row.time_s = block.time_s;
    row.programmed_u_s = block.programmed_u_s;
    row.peak_u_s = block.peak_u_s;
    row.end_u_s = block.end_u_s;
    row.limited_by = cycle::limited_by_text(block.limited_by, block.limiting_axis, machine);
    row.stops_for = stop_before(job, block.end_segment, next_event);
    if (is_blockwise(job)) add_ticks(job, i, block.end_segment, row);
    if (rapid != job.planned.plan.positioned.end() && rapid->segment == i)
      add_rapid(job, *rapid++, rapids, row);
    time_s = block.begin_s + block.time_s;
    sink(row);
    i = block.end_segment;
  }
  pauses_before(job.read.path.size());
}

PlanTable::PlanTable(const cycle::Job& job)
    : blockwise_(is_blockwise(job)), unit_(path_unit(job.read.path, job.given.machine.model)) {
  double longest_u = 0, fastest_u_s = 0, slowest_s = 0;
  std::uint32_t last_line = 1;
  for_each_plan_row(job, [&](const PlanRow& row) {
    longest_u = std::max(longest_u, row.length_u);
    fastest_u_s = std::max({fastest_u_s, row.peak_u_s, row.programmed_u_s});
    slowest_s = std::max(slowest_s, row.time_s);
    last_line = std::max(last_line, row.line);
  });
  line_width_ = std::max<std::size_t>(4, std::to_string(last_line).size());
  length_width_ = width_of(longest_u, 3, head("length").size());
  time_width_ = width_of(slowest_s, 3, 6);
  speed_width_ = width_of(fastest_u_s, 3, head("peak", "/s").size());
}

std::string PlanTable::head(std::string_view name, std::string_view per) const {
  return mixed() ? std::string(name) : fmt::format("{} {}{}", name, unit_, per);
}

std::string PlanTable::title() const {
  return fmt::format("{}  {}  {}  {}  {}  {}  {}{}{}  limited by\n", text::pad_left("line", line_width_),
                     text::pad_right("text", kTextWidth), text::pad_left(head("length"), length_width_),
                     text::pad_left("time s", time_width_), text::pad_left(head("F", "/s"), speed_width_),
                     text::pad_left(head("peak", "/s"), speed_width_),
                     text::pad_left(head("end", "/s"), speed_width_),
                     blockwise_ ? "  rule      kl  " + text::pad_left(head("jump", "/s"), speed_width_) : "",
                     mixed() ? "  unit    " : "");
}

std::string PlanTable::row(const PlanRow& r) const {
  const bool pause = r.limited_by.empty();
  const auto number = [&](double value, std::size_t width) {
    return pause ? std::string(width, ' ') : text::pad_left(text::fixed(value, 3), width);
  };
  std::string out = fmt::format(
      "{}  {}  {}  {}  {}  {}  {}", text::pad_left(std::to_string(r.line), line_width_),
      text::pad_right(text::one_line(r.text, kTextWidth), kTextWidth), number(r.length_u, length_width_),
      text::pad_left(text::fixed(r.time_s, 3), time_width_),
      r.motion == "rapid" ? text::pad_left("rapid", speed_width_) : number(r.programmed_u_s, speed_width_),
      number(r.peak_u_s, speed_width_), number(r.end_u_s, speed_width_));
  if (blockwise_)
    out += fmt::format("  {:<4}  {:>6}  {}", r.rule, pause ? "" : text::fixed(r.kl, 4),
                       number(r.end_jump_u_s, speed_width_));
  if (mixed()) out += pause ? "          " : fmt::format("  {:<8}", fmt::format("{0} {0}/s", r.unit));
  out += "  " + (pause ? r.motion : r.limited_by);
  if (r.motion == gcode::kBlockKinds.word(gcode::BlockKind::approach)) out += ": " + ways_text(r.ways);
  if (!r.stops_for.empty()) out += "; stops for " + r.stops_for;
  if (r.positioned) out += rapid_text(r);
  return out + '\n';
}

std::string PlanTable::footer(const cycle::Job& job, std::size_t rows) const {
  const planner::Smoothing& smoothing = job.read.path.smoothing;
  std::string out = fmt::format(
      "{}, {}: {} in motion, {} standing\n", text::counted(static_cast<std::int64_t>(rows), "row"),
      text::duration_text(job.planned.plan.motion_s + job.planned.plan.pause_s),
      text::duration_text(job.planned.plan.motion_s), text::duration_text(job.planned.plan.pause_s));
  if (smoothing.corners > 0)
    out += fmt::format("G64 P: {} rounded, at most {} {} from the program\n",
                       text::counted(static_cast<std::int64_t>(smoothing.corners), "corner"),
                       text::fixed(smoothing.corner_deviation_u, 4), unit_);
  if (smoothing.curves > 0)
    out += fmt::format("G64 P: {} lines became curves through their points, at most {} {} from the program\n",
                       text::grouped(static_cast<std::int64_t>(smoothing.curves)),
                       text::fixed(smoothing.curve_deviation_u, 4), unit_);
  return out;
}

std::string plan_csv_title(const machine::MachineModel& machine) {
  const bool blockwise = machine.planner.scheduler == machine::SchedulerKind::blockwise;
  const bool rapids = machine.planner.rapid_law != machine::RapidShape::scurve;
  return fmt::format(
      "line,motion,unit,length_u,begin_s,time_s,programmed_u_s,peak_u_s,end_u_s,limited_by,{}{}text\n",
      blockwise ? "rule,kl,end_jump_u_s," : "", rapids ? "rapid_law,rapid_loss_s," : "");
}

std::string plan_csv_row(const PlanRow& row, const machine::MachineModel& machine) {
  std::string quoted;
  for (const char c : row.text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  const std::string ticks =
      row.blockwise ? fmt::format("{},{},{},", row.rule, row.kl, row.end_jump_u_s) : std::string();
  std::string rapid;
  if (machine.planner.rapid_law != machine::RapidShape::scurve)
    rapid = row.positioned ? fmt::format("{},{},", row.rapid_law, row.rapid_loss_s) : ",,";
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{}{}\"{}\"\n", row.line, row.motion, row.unit,
                     row.length_u, row.begin_s, row.time_s, row.programmed_u_s, row.peak_u_s, row.end_u_s,
                     row.limited_by, ticks, rapid, quoted);
}

}  // namespace kadr::answers
