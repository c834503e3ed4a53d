#include "emulator/cycle/program_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "emulator/cycle/program_event.h"

namespace kadr::cycle {
namespace {

using gcode::Block;

Diagnostic warning(Code code, const Block& block, std::string label, std::string help) {
  return {code, Severity::warning, block.span, std::string(code_entry(code).title), std::move(label),
          {},   std::move(help)};
}

/// @pre waits_for_motion(block)
int output_number(const Block& block) {
  const auto* digital = std::get_if<gcode::DigitalOutput>(&block.action);
  return digital != nullptr ? digital->number : std::get<gcode::AnalogOutput>(block.action).number;
}

}  // namespace

ProgramReader::ProgramReader(const JobInputs& given, Diagnostics& diagnostics, const AxisValues& home)
    : given_(given),
      diagnostics_(diagnostics),
      builder_(given.machine.model, home),
      line_limits_met_(given.line_limits.size()) {}

void ProgramReader::take(const Block& block) {
  if (gcode::is_move(block))
    take_motion(block);
  else if (const auto* point = std::get_if<gcode::SpeedPoint>(&block.action))
    builder_.limit_speed(point->max_u_s);
  else if (is_event(block))
    take_event(block);
}

void ProgramReader::take_motion(const Block& block) {
  if (gcode::is<gcode::Approach>(block)) return take_approach(block);
  const std::uint32_t number = builder_.blocks();
  for (std::size_t i = 0; i < given_.line_limits.size(); ++i) {
    const LineLimit& point = given_.line_limits[i];
    if (line_limits_met_[i] || point.line != block.span.line || block.span.file != given_.program) continue;
    builder_.limit_speed(point.max_u_s);
    line_limits_met_[i] = true;
  }
  const bool moves = builder_.add(block);
  ++blocks_;
  moved_by_angle_ = sync_by_angle_;
  if (moves) {
    for (const Block& output : outputs_) events_.push_back({output, number});
    outputs_.clear();
  }
  if (gcode::is<gcode::Probe>(block)) add_event(block);
}

void ProgramReader::take_approach(const Block& block) {
  // waits before it took no time, and have no block
  for_block_.reset();
  builder_.add(block);
  approach_ = block;
}

void ProgramReader::take_event(const Block& block) {
  if (waits_for_motion(block)) return keep_output(block);
  if (const auto* wait = std::get_if<gcode::InputWait>(&block.action)) return take_wait(block, *wait);
  if (gcode::is<gcode::SyncStart>(block)) {
    sync_by_angle_ = true;
    // a thread begins at rest, waiting for the spindle's index; one that continues does not stop
    if (!moved_by_angle_) builder_.stop();
  }
  if (gcode::is<gcode::SyncStop>(block)) sync_by_angle_ = false;
  builder_.follow_spindle(sync_by_angle_);
  if (needs_rest(block)) builder_.stop();
  add_event(block);
}

void ProgramReader::take_wait(const Block& block, const gcode::InputWait& wait) {
  WaitOutcome outcome;
  if (for_block_) {
    outcome = *for_block_;
    for_block_.reset();
  } else {
    outcome = begin_wait(wait);
    for_program_ = outcome;
  }
  events_.push_back({block, builder_.blocks(), outcome});
  if (outcome.reached) return;
  const std::string input = fmt::format("{} input {}", wait.analog ? "analog" : "digital", wait.number);
  diagnostics_.add(
      warning(Code::wait_timed_out, block,
              fmt::format("{} read {:.6g} for {:.6g} s; #5399 is -1", input, outcome.value, wait.timeout_s),
              fmt::format("a scenario sets it: [[step]] at_s = 1.5 {} = {} value = 1",
                          wait.analog ? "analog_input" : "input", wait.number)));
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
  // nothing moves after an error: waits don't matter any more
  if (diagnostics_.has_errors()) return {true, 0, 0};
  builder_.stop();
  return wait_for(wait, time_so_far_s(), given_.inputs, given_.machine.model.clock.tau_s());
}

double ProgramReader::time_so_far_s() {
  const machine::MachineModel& machine = given_.machine.model;
  // a path that can't be planned is reported when all of it is planned
  time_s_ += planner::motion_time_s(builder_.path(), machine, timed_segments_).value_or(0.0);
  timed_segments_ = builder_.path().size();
  for (; timed_events_ < events_.size(); ++timed_events_)
    time_s_ += hold_time_s(events_[timed_events_], machine);
  return time_s_;
}

void ProgramReader::keep_output(const Block& block) {
  const auto* digital = std::get_if<gcode::DigitalOutput>(&block.action);
  const int number = output_number(block);
  for (const machine::TechnologyRule& rule : given_.machine.model.technology)
    if (rule.number == number && rule.analog == (digital == nullptr) && (!digital || rule.on == digital->on))
      builder_.limit_speed(rule.max_u_s);
  // the last setting of an output is the one that the next motion takes along
  const auto same = [&](const Block& other) {
    return other.kind() == block.kind() && output_number(other) == number;
  };
  outputs_.erase(std::remove_if(outputs_.begin(), outputs_.end(), same), outputs_.end());
  outputs_.push_back(block);
}

/// The position of an event is the number of the motion block that follows, until place_events().
void ProgramReader::add_event(const Block& block) { events_.push_back({block, builder_.blocks()}); }

/// From motion blocks to segments: a block may have none, or several.
void ProgramReader::place_events(const planner::Path& path) {
  const std::vector<planner::PathSegment>& segments = path.segments;
  std::size_t segment = 0;
  for (ProgramEvent& event : events_) {
    while (segment < segments.size() && segments[segment].block < event.after_segment) ++segment;
    event.after_segment = segment;
  }
}

ReadProgram ProgramReader::finish() {
  for (std::size_t i = 0; i < given_.line_limits.size(); ++i)
    if (!line_limits_met_[i])
      diagnostics_.add({Code::scenario_technology,
                        Severity::error,
                        given_.line_limits[i].span,
                        std::string(code_entry(Code::scenario_technology).title),
                        fmt::format("no motion begins on line {}", given_.line_limits[i].line),
                        {},
                        "name the line of a move"});
  for (const Block& output : outputs_)
    diagnostics_.add(warning(Code::output_without_motion, output, "no motion follows: it never changes",
                             "M64, M65 and M68 change an output at once"));
  outputs_.clear();
  planner::Path path = builder_.take();
  place_events(path);
  return {std::move(path), std::move(events_), blocks_, {}, std::move(approach_)};
}

}  // namespace kadr::cycle
