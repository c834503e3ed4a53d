#include "tests/storm/run_case.h"

#include <stdexcept>

#include "emulator/cli/exit_codes.h"
#include "emulator/cli/run_header.h"
#include "emulator/log/alarm_list.h"

namespace kadr::storm {
namespace {

/// Control ticks that a run may last: operators and slow programs may stretch it.
constexpr double kMostTicks = 4000;

class Tape final : public log::ForwardingLog {
 public:
  Tape(log::RunLog* next, std::vector<TapeTick>& ticks) : ForwardingLog(next), ticks_(ticks) {}
  Written tick(const log::TickRecord& record, const StepBatch& batch) override {
    ticks_.push_back({batch, record.axis ? *record.axis : std::vector<AxisState>{}, *record.position_steps});
    return ForwardingLog::tick(record, batch);
  }

 private:
  std::vector<TapeTick>& ticks_;
};

/// What `kadr run -s` lists in its log.
std::vector<log::ReadFile> read_files(const scenario::Scenario& scenario, const PreparedCase& p) {
  std::vector<log::ReadFile> files = {
      cli::read_file("scenario", scenario.file, scenario.text),
      cli::read_file("machine", scenario.input(scenario.machine), p.given.machine.text),
      cli::read_file("program", scenario.input(scenario.program_file), p.sources[p.given.program].text())};
  if (scenario.tools_file.empty()) return files;
  const InputFile tools = scenario.input(scenario.tools_file);
  for (std::uint32_t file = 0; file < p.sources.size(); ++file)
    if (p.sources[file].name() == tools.path)
      files.push_back(cli::read_file("tools", tools, p.sources[file].text()));
  return files;
}

std::string first_error(const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics.list())
    if (d.severity == Severity::error) return code_name(d.code);
  return "without an error";
}

}  // namespace

std::unique_ptr<PreparedCase> prepare_case(const std::string& folder, const std::string& scenario_file) {
  auto p = std::make_unique<PreparedCase>();
  auto scenario = scenario::read_scenario(folder + "/" + scenario_file, p->sources);
  if (!scenario) {
    p->refusal = "scenario " + first_error(scenario.error());
    return p;
  }
  p->scenario_toml = scenario->text;
  p->program_name = scenario->program_name;
  if (!scenario::open_job(*scenario, p->given, p->sources, p->diagnostics)) {
    p->refusal = "machine " + first_error(p->diagnostics);
    return p;
  }
  p->files = read_files(*scenario, *p);
  auto read = cycle::lay_out(p->given, p->sources, p->diagnostics, cycle::SoftLimitRule::warning);
  if (!read || p->diagnostics.has_errors()) {
    p->refusal = "program " + first_error(p->diagnostics);
    return p;
  }
  auto planned = cycle::plan_program(p->given, p->sources, *read, p->diagnostics);
  if (!planned || p->diagnostics.has_errors()) {
    p->refusal = "plan " + first_error(p->diagnostics);
    return p;
  }
  p->job.emplace(cycle::Job{p->sources, p->given, std::move(*read), std::move(*planned)});
  const double tau_s = p->given.machine.model.clock.tau_s();
  const double planned_s = p->job->planned.plan.motion_s + p->job->planned.plan.pause_s;
  const bool may_stretch = p->given.most_override || !p->given.operator_steps.empty();
  if (may_stretch || planned_s > kMostTicks * tau_s) p->until_s = kMostTicks * tau_s;
  return p;
}

int exit_code_of(const log::RunSummary& summary) {
  return summary.alarms > 0 || summary.outcome == log::Outcome::plant_error ? cli::kAlarm : cli::kYes;
}

FinishedRun run_case(const PreparedCase& prepared, const std::string& log_path, int threads) {
  const cycle::Job& job = *prepared.job;
  cycle::RunOptions options;
  options.threads = threads;
  options.until_s = prepared.until_s;
  options.warnings = prepared.diagnostics.warnings();
  options.exit_code = exit_code_of;
  FinishedRun run;
  run.log_path = log_path;
  const log::RunHeader header = cli::run_header(job, options, prepared.scenario_toml, prepared.files);
  auto log = log::open_lcm_log({log_path, "", 0});
  const auto fail = [&](const std::string& reason) {
    throw std::runtime_error("the log can't be written: " + reason);
  };
  if (!log) fail(log.error().reason);
  if (auto begun = (*log)->begin(header); !begun) fail(begun.error().reason);
  for (const Diagnostic& d : prepared.diagnostics.list())
    if (auto written = (*log)->diagnostic(d, Ticks{-1}); !written) fail(written.error().reason);
  log::AlarmList alarms(log->get());
  Tape tape(&alarms, run.tape);
  auto summary = cycle::run(job, &tape, options);
  if (!summary) fail(summary.error().what);
  run.summary = std::move(*summary);
  const machine::MachineModel& machine = job.given.machine.model;
  for (std::size_t a = 0; a < machine.axis.size(); ++a)
    run.start_u.push_back(job.read.path.size() > 0 ? job.read.path.node(0)[a] : machine.axis[a].home_u);
  return run;
}

}  // namespace kadr::storm
