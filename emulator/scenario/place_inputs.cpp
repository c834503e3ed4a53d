#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/scenario/scenario.h"
#include "machine/file/tree.h"

namespace kadr::scenario {
namespace {

// times are decimals: 0.3 s is 300 ticks of 1 ms up to rounding
constexpr double kSameTick = 1e-6;

Span in_file(Span span, std::uint32_t file) {
  span.file = file;
  return span;
}

void place_technology(const Scenario& scenario, std::uint32_t file, cycle::JobInputs& given) {
  for (const ScenarioTechnology& point : scenario.technology) {
    const Span span = in_file(point.span, file);
    if (point.path_u)
      given.place_limits.push_back({*point.path_u, point.rule.max_u_s, span});
    else if (point.line)
      given.line_limits.push_back({*point.line, point.rule.max_u_s, span});
    else
      given.machine.model.technology.push_back(point.rule);
  }
}

/// Puts the steps of a timeline on control ticks.
class StepPlacer {
 public:
  StepPlacer(std::uint32_t file, cycle::JobInputs& given, Diagnostics& diagnostics)
      : file_(file), given_(given), diagnostics_(diagnostics), tau_s_(given.machine.model.clock.tau_s()) {}

  void add(const ScenarioStep& step) {
    const Span span = in_file(step.span, file_);
    cycle::OperatorStep action;
    action.place = step.place;
    if (!step.place) {
      const double ticks = step.at_tick ? static_cast<double>(*step.at_tick) : step.at_s / tau_s_;
      const auto tick = on_tick(ticks, "at_s", span);
      if (!tick) return;
      action.tick = *tick;
    }
    if (!step.action) {
      given_.inputs.push_back({action.tick, step.analog, step.number, step.value, span});
      return;
    }
    action.action = *step.action;
    action.value = step.value;
    action.span = span;
    given_.operator_steps.push_back(action);
    if (*step.action == cycle::OperatorAction::spindle_load) end_load(step, action);
  }

 private:
  std::optional<ControlTicks> on_tick(double ticks, std::string_view key, const Span& span) {
    const double whole = std::floor(ticks + 0.5);
    if (std::fabs(ticks - whole) <= kSameTick) return ControlTicks{static_cast<std::int64_t>(whole)};
    Diagnostic d = machine::file_diagnostic(
        Code::scenario_step, span, fmt::format("is {:.6g} control ticks of {:.6g} s", ticks, tau_s_));
    d.notes.push_back(fmt::format("allowed: whole multiples of {:.6g} s", tau_s_));
    d.help = fmt::format("write {} = {:.9g} or {:.9g}", key, std::floor(ticks) * tau_s_,
                         (std::floor(ticks) + 1) * tau_s_);
    diagnostics_.add(std::move(d));
    return {};
  }

  /// A load with for_s ends in the one before it.
  void end_load(const ScenarioStep& step, cycle::OperatorStep action) {
    if (!(step.for_s > 0)) {
      load_ = step.value;
      return;
    }
    const auto more = on_tick(step.for_s / tau_s_, "for_s", action.span);
    if (!more) return;
    action.tick += *more;
    action.value = load_;
    given_.operator_steps.push_back(action);
  }

  std::uint32_t file_;
  cycle::JobInputs& given_;
  Diagnostics& diagnostics_;
  double tau_s_;
  double load_ = 0;  // of the spindle, before a step with for_s
};

}  // namespace

void place_inputs(const Scenario& scenario, std::uint32_t file, cycle::JobInputs& given,
                  Diagnostics& diagnostics) {
  given.most_override = scenario.most_override;
  place_technology(scenario, file, given);
  StepPlacer placer(file, given, diagnostics);
  for (const ScenarioStep& step : scenario.steps) placer.add(step);
  std::stable_sort(given.inputs.begin(), given.inputs.end(),
                   [](const cycle::InputStep& a, const cycle::InputStep& b) { return a.tick < b.tick; });
  const auto placed = std::stable_partition(given.operator_steps.begin(), given.operator_steps.end(),
                                            [](const cycle::OperatorStep& s) { return !s.place; });
  std::stable_sort(
      given.operator_steps.begin(), placed,
      [](const cycle::OperatorStep& a, const cycle::OperatorStep& b) { return a.tick < b.tick; });
}

}  // namespace kadr::scenario
