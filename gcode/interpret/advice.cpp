#include "gcode/interpret/advice.h"
#include "gcode/constants.h"

#include <fmt/format.h>

#include <cmath>

namespace kadr::gcode {
namespace {

constexpr double kLevel_mm = 1e-6;       // a move that goes down by less is level
constexpr double kSameLength_mm = 1e-3;  // of two tools
constexpr double kLongDwell_s = 100;     // P of another control's program is in milliseconds

constexpr std::uint64_t bit(BlockKind kind) { return std::uint64_t{1} << static_cast<unsigned>(kind); }

constexpr std::uint64_t kAlways = bit(BlockKind::spindle_clockwise) |
                                  bit(BlockKind::spindle_counterclockwise) | bit(BlockKind::spindle_stop) |
                                  bit(BlockKind::change_tool) | bit(BlockKind::dwell) |
                                  bit(BlockKind::probe) | bit(BlockKind::program_end);
constexpr std::uint64_t kMoves =
    bit(BlockKind::traverse) | bit(BlockKind::feed) | bit(BlockKind::arc) | bit(BlockKind::spline);

}  // namespace

Advice::Advice(const State& state, const InterpretOptions& options, Report& report)
    : state_(state),
      report_(report),
      seconds_(options.dialect == Dialect::linuxcnc),
      z_mm_(options.home[kZ]) {
  watch_moves();
}

/// Moves are looked at only while some rule waits for one: most programs are nothing but moves.
void Advice::watch_moves() {
  const bool spindle_rule = !spindle_runs_ && !probing_ && cut_.line == 0;
  wanted_ = spindle_rule || length_doubtful_ ? kAlways | kMoves : kAlways;
}

void Advice::look(const Block& block) {
  switch (block.kind) {
    case BlockKind::spindle_clockwise:
    case BlockKind::spindle_counterclockwise:
    case BlockKind::spindle_stop:
      spindle_block(block);
      break;
    case BlockKind::change_tool:
      tool_changed(block);
      break;
    case BlockKind::probe:
      probing_ = true;
      cut_ = {};
      break;
    case BlockKind::dwell:
      if (!seconds_ || block.dwell_s < kLongDwell_s) break;
      report_.warning(
          problem(Code::long_dwell, block.span, fmt::format("waits {} s", figure(block.dwell_s)),
                  fmt::format("if milliseconds were meant, write P{}", figure(block.dwell_s / 1000, 6))));
      break;
    case BlockKind::program_end:
      tell_cut_without_spindle();
      if (spindle_runs_) {
        report_.warning(problem(Code::spindle_left_running, spindle_began_,
                                fmt::format("started here, still running on line {}", block.span.line),
                                "end the program with M2 or M30, or stop the spindle with M5"));
      }
      break;
    case BlockKind::traverse:
    case BlockKind::feed:
    case BlockKind::arc:
    case BlockKind::spline:
    case BlockKind::rigid_tap:
    case BlockKind::set_feed_rate:
    case BlockKind::set_feed_mode:
    case BlockKind::set_path_mode:
    case BlockKind::spindle_speed:
    case BlockKind::mist_on:
    case BlockKind::mist_off:
    case BlockKind::flood_on:
    case BlockKind::flood_off:
    case BlockKind::sync_start:
    case BlockKind::sync_stop:
    case BlockKind::spindle_mode:
    case BlockKind::select_tool:
    case BlockKind::set_tool_number:
    case BlockKind::digital_output:
    case BlockKind::analog_output:
    case BlockKind::wait_input:
    case BlockKind::message:
    case BlockKind::program_stop:
    case BlockKind::optional_stop:
    case BlockKind::feed_override:
    case BlockKind::speed_override:
    case BlockKind::speed_point:
    case BlockKind::comment:
      move_block(block);
      break;
  }
  z_mm_ = block.end[kZ];
  watch_moves();
}

void Advice::spindle_block(const Block& block) {
  const bool runs = block.kind != BlockKind::spindle_stop;
  if (runs) {
    spindle_ran_ = true;
    spindle_began_ = block.span;
    tell_cut_without_spindle();
    probing_ = false;
  } else if (spindle_runs_) {
    spindle_stopped_ = block.span;
  }
  spindle_runs_ = runs;
}

void Advice::tool_changed(const Block& block) {
  // before the first start of the spindle nothing says yet that the program needs one
  if (spindle_ran_) tell_cut_without_spindle();
  probing_ = false;
  length_doubtful_ = state_.tools.find(block.number) != nullptr;
  length_in_force_ = state_.tool_offset;
}

void Advice::move_block(const Block& block) {
  const bool down = block.end[kZ] < z_mm_ - kLevel_mm;
  if (!down || (state_.uncertain.axes & (1U << kZ)) != 0) return;
  if (!spindle_runs_ && !probing_ && cut_.line == 0 && block.kind != BlockKind::traverse) cut_ = block.span;
  if (length_doubtful_) check_length(block);
}

void Advice::tell_cut_without_spindle() {
  if (cut_.line == 0 || !spindle_ran_) return;
  Diagnostic d = problem(Code::cut_without_spindle, cut_, "goes down at feed with the spindle stopped",
                         "start it with M3 and S before this line");
  if (spindle_stopped_.line > 0)
    d.notes.push_back(fmt::format("stopped on line {}", spindle_stopped_.line));
  else
    d.notes.push_back(fmt::format("first started on line {}", spindle_began_.line));
  report_.warning(std::move(d));
  cut_ = {};
}

/// The first move down after a tool change: whose length is in force?
void Advice::check_length(const Block& block) {
  length_doubtful_ = false;
  const Tool* tool = state_.tools.find(state_.tool_in_spindle);
  if (tool == nullptr || state_.tool_offset != length_in_force_) return;
  const double in_force_mm = length_in_force_[kZ];
  const double length_mm = tool->offset[kZ];
  if (std::fabs(length_mm - in_force_mm) < kSameLength_mm) return;
  Diagnostic d = problem(Code::length_of_other_tool, block.span,
                         fmt::format("goes down with length {} mm in force", figure(in_force_mm)),
                         "write G43 after the tool change, G49 if no length is intended");
  d.notes.push_back(
      fmt::format("tool T{} in the spindle is {} mm long (tool table)", tool->number, figure(length_mm)));
  report_.warning(std::move(d));
}

void Advice::way_to_reference(const AxisValues& from, const AxisValues& by, Span span) {
  const double down_mm = from[kZ] - by[kZ];
  if (down_mm <= kLevel_mm || (state_.uncertain.axes & (1U << kZ)) != 0) return;
  report_.warning(problem(Code::reference_by_below, span,
                          fmt::format("first goes down by {} mm, at the rapid rate", figure(down_mm)),
                          "go up directly: G91 G28 Z0 and then G90, or G53 G0 Z0"));
}

}  // namespace kadr::gcode
