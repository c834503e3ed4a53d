#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gcode/flow/flow.h"

/// Loops of O words, with the marks that LinuxCNC keeps: it skips lines in search of a label and has one
/// mark for break, one for continue and one count for each repeat, which outlive their loop in some programs.
/// kadr does the same, and reports it.
namespace kadr::gcode {

bool Flow::count_pass(Span beginning) {
  const std::uint64_t most = options_.bounds.loop_passes;
  if (++passes_ <= most || most == 0) return true;
  Diagnostic d =
      problem(Code::loop_too_long, beginning, fmt::format("pass {} of the program's loops", passes_),
              "check the condition and what changes it");
  d.notes.push_back(fmt::format("allowed: {} in all (--limit loop_passes=N)", most));
  error(std::move(d));
  stopped_ = true;
  return false;
}

void Flow::warn_kept(int index, std::string label, std::string cause) {
  Diagnostic d = problem(Code::loop_mark_kept, at(index).span, std::move(label),
                         "end loops by their condition only, or use loops of one kind");
  d.notes.push_back(std::move(cause));
  report_.warning(std::move(d));
}

/// A break of that loop counts even if it is only skipped, on the way to the loop's end.
void Flow::pass_over_breaks(int from, int loop) {
  if (at(loop).last_break > from) break_kept_ = true;
}

void Flow::while_head(const Line& line, int index) {
  double condition = 0;
  const bool known = argument(line, condition);
  if (known && condition != 0) {
    count_pass(index);
    return;
  }
  if (!known) interpreter_.lose_track();
  pass_over_breaks(index, index);
  continue_kept_ = false;
  leave_loop(index);
}

void Flow::do_foot(const Line& line, int index) {
  double condition = 0;
  const bool known = argument(line, condition);
  if (!known || (condition != 0 && report_.errors() > 0)) interpreter_.lose_track();
  const bool again = known && condition != 0 && report_.errors() == 0;
  if (again && !break_kept_) return unit_->program.go_to(at(at(index).begin).at);
  if (again) {
    warn_kept(index, "the loop ends here although its condition holds",
              "a break reached or passed over since the last do loop still counts");
  }
  break_kept_ = false;
}

void Flow::break_loop(int index) {
  const int loop = at(index).begin;
  break_kept_ = at(loop).word != FlowWord::do_once;
  if (break_kept_ && continue_kept_ && report_.errors() == 0) {
    continue_kept_ = false;
    warn_kept(index, "the loop continues although it should be left here",
              "a continue of a do loop before this loop still counts");
    return next_pass(loop);
  }
  leave_loop(loop);
}

void Flow::continue_loop(int index) {
  const int loop = at(index).begin;
  pass_over_breaks(index, loop);
  continue_kept_ = at(loop).word == FlowWord::do_once;
  next_pass(loop);
}

void Flow::next_pass(int loop) {
  // after an error nothing moves: one pass reports everything, and what follows the loop begins elsewhere
  if (report_.errors() > 0) {
    interpreter_.lose_track();
    return leave_loop(loop);
  }
  const Statement& s = at(loop);
  unit_->program.go_to(s.word == FlowWord::do_once ? at(s.end).at : s.at);
}

void Flow::leave_loop(int loop) { unit_->program.go_to(at(at(loop).end).after); }

void Flow::repeat(const Line& line, int index) {
  std::int64_t& left = unit_->passes_left[static_cast<std::size_t>(index)];
  const bool goes_on = repeat_gone_back_to_ == index;
  repeat_gone_back_to_ = -1;
  if (!goes_on && left != kNoPasses) {
    warn_kept(index, fmt::format("passes left from before: {}", left),
              "a return or an outer continue has left this repeat before its last pass");
  }
  if (left == kNoPasses) {
    double wanted = 0;
    if (!argument(line, wanted)) {
      interpreter_.lose_track();
      return leave_loop(index);
    }
    const double most = 9e18;
    // 0.5 is no pass, 1.5 is two: rounded to even
    left = static_cast<std::int64_t>(std::clamp(std::nearbyint(wanted), 0.0, most));
  }
  if (left > 0) {
    --left;
    count_pass(index);
    return;
  }
  left = kNoPasses;
  if (!continue_kept_ || report_.errors() > 0) return leave_loop(index);
  continue_kept_ = false;
  warn_kept(index, "the loop starts again after its last pass",
            "a continue of a do loop before it still counts");
  unit_->program.go_to(at(index).at);
}

void Flow::repeat_end(int index) {
  const int first = at(index).begin;
  if (report_.errors() > 0) {
    std::int64_t& left = unit_->passes_left[static_cast<std::size_t>(first)];
    if (left > 0) interpreter_.lose_track();
    left = kNoPasses;
    return;
  }
  repeat_gone_back_to_ = first;
  unit_->program.go_to(at(first).at);
}

}  // namespace kadr::gcode
