#include "emulator/cycle/program_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "emulator/cycle/program_event.h"

namespace kadr::emulator {
namespace {

using gcode::Block;
using gcode::BlockKind;

Diagnostic warning(Code code, const Block& block, std::string label, std::string help) {
  return {code, Severity::warning, block.span, std::string(code_entry(code).title), std::move(label),
          {},   std::move(help)};
}

}  // namespace

ProgramReader::ProgramReader(Job& job, Diagnostics& diagnostics, const AxisValues& home)
    : job_(job), diagnostics_(diagnostics), builder_(job.machine.model, home) {
  job_.events.clear();
  job_.blocks = 0;
  for (LineLimit& point : job_.line_limits) point.met = false;
}

void ProgramReader::take(const Block& block) {
  if (planner::is_motion(block.kind))
    take_motion(block);
  else if (block.kind == BlockKind::speed_point)
    builder_.limit_speed(block.value);
  else if (is_event(block))
    take_event(block);
}

void ProgramReader::take_motion(const Block& block) {
  const std::uint32_t number = builder_.blocks();
  for (LineLimit& point : job_.line_limits) {
    if (point.met || point.line != block.span.line || block.span.file != job_.program) continue;
    builder_.limit_speed(point.max_u_s);
    point.met = true;
  }
  const bool moves = builder_.add(block);
  ++job_.blocks;
  moved_by_angle_ = sync_by_angle_;
  if (moves) {
    for (const Block& output : outputs_) job_.events.push_back({output, number});
    outputs_.clear();
  }
  if (block.kind == BlockKind::probe) add_event(block);
}

void ProgramReader::take_event(const Block& block) {
  if (waits_for_motion(block)) return keep_output(block);
  if (block.kind == BlockKind::wait_input) return take_wait(block);
  if (block.kind == BlockKind::sync_start) {
    sync_by_angle_ = true;
    // a thread begins at rest, where the spindle's index is waited for; one that goes on does not stop
    if (!moved_by_angle_) builder_.stop();
  }
  if (block.kind == BlockKind::sync_stop) sync_by_angle_ = false;
  builder_.follow_spindle(sync_by_angle_);
  if (needs_rest(block)) builder_.stop();
  add_event(block);
}

void ProgramReader::take_wait(Block block) {
  WaitOutcome outcome;
  if (for_block_) {
    outcome = *for_block_;
    for_block_.reset();
  } else {
    outcome = begin_wait(block.wait);
    for_program_ = outcome;
  }
  block.value = outcome.value;
  block.on = outcome.reached;
  block.dwell_s = outcome.waited_s;
  add_event(block);
  if (outcome.reached) return;
  const std::string input =
      fmt::format("{} input {}", block.wait.analog ? "analog" : "digital", block.wait.number);
  diagnostics_.add(warning(
      Code::wait_timed_out, block,
      fmt::format("{} read {:.6g} for {:.6g} s; #5399 is -1", input, outcome.value, block.wait.timeout_s),
      fmt::format("a scenario sets it: [[step]] at_s = 1.5 {} = {} value = 1",
                  block.wait.analog ? "analog_input" : "input", block.wait.number)));
}

gcode::InputReading ProgramReader::read_input(const gcode::InputWait& wait) {
  WaitOutcome outcome;
  if (for_program_) {
    outcome = *for_program_;
    for_program_.reset();
  } else {
    outcome = begin_wait(wait);
    for_block_ = outcome;
  }
  return {outcome.reached, outcome.value};
}

WaitOutcome ProgramReader::begin_wait(const gcode::InputWait& wait) {
  // nothing moves after an error: what is waited for does not matter any more
  if (diagnostics_.has_errors()) return {true, 0, 0};
  builder_.stop();
  return wait_for(wait, time_so_far_s(), job_.inputs, job_.machine.model.clock.tau_s());
}

double ProgramReader::time_so_far_s() {
  const machine::MachineModel& machine = job_.machine.model;
  // a path that can't be planned is told when all of it is planned
  time_s_ += planner::motion_time_s(builder_.path(), machine, timed_segments_).value_or(0.0);
  timed_segments_ = builder_.path().size();
  for (; timed_events_ < job_.events.size(); ++timed_events_)
    time_s_ += hold_time_s(job_.events[timed_events_].block, machine);
  return time_s_;
}

void ProgramReader::keep_output(const Block& block) {
  const bool analog = block.kind == BlockKind::analog_output;
  for (const machine::TechnologyRule& rule : job_.machine.model.technology)
    if (rule.analog == analog && rule.number == block.number && (analog || rule.on == block.on))
      builder_.limit_speed(rule.max_u_s);
  // the last setting of an output is the one that the next motion takes along
  const auto same = [&](const Block& other) {
    return other.kind == block.kind && other.number == block.number;
  };
  outputs_.erase(std::remove_if(outputs_.begin(), outputs_.end(), same), outputs_.end());
  outputs_.push_back(block);
}

/// The place of an event is the number of the motion block that follows, until place_events().
void ProgramReader::add_event(const Block& block) { job_.events.push_back({block, builder_.blocks()}); }

/// From motion blocks to segments: a block may have none, or several.
void ProgramReader::place_events() {
  const std::vector<planner::PathSegment>& segments = job_.path.segments;
  std::size_t segment = 0;
  for (ProgramEvent& event : job_.events) {
    while (segment < segments.size() && segments[segment].block < event.after_segment) ++segment;
    event.after_segment = segment;
  }
}

void ProgramReader::finish() {
  for (const LineLimit& point : job_.line_limits)
    if (!point.met)
      diagnostics_.add({Code::scenario_technology,
                        Severity::error,
                        point.span,
                        std::string(code_entry(Code::scenario_technology).title),
                        fmt::format("no motion begins on line {}", point.line),
                        {},
                        "name the line of a move"});
  for (const Block& output : outputs_)
    diagnostics_.add(warning(Code::output_without_motion, output, "no motion follows: it never changes",
                             "M64, M65 and M68 change an output at once"));
  outputs_.clear();
  job_.path = builder_.take();
  place_events();
}

}  // namespace kadr::emulator
