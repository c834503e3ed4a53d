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

template <class... Actions>
constexpr std::uint64_t kinds() {
  return (bit(Actions::kKind) | ...);
}
constexpr std::uint64_t kAlways =
    kinds<SpindleClockwise, SpindleCounterclockwise, SpindleStop, ChangeTool, Dwell, Probe, ProgramEnd>();
constexpr std::uint64_t kMoves = kinds<Traverse, Feed, Arc, Spline>();

}  // namespace

Advice::Advice(const State& state, const InterpretOptions& options, Report& report)
    : state_(state),
      report_(report),
      seconds_(options.dialect == Dialect::linuxcnc),
      z_mm_(options.home[kZ]) {
  watch_moves();
}

/// Moves are checked only while some rule waits for one: most programs are nothing but moves.
void Advice::watch_moves() {
  const bool spindle_rule = !spindle_runs_ && !probing_ && cut_.line == 0;
  wanted_ = spindle_rule || length_doubtful_ ? kAlways | kMoves : kAlways;
}

void Advice::look(const Block& block) {
  if (const auto* change = std::get_if<ChangeTool>(&block.action)) {
    tool_changed(*change);
  } else if (const auto* dwell = std::get_if<Dwell>(&block.action)) {
    check_dwell(*dwell, block.span);
  } else if (is<SpindleStop>(block)) {
    if (spindle_runs_) spindle_stopped_ = block.span;
    spindle_runs_ = false;
  } else if (is<SpindleClockwise, SpindleCounterclockwise>(block)) {
    spindle_started(block.span);
  } else if (is<Probe>(block)) {
    probing_ = true;
    cut_ = {};
  } else if (is<ProgramEnd>(block)) {
    program_ended(block.span);
  } else if (const Move* move = move_of(block)) {
    check_move(*move, block);
  }
  watch_moves();
}

/// Keeps the height of the tool: a probe stops at its contact, a tap comes back to where it began.
void Advice::follow(const Block& block) {
  if (const auto* probe = std::get_if<Probe>(&block.action)) {
    z_mm_ = probe->contact[kZ];
  } else if (const Move* move = move_of(block); move != nullptr && block.kind() != BlockKind::rigid_tap) {
    z_mm_ = move->end[kZ];
  }
}

void Advice::check_dwell(const Dwell& dwell, Span span) {
  if (!seconds_ || dwell.by_machine || dwell.time_s < kLongDwell_s) return;
  report_.warning(
      problem(Code::long_dwell, span, fmt::format("waits {} s", figure(dwell.time_s)),
              fmt::format("if milliseconds were meant, write P{}", figure(dwell.time_s / 1000, 6))));
}

void Advice::program_ended(Span span) {
  tell_cut_without_spindle();
  if (!spindle_runs_) return;
  report_.warning(problem(Code::spindle_left_running, spindle_began_,
                          fmt::format("started here, still running on line {}", span.line),
                          "end the program with M2 or M30, or stop the spindle with M5"));
}

void Advice::spindle_started(Span span) {
  spindle_ran_ = spindle_runs_ = true;
  spindle_began_ = span;
  tell_cut_without_spindle();
  probing_ = false;
}

void Advice::tool_changed(const ChangeTool& change) {
  // before the first start of the spindle it is not known that the program needs one
  if (spindle_ran_) tell_cut_without_spindle();
  probing_ = false;
  length_doubtful_ = state_.tools.find(change.tool) != nullptr;
  length_in_force_ = state_.tool_offset;
}

void Advice::check_move(const Move& move, const Block& block) {
  const bool down = move.end[kZ] < z_mm_ - kLevel_mm;
  if (!down || (state_.uncertain.axes & (1U << kZ)) != 0) return;
  const bool rapid = is<Traverse>(block);
  if (!spindle_runs_ && !probing_ && cut_.line == 0 && !rapid) cut_ = block.span;
  if (length_doubtful_) check_length(block.span);
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
void Advice::check_length(Span span) {
  length_doubtful_ = false;
  const Tool* tool = state_.tools.find(state_.tool_in_spindle);
  if (tool == nullptr || state_.tool_offset != length_in_force_) return;
  const double in_force_mm = length_in_force_[kZ];
  const double length_mm = tool->offset[kZ];
  if (std::fabs(length_mm - in_force_mm) < kSameLength_mm) return;
  Diagnostic d = problem(Code::length_of_other_tool, span,
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
