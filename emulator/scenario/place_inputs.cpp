#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/scenario/scenario.h"
#include "machine/file/tree.h"

namespace kadr::emulator {
namespace {

// times are decimals: 0.3 s is 300 ticks of 1 ms but for a rounding
constexpr double kSameTick = 1e-6;

}  // namespace

void place_inputs(const Scenario& scenario, std::uint32_t file, Job& job, Diagnostics& diagnostics) {
  const double tau_s = job.machine.model.clock.tau_s();
  for (const ScenarioStep& step : scenario.steps) {
    Span span = step.span;
    span.file = file;
    const double ticks = step.at_tick ? static_cast<double>(*step.at_tick) : step.at_s / tau_s;
    const double whole = std::floor(ticks + 0.5);
    if (std::fabs(ticks - whole) > kSameTick) {
      Diagnostic d = machine::file_diagnostic(
          Code::scenario_step, span, fmt::format("is {:.6g} control ticks of {:.6g} s", ticks, tau_s));
      d.notes.push_back(fmt::format("allowed: whole multiples of {:.6g} s", tau_s));
      d.help = fmt::format("write at_s = {:.9g} or {:.9g}", std::floor(ticks) * tau_s,
                           (std::floor(ticks) + 1) * tau_s);
      diagnostics.add(std::move(d));
      continue;
    }
    const ControlTicks tick{static_cast<std::int64_t>(whole)};
    job.inputs.push_back({tick, step.analog, step.number, step.value, span});
  }
  std::stable_sort(job.inputs.begin(), job.inputs.end(),
                   [](const InputStep& a, const InputStep& b) { return a.tick < b.tick; });
}

}  // namespace kadr::emulator
