#include "emulator/cycle/operator_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "machine/file/tree.h"
#include "planner/laws/motion_source.h"

namespace kadr::emulator {
namespace {

/// First segment of the motion that a step names, or nothing.
std::optional<std::size_t> first_segment(const PathPlace& place, const planner::Path& path,
                                         std::uint32_t program) {
  int passes = 0;
  for (std::size_t i = 0; i < path.size(); i = path.block_end(i)) {
    const planner::PathSegment& s = path.segments[i];
    const bool here = place.kind == PathPlace::Kind::block
                          ? s.block == static_cast<std::uint32_t>(place.number)
                          : s.span.file == program && s.span.line == static_cast<std::uint32_t>(place.number);
    if (here && ++passes == place.pass) return i;
  }
  return {};
}

/// Path length s at a distance behind the beginning of a segment, the distance as feeds measure it.
std::optional<double> ahead_of(const planner::Path& path, std::size_t segment, double distance_u) {
  for (; segment < path.size(); ++segment) {
    const planner::PathSegment& s = path.segments[segment];
    if (distance_u <= s.feed_length_u)
      return path.start_s_u[segment] + s.length_u * (distance_u / s.feed_length_u);
    distance_u -= s.feed_length_u;
  }
  return {};
}

std::string wish(const PathPlace& place) {
  if (place.kind == PathPlace::Kind::block) return fmt::format("block {:.0f}", place.number);
  if (place.kind == PathPlace::Kind::line && place.pass > 1)
    return fmt::format("pass {} of line {:.0f}", place.pass, place.number);
  return place.kind == PathPlace::Kind::line ? fmt::format("line {:.0f}", place.number)
                                             : fmt::format("path length {:.6g}", place.number);
}

std::int64_t whole_ticks(double time_ms, double tau_s) {
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::floor(time_ms / (1000 * tau_s) + 0.5)));
}

EventRecord panel_event(Ticks tick, EventKind kind, double value, std::string text) {
  EventRecord e;
  e.tick = tick;
  e.kind = kind;
  e.value = value;
  e.text = std::move(text);
  return e;
}

}  // namespace

void place_on_path(Job& job, Diagnostics& diagnostics) {
  for (OperatorStep& step : job.operator_steps) {
    if (!step.place) continue;
    const PathPlace& place = *step.place;
    std::optional<std::size_t> segment = 0;
    double distance_u = place.after_u;
    if (place.kind == PathPlace::Kind::length)
      distance_u += place.number;
    else
      segment = first_segment(place, job.path, job.program);
    const auto path_u = segment ? ahead_of(job.path, *segment, distance_u) : std::nullopt;
    if (path_u) {
      step.path_u = *path_u;
      continue;
    }
    Diagnostic d = machine::file_diagnostic(
        Code::scenario_step, step.span,
        segment ? fmt::format("{} and {:.6g} after it is beyond the path", wish(place), place.after_u)
                : fmt::format("{} of the program starts no motion", wish(place)));
    d.notes.push_back(fmt::format("the program has {} motion blocks and a path of {:.6g}", job.blocks,
                                  job.path.length_u()));
    d.help = "kadr plan shows the lines that move";
    diagnostics.add(std::move(d));
  }
}

SpindleReactor::SpindleReactor(const machine::SpindleReaction& rule, double tau_s)
    : high_ticks_(whole_ticks(rule.high_ms, tau_s)),
      down_ticks_(whole_ticks(rule.down_ms, tau_s)),
      low_ticks_(whole_ticks(rule.low_ms, tau_s)),
      up_ticks_(whole_ticks(rule.up_ms, tau_s)),
      high_load_(rule.high_load_pct / 100),
      low_load_(rule.low_load_pct / 100),
      down_pct_(rule.down_pct),
      up_pct_(rule.up_pct),
      least_pct_(rule.least_pct) {}

double SpindleReactor::advance(double load) {
  high_ = load > high_load_ ? high_ + 1 : 0;
  low_ = load < low_load_ ? low_ + 1 : 0;
  if (high_ >= high_ticks_ && (high_ - high_ticks_) % down_ticks_ == 0)
    percent_ = std::max(std::min(least_pct_, percent_), percent_ - down_pct_);
  if (low_ >= low_ticks_ && (low_ - low_ticks_) % up_ticks_ == 0)
    percent_ = std::min(100.0, percent_ + up_pct_);
  return percent_ / 100;
}

bool SpindleReactor::unsettled(double load) const {
  return (load > high_load_ && percent_ > least_pct_) || (load < low_load_ && percent_ < 100);
}

OperatorPanel::OperatorPanel(const std::vector<OperatorStep>& steps, const machine::MachineModel& machine)
    : steps_(steps), machine_(machine), reactor_(machine.spindle, machine.clock.tau_s()) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].place)
      placed_.push_back(i);
    else
      timed_ = i + 1;
  }
}

const planner::OperatorInput& OperatorPanel::advance(ControlTicks tick, double s_u,
                                                     std::vector<EventRecord>& events) {
  const Ticks begin{tick.value * machine_.clock.control_tick.value};
  for (; next_ < timed_ && steps_[next_].tick <= tick; ++next_) take(steps_[next_], begin, events);
  if (!placed_.empty())
    placed_.erase(std::remove_if(placed_.begin(), placed_.end(),
                                 [&](std::size_t i) {
                                   if (steps_[i].path_u > s_u) return false;
                                   take(steps_[i], begin, events);
                                   return true;
                                 }),
                  placed_.end());
  const double before = spindle_percent_;
  spindle_percent_ = reactor_.advance(load_);
  if (spindle_percent_ != before)
    events.push_back(panel_event(
        begin, EventKind::spindle_override, spindle_percent_ * 100,
        fmt::format("spindle load {:.6g} %: feed at {:.6g} %", load_ * 100, spindle_percent_ * 100)));
  input_.feed_override = operator_percent_ * spindle_percent_;
  return input_;
}

void OperatorPanel::take(const OperatorStep& step, Ticks tick, std::vector<EventRecord>& events) {
  const double percent = step.value * 100;
  const auto tell = [&](EventKind kind, double value, std::string text) {
    events.push_back(panel_event(tick, kind, value, std::move(text)));
  };
  switch (step.action) {
    case OperatorAction::feed_override:
      operator_percent_ = step.value;
      return tell(EventKind::feed_override, percent, fmt::format("feed override {:.6g} %", percent));
    case OperatorAction::rapid_override:
      input_.rapid_override = step.value;
      return tell(EventKind::rapid_override, percent, fmt::format("rapid override {:.6g} %", percent));
    case OperatorAction::hold:
      input_.hold = true;
      return tell(EventKind::hold, 1, "feed hold");
    case OperatorAction::resume:
      input_.hold = false;
      return tell(EventKind::resume, 0, "feed goes on");
    case OperatorAction::spindle_load:
      load_ = step.value;
      return tell(EventKind::spindle_load, percent, fmt::format("spindle load {:.6g} %", percent));
    case OperatorAction::emergency_stop:
      input_.emergency_stop = true;
      return tell(EventKind::emergency_stop, 1, "emergency stop");
  }
}

bool OperatorPanel::at_its_end() const { return next_ == timed_ && !reactor_.unsettled(load_); }

double most_percent(const std::vector<OperatorStep>& steps) {
  double most = 1.0;
  for (const OperatorStep& step : steps)
    if (step.action == OperatorAction::feed_override) most = std::max(most, step.value);
  return most;
}

}  // namespace kadr::emulator
