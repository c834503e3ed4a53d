#include "emulator/cycle/operator/operator_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace kadr::cycle {

namespace {

/// Below 0.01 % the path all but stands, and a run would take ten thousand times as long as its plan: such an override
/// is a standstill, as 0 is.
constexpr double kLeastOverride = 1e-4;

double or_standstill(double override) { return override < kLeastOverride ? 0.0 : override; }

}  // namespace

OperatorPanel::OperatorPanel(const std::vector<OperatorStep>& steps, std::vector<double> places_u,
                             const machine::MachineModel& machine, EventList& events)
    : steps_(steps),
      places_u_(std::move(places_u)),
      machine_(machine),
      events_(events),
      reactor_(machine.spindle, machine.clock.tau_s()) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].place)
      placed_.push_back(i);
    else
      timed_ = i + 1;
  }
  std::stable_sort(placed_.begin(), placed_.end(),
                   [&](std::size_t a, std::size_t b) { return places_u_[a] < places_u_[b]; });
}

const planner::OperatorInput& OperatorPanel::advance(ControlTicks tick, double s_u) {
  const Ticks begin{tick.value * machine_.clock.control_tick.value};
  for (; next_ < timed_ && steps_[next_].tick <= tick; ++next_) take(steps_[next_], begin);
  for (const OperatorStep& step : live_) take(step, begin);
  live_.clear();
  // those of one control tick in the order of the timeline
  const std::size_t reached = next_placed_;
  while (next_placed_ < placed_.size() && places_u_[placed_[next_placed_]] <= s_u) ++next_placed_;
  const auto first = placed_.begin() + static_cast<std::ptrdiff_t>(reached);
  const auto last = placed_.begin() + static_cast<std::ptrdiff_t>(next_placed_);
  std::sort(first, last);
  std::for_each(first, last, [&](std::size_t i) { take(steps_[i], begin); });
  const double before = spindle_override_;
  spindle_override_ = reactor_.advance(load_);
  if (spindle_override_ != before)
    tell(begin, log::EventKind::spindle_override, spindle_override_ * 100,
         fmt::format("spindle load {:.6g} %: feed at {:.6g} %", load_ * 100, spindle_override_ * 100));
  input_.feed_override = or_standstill(operator_override_ * spindle_override_);
  return input_;
}

void OperatorPanel::take(const OperatorStep& step, Ticks tick) {
  const double percent = step.value * 100;
  switch (step.action) {
    case OperatorAction::feed_override:
      operator_override_ = step.value;
      return tell(tick, log::EventKind::feed_override, percent,
                  fmt::format("feed override {:.6g} %", percent));
    case OperatorAction::rapid_override:
      input_.rapid_override = or_standstill(step.value);
      return tell(tick, log::EventKind::rapid_override, percent,
                  fmt::format("rapid override {:.6g} %", percent));
    case OperatorAction::hold:
      input_.hold = true;
      return tell(tick, log::EventKind::hold, 1, "feed hold");
    case OperatorAction::resume:
      input_.hold = false;
      return tell(tick, log::EventKind::resume, 0, "feed goes on");
    case OperatorAction::spindle_load:
      load_ = step.value;
      return tell(tick, log::EventKind::spindle_load, percent, fmt::format("spindle load {:.6g} %", percent));
    case OperatorAction::emergency_stop:
      input_.emergency_stop = true;
      return tell(tick, log::EventKind::emergency_stop, 1, "emergency stop");
  }
}

void OperatorPanel::tell(Ticks tick, log::EventKind kind, double value, std::string text) {
  log::EventRecord e;
  e.tick = tick;
  e.kind = kind;
  e.value = value;
  e.text = std::move(text);
  events_.append(std::move(e));
}

bool OperatorPanel::at_its_end() const {
  return next_ == timed_ && live_.empty() && !reactor_.unsettled(load_);
}

double most_override(const std::vector<OperatorStep>& steps) {
  double most = 1.0;
  for (const OperatorStep& step : steps)
    if (step.action == OperatorAction::feed_override) most = std::max(most, step.value);
  return most;
}

}  // namespace kadr::cycle
