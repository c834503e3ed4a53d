#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/scenario/scenario.h"
#include "machine/file/tree.h"

namespace kadr::scenario {
namespace {

// times are decimals: 0.3 s is 300 ticks of 1 ms up to rounding
constexpr double kSameTick = 1e-6;

}  // namespace

void place_inputs(const Scenario& scenario, std::uint32_t file, cycle::JobInputs& given,
                  Diagnostics& diagnostics) {
  const double tau_s = given.machine.model.clock.tau_s();
  given.most_override = scenario.most_override;
  for (const ScenarioTechnology& point : scenario.technology) {
    Span span = point.span;
    span.file = file;
    if (point.path_u) {
      given.place_limits.push_back({*point.path_u, point.rule.max_u_s, span});
      continue;
    }
    if (!point.line) {
      given.machine.model.technology.push_back(point.rule);
      continue;
    }
    given.line_limits.push_back({*point.line, point.rule.max_u_s, span});
  }
  double load = 0;  // of the spindle, before a step with for_s
  for (const ScenarioStep& step : scenario.steps) {
    Span span = step.span;
    span.file = file;
    const auto on_tick = [&](double ticks, std::string_view key) -> std::optional<ControlTicks> {
      const double whole = std::floor(ticks + 0.5);
      if (std::fabs(ticks - whole) <= kSameTick) return ControlTicks{static_cast<std::int64_t>(whole)};
      Diagnostic d = machine::file_diagnostic(
          Code::scenario_step, span, fmt::format("is {:.6g} control ticks of {:.6g} s", ticks, tau_s));
      d.notes.push_back(fmt::format("allowed: whole multiples of {:.6g} s", tau_s));
      d.help = fmt::format("write {} = {:.9g} or {:.9g}", key, std::floor(ticks) * tau_s,
                           (std::floor(ticks) + 1) * tau_s);
      diagnostics.add(std::move(d));
      return {};
    };
    cycle::OperatorStep action;
    action.place = step.place;
    if (!step.place) {
      const auto tick =
          on_tick(step.at_tick ? static_cast<double>(*step.at_tick) : step.at_s / tau_s, "at_s");
      if (!tick) continue;
      action.tick = *tick;
    }
    if (!step.action) {
      given.inputs.push_back({action.tick, step.analog, step.number, step.value, span});
      continue;
    }
    action.action = *step.action;
    action.value = step.value;
    action.span = span;
    given.operator_steps.push_back(action);
    if (*step.action != cycle::OperatorAction::spindle_load) continue;
    if (step.for_s > 0) {
      const auto more = on_tick(step.for_s / tau_s, "for_s");
      if (!more) continue;
      action.tick = action.tick + *more;
      action.value = load;
      given.operator_steps.push_back(action);
    } else {
      load = step.value;
    }
  }
  std::stable_sort(given.inputs.begin(), given.inputs.end(),
                   [](const cycle::InputStep& a, const cycle::InputStep& b) { return a.tick < b.tick; });
  const auto placed = std::stable_partition(given.operator_steps.begin(), given.operator_steps.end(),
                                            [](const cycle::OperatorStep& s) { return !s.place; });
  std::stable_sort(
      given.operator_steps.begin(), placed,
      [](const cycle::OperatorStep& a, const cycle::OperatorStep& b) { return a.tick < b.tick; });
}

}  // namespace kadr::scenario
