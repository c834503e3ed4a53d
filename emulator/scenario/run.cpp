#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "emulator/log/alarm_list.h"
#include "emulator/scenario/scenario.h"
#include "emulator/scenario/signals.h"
#include "machine/base/hash.h"

namespace kadr::scenario {
namespace {

std::string codes_text(const std::vector<Code>& codes) {
  std::string out;
  for (const Code code : codes) out += (out.empty() ? "" : " ") + code_name(code);
  return out.empty() ? "none" : out;
}

std::string counts_text(const std::vector<std::pair<Code, std::int64_t>>& counts) {
  std::string out;
  for (const auto& [code, count] : counts)
    out += fmt::format("{}{} x{}", out.empty() ? "" : ", ", code_name(code), count);
  return out.empty() ? "none" : out;
}

/// Vibration is given in thousandths of the axis unit: um or mdeg.
const char* small_unit(char letter) { return is_rotary_letter(letter) ? "mdeg" : "um"; }

void compare_count(std::vector<ScenarioCheck>& checks, std::string what, std::int64_t expected,
                   std::int64_t measured) {
  checks.push_back(
      {std::move(what), fmt::format("{}", expected), fmt::format("{}", measured), expected == measured});
}

void compare_bounds(std::vector<ScenarioCheck>& checks, const std::string& what, char letter,
                    const ValueRange& bounds, double measured_u) {
  const char* unit = small_unit(letter);
  checks.push_back({fmt::format("{} {}", what, letter),
                    fmt::format("{:.4f} to {:.4f} {}", bounds.least_u * 1000, bounds.most_u * 1000, unit),
                    fmt::format("{:.4f} {}", measured_u * 1000, unit),
                    measured_u >= bounds.least_u && measured_u <= bounds.most_u});
}

void compare_axis(std::vector<ScenarioCheck>& checks, const AxisExpectation& expect,
                  const machine::MachineModel& machine, const log::RunSummary& summary) {
  const int index = machine.find_axis(expect.letter);
  if (index < 0) {
    checks.push_back(
        {fmt::format("axis {}", expect.letter), "present", "the machine has no such axis", false});
    return;
  }
  const log::AxisSummary& axis = summary.axis.at(static_cast<std::size_t>(index));
  if (expect.pulses)
    compare_count(checks, fmt::format("pulses {}", expect.letter), *expect.pulses, axis.pulses);
  if (expect.end_steps)
    compare_count(checks, fmt::format("end steps {}", expect.letter), *expect.end_steps,
                  axis.end_steps.value);
  if (expect.vibration)
    compare_bounds(checks, "vibration", expect.letter, *expect.vibration, axis.peak_vibration_u);
  if (expect.residual) compare_bounds(checks, "residual", expect.letter, *expect.residual, axis.residual_u);
}

void compare_run(ScenarioResult& result, const Expectations& expect, const machine::MachineModel& machine) {
  const log::RunSummary& summary = *result.summary;
  // an alarm is reported below, with its code
  if (summary.outcome != log::Outcome::complete && summary.outcome != log::Outcome::alarm)
    result.checks.push_back({"outcome", "complete", summary.outcome.text(), false});
  if (expect.time_s)
    result.checks.push_back({"time", fmt::format("{:.7f} s within {:.7f} s", *expect.time_s, expect.within_s),
                             fmt::format("{:.7f} s", result.machine_s),
                             std::fabs(result.machine_s - *expect.time_s) <= expect.within_s});
  if (expect.steps_hash)
    result.checks.push_back({"steps hash", hash_text(*expect.steps_hash), hash_text(summary.steps_hash),
                             *expect.steps_hash == summary.steps_hash});
  result.checks.push_back(
      {"alarms", counts_text(expect.alarms), counts_text(result.alarms), expect.alarms == result.alarms});
  for (const AxisExpectation& axis : expect.axis) compare_axis(result.checks, axis, machine, summary);
}

void compare_signals(ScenarioResult& result, const Expectations& expect, const SignalRecorder& signals,
                     const machine::MachineModel& machine) {
  for (const SignalExpectation& s : expect.signals) {
    const auto range = signals.range(s.signal, s.from_s, s.to_s);
    const std::string unit = signal_unit(s.signal, machine);
    std::string what = s.signal;
    if (s.from_s > 0 || s.to_s < machine::kInfinity)
      what += fmt::format(" from {:.6g} to {:.6g} s", s.from_s, s.to_s);
    result.checks.push_back({what, fmt::format("{:.10g} to {:.10g} {}", s.least, s.most, unit),
                             range ? fmt::format("{:.10g} to {:.10g} {}", range->least_u, range->most_u, unit)
                                   : "no control tick, or no such signal",
                             range && range->least_u >= s.least && range->most_u <= s.most});
  }
}

std::string boundary_text(const BoundaryExpectation& b) {
  return fmt::format("tick {} + {}, feed {:.4f}, planned {:.4f}, deferred {}", b.control_tick, b.offset,
                     b.feed_u_s, b.planned_u_s, b.deferred_ticks);
}

void compare_boundaries(ScenarioResult& result, const Expectations& expect) {
  for (const BoundaryExpectation& b : expect.boundaries) {
    const auto it = std::find_if(result.boundaries.begin(), result.boundaries.end(),
                                 [&](const BoundaryExpectation& m) { return m.block == b.block; });
    const std::string measured = it == result.boundaries.end() ? "never begins" : boundary_text(*it);
    result.checks.push_back({fmt::format("boundary of block {}", b.block), boundary_text(b), measured,
                             boundary_text(b) == measured});
  }
}

void render_into(ScenarioResult& result, const Diagnostics& diagnostics, const SourceSet& sources) {
  for (const Diagnostic& d : diagnostics.list()) {
    result.diagnostics += render_human(d, sources);
    if (d.severity != Severity::note) result.codes.push_back(d.code);
  }
}

void run_into(ScenarioResult& result, const Scenario& scenario, const cycle::RunOptions& options,
              const gcode::ReadingBounds& bounds) {
  SourceSet sources;
  cycle::JobInputs given;
  given.reading.bounds = bounds;
  Diagnostics diagnostics;
  const bool opened = open_job(scenario, given, sources, diagnostics);
  if (!opened) {
    render_into(result, diagnostics, sources);
    result.failure = "the machine file or the tool table has errors";
    return;
  }
  // as `kadr run` does: the run shows where a soft limit is exceeded
  const auto job = cycle::prepare(given, sources, diagnostics, cycle::SoftLimitRule::warning);
  render_into(result, diagnostics, sources);
  result.checks.push_back({"diagnostics", codes_text(scenario.expect.diagnostics), codes_text(result.codes),
                           scenario.expect.diagnostics == result.codes});
  if (!job || diagnostics.has_errors()) {
    if (scenario.expect.time_s || scenario.expect.steps_hash || !scenario.expect.alarms.empty() ||
        !scenario.expect.axis.empty())
      result.checks.push_back({"run", "planned and run", "refused", false});
    return;
  }
  log::AlarmList alarms(nullptr);
  SignalRecorder signals(given.machine.model, &alarms);
  auto summary = cycle::run(*job, &signals, options);
  if (!summary) {
    result.failure = summary.error().what;
    return;
  }
  for (const auto& [code, count] : alarms.counts())
    result.alarms.emplace_back(code, static_cast<std::int64_t>(count));
  result.machine_s =
      static_cast<double>(summary->ticks.value) / static_cast<double>(given.machine.model.clock.base_hz);
  result.summary = std::move(*summary);
  const std::int64_t tau = given.machine.model.clock.control_tick.value;
  for (const log::BlockRecord& r : signals.boundaries())
    result.boundaries.push_back({r.block,
                                 r.tick.value / tau,
                                 r.tick.value % tau,
                                 r.entry_u_s,
                                 r.planned_entry_u_s,
                                 r.deferred_ticks.value,
                                 {}});
  compare_run(result, scenario.expect, given.machine.model);
  compare_signals(result, scenario.expect, signals, given.machine.model);
  compare_boundaries(result, scenario.expect);
}

}  // namespace

bool ScenarioResult::passed() const {
  if (!failure.empty() || checks.empty()) return false;
  for (const ScenarioCheck& check : checks)
    if (!check.passed) return false;
  return true;
}

bool open_job(const Scenario& scenario, cycle::JobInputs& given, SourceSet& sources,
              Diagnostics& diagnostics) {
  SourceText machine_text =
      scenario.machine_is_file
          ? SourceText::open(scenario.input(scenario.machine), kMostSettings_bytes)
          : SourceText(scenario.machine + ".toml", std::string(machine::shipped_machine(scenario.machine)));
  SourceText program =
      scenario.program_file.empty()
          ? SourceText(scenario.program_name, scenario.generated_program)
          : gcode::open_program(scenario.input(scenario.program_file), given.reading.bounds.file_bytes);
  auto file = machine::read_machine(std::move(machine_text), sources, scenario.settings);
  given.program = sources.add(std::move(program));
  given.reading.dialect = scenario.dialect;
  given.reading.from_line = scenario.from_line;
  given.reading.to_line = scenario.to_line;
  given.reading.allowed_folders = scenario.folders.allowed;
  given.reading.ignored = scenario.ignored;
  given.reading.hal = scenario.hal;
  const std::size_t errors = diagnostics.errors();
  if (!scenario.tools_file.empty()) {
    const std::uint32_t tools =
        sources.add(SourceText::open(scenario.input(scenario.tools_file), kMostTable_bytes));
    given.reading.tools = gcode::read_tool_table(sources, tools, diagnostics);
  }
  if (!scenario.ini_file.empty()) {
    const std::uint32_t ini =
        sources.add(SourceText::open(scenario.input(scenario.ini_file), kMostSettings_bytes));
    given.reading.ini = gcode::read_ini_file(sources, ini, diagnostics);
  }
  if (!file) {
    diagnostics.add(file.error());
    return false;
  }
  given.machine = std::move(*file);
  const std::uint32_t text = sources.add(SourceText(scenario.file, scenario.text));
  place_inputs(scenario, text, given, diagnostics);
  return diagnostics.errors() == errors;
}

ScenarioResult run_scenario(const Scenario& scenario, const cycle::RunOptions& options,
                            const gcode::ReadingBounds& bounds) {
  ScenarioResult result;
  result.name = scenario.name;
  result.file = scenario.file;
  try {
    run_into(result, scenario, options, bounds);
  } catch (const std::system_error& e) {
    result.failure = e.what();
  }
  return result;
}

ScenarioResult run_scenario(const InputFile& file, const cycle::RunOptions& options,
                            const std::vector<std::string>& allowed, const gcode::ReadingBounds& bounds) {
  ScenarioResult result;
  result.name = result.file = file.path;
  try {
    SourceSet sources;
    const auto scenario = read_scenario(file, sources, allowed);
    if (scenario) return run_scenario(*scenario, options, bounds);
    result.failure = "the scenario file has errors";
    render_into(result, scenario.error(), sources);
  } catch (const std::system_error& e) {
    result.failure = e.what();
  }
  return result;
}

}  // namespace kadr::scenario
