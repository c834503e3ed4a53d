#include "emulator/cycle/input_timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "emulator/cycle/tick_time.h"

namespace kadr::cycle {
namespace {

/// Times are decimals and whole ticks: closer than this is the same moment.
constexpr double kSameMoment_s = 1e-9;

bool holds(gcode::WaitMode mode, bool before, bool now) {
  switch (mode) {
    case gcode::WaitMode::rise:
      return now && !before;
    case gcode::WaitMode::fall:
      return before && !now;
    case gcode::WaitMode::high:
      return now;
    case gcode::WaitMode::low:
      return !now;
    case gcode::WaitMode::immediate:
      return true;
  }
  return true;
}

}  // namespace

WaitOutcome wait_for(const gcode::InputWait& wait, double begin_s, const std::vector<InputStep>& steps,
                     double tau_s) {
  WaitOutcome outcome;
  std::size_t next = 0;
  const auto time_s = [&](const InputStep& step) { return static_cast<double>(step.tick.value) * tau_s; };
  const auto ours = [&](const InputStep& step) {
    return step.analog == wait.analog && step.number == wait.number;
  };
  for (; next < steps.size() && time_s(steps[next]) <= begin_s + kSameMoment_s; ++next)
    if (ours(steps[next])) outcome.value = steps[next].value;
  // an edge is a change while waiting: nothing has changed yet
  bool high = outcome.value != 0;
  outcome.reached = holds(wait.mode, high, high);
  if (outcome.reached) return outcome;
  const double end_s = begin_s + wait.timeout_s + kSameMoment_s;
  for (; next < steps.size() && time_s(steps[next]) <= end_s; ++next) {
    const InputStep& step = steps[next];
    if (!ours(step)) continue;
    const bool now = step.value != 0;
    outcome.value = step.value;
    if (holds(wait.mode, high, now)) {
      outcome.reached = true;
      outcome.waited_s = std::max(time_s(step) - begin_s, 0.0);
      return outcome;
    }
    high = now;
  }
  outcome.waited_s = wait.timeout_s;
  return outcome;
}

void InputEvents::tick(ControlTicks tick) {
  for (; next_ < steps_.size() && steps_[next_].tick <= tick; ++next_) {
    const InputStep& step = steps_[next_];
    log::EventRecord e;
    e.tick = begin_of(step.tick, clock_);
    e.block = events_.block();
    e.kind = log::EventKind::input;
    e.value = step.value;
    e.text = fmt::format("{} input {} = {:.6g}", step.analog ? "analog" : "digital", step.number, step.value);
    events_.append(std::move(e));
  }
}

}  // namespace kadr::cycle
