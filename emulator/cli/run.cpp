#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <system_error>

#include "emulator/answers/answers_json.h"
#include "emulator/answers/summary.h"
#include "emulator/answers/travel.h"
#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/inputs.h"
#include "emulator/cli/progress.h"
#include "emulator/cli/result_file.h"
#include "emulator/cli/run_header.h"
#include "emulator/cli/signals.h"
#include "emulator/log/alarm_list.h"
#include "emulator/scenario/scenario.h"
#include "emulator/text/text.h"
#include "machine/base/output_file.h"

namespace kadr::cli {
namespace {

namespace fs = std::filesystem;
using text::Json;

/// "PROG.lcmlog" in the current folder: the program's name without folders and last extension.
std::string default_log_path(const std::string& program) {
  const std::string stem = program == "-" ? "stdin" : fs::path(program).stem().string();
  return (stem.empty() ? "program" : stem) + ".lcmlog";
}

/// Refuses a log path before anything is said of it: one that can't be written, or where something else goes too.
void refuse_bad_log_path(const std::string& log, Console& console) {
  if (const auto refused = output_refusal(log))
    throw WorldError(fmt::format("{}: {}", refused->path, refused->reason));
  console.claim_output(log);
}

constexpr std::size_t kStringFrame_bytes = 5;  // LCM's length and terminating 0

/// Prints the expected size of the log before the run, and the free space if that is too little.
/// @throws WorldError if it is more than --limit log_bytes allows
void tell_expected_size(const cycle::Job& job, const Arguments& arguments, const std::string& log,
                        const log::RunHeader& header, Console& console) {
  const machine::MachineModel& model = job.given.machine.model;
  const double planned_s = job.planned.plan.motion_s + job.planned.plan.pause_s;
  const double run_s = std::min(planned_s, arguments.until_s);
  const double part = planned_s > 0 ? run_s / planned_s : 1.0;
  const auto pulses =
      static_cast<double>(answers::estimate_pulses(answers::axis_travel(job.read.path), model));
  const std::size_t text_bytes = header.program_text.size() + header.machine_toml.size() +
                                 header.scenario_toml.size() + header.settings_toml.size();
  std::size_t list_bytes = 0;
  for (const log::ReadFile& file : header.files)
    list_bytes += kStringFrame_bytes + log::file_text(file).size();
  const std::int64_t bytes =
      log::estimate_log_bytes(model, run_s, static_cast<std::int64_t>(pulses * part),
                              static_cast<std::size_t>(static_cast<double>(job.read.blocks) * part),
                              arguments.plant, text_bytes, list_bytes);
  if (arguments.log_bytes > 0 && static_cast<std::uint64_t>(bytes) > arguments.log_bytes)
    throw WorldError(fmt::format(
        "{}: the log would be about {}, more than log_bytes allows ({}); --limit log_bytes=N allows "
        "more, 0 any length; --no-log, --until, log.steps=false or log.viewer_rate_hz=0 write less",
        log, text::bytes_text(bytes), text::bytes_text(static_cast<std::int64_t>(arguments.log_bytes))));
  console.note(fmt::format("log {}, about {} for {} of machine time", output_text(log),
                           text::bytes_text(bytes), text::duration_text(run_s)));
  std::error_code error;
  const fs::path folder = fs::absolute(log, error).parent_path();
  const fs::space_info room = fs::space(folder, error);
  if (!error && room.available < static_cast<std::uintmax_t>(bytes))
    console.note(
        fmt::format("only {} are free there; --no-log, --until, log.steps=false or log.viewer_rate_hz=0 "
                    "write less",
                    text::bytes_text(static_cast<std::int64_t>(room.available))));
}

/// Program, machine and settings, from the command line or else from the scenario.
struct RunInputs {
  Arguments arguments;  ///< completed by the scenario
  SourceSet sources;
  cycle::JobInputs given;
  Diagnostics diagnostics;
  std::string program;  ///< as given, for people
  std::string scenario_toml;
  std::string scenario_name;
  std::optional<scenario::Scenario> scenario;
  /// Of the command line, or else of the scenario; an empty path: none is named.
  InputFile program_file{""}, machine{""};
  ReadingFiles reading{InputFile(""), InputFile("")};
  std::vector<log::ReadFile> files;  ///< that were read
  std::uint32_t scenario_file = 0;   ///< in the sources
  bool machine_good = false;
  bool started = false;  ///< machine, tool table and scenario could be read
};

void take_scenario(RunInputs& in) {
  in.scenario_file = static_cast<std::uint32_t>(in.sources.size());  // the file that is read first
  auto scenario = scenario::read_scenario(in.arguments.scenario, in.sources, in.arguments.allowed_folders);
  if (!scenario) {
    in.diagnostics.add(scenario.error());
    return;
  }
  in.scenario_toml = scenario->text;
  in.scenario_name = scenario->name;
  in.scenario = *scenario;
  std::vector<std::string> settings = scenario->settings;
  settings.insert(settings.end(), in.arguments.settings.begin(), in.arguments.settings.end());
  in.arguments.settings = std::move(settings);
  if (in.machine.path.empty())
    in.machine = scenario->machine_is_file ? scenario->input(scenario->machine) : scenario->machine;
  if (in.reading.tools.path.empty() && !scenario->tools_file.empty())
    in.reading.tools = scenario->input(scenario->tools_file);
  if (in.reading.ini.path.empty() && !scenario->ini_file.empty())
    in.reading.ini = scenario->input(scenario->ini_file);
  std::vector<machine::CodeName>& ignored = in.arguments.ignored;
  ignored.insert(ignored.end(), scenario->ignored.begin(), scenario->ignored.end());
  // of two values of a pin the last one counts
  in.arguments.hal.insert(in.arguments.hal.begin(), scenario->hal.begin(), scenario->hal.end());
  if (!in.arguments.dialect && !in.arguments.recognise_dialect) in.arguments.dialect = scenario->dialect;
  if (!in.arguments.from_line) in.arguments.from_line = scenario->from_line;
  if (!in.arguments.to_line) in.arguments.to_line = scenario->to_line;
  if (!in.program_file.path.empty()) return;
  if (!scenario->generated_program.empty()) {
    in.given.program = in.sources.add(SourceText(scenario->program_name, scenario->generated_program));
    in.program = scenario->program_name;
  } else {
    in.program_file = scenario->input(scenario->program_file);
  }
}

/// @param next  the file of the sources from which those of the reading stand
void list_files(RunInputs& in, std::uint32_t next) {
  if (in.scenario) in.files.push_back(read_file("scenario", in.scenario->file, in.scenario_toml));
  const bool shipped = !in.machine.folders && !machine::shipped_machine(in.machine.path).empty();
  if (!in.machine.path.empty() && !shipped)
    in.files.push_back(read_file("machine", in.machine, in.given.machine.text));
  if (!in.program_file.path.empty())
    in.files.push_back(read_file("program", in.program_file, in.sources[in.given.program].text()));
  if (!in.reading.tools.path.empty())
    in.files.push_back(read_file("tools", in.reading.tools, in.sources[next++].text()));
  if (!in.reading.ini.path.empty())
    in.files.push_back(read_file("ini", in.reading.ini, in.sources[next].text()));
}

void read_inputs(RunInputs& in) {
  in.machine = in.arguments.machine;
  in.reading = {in.arguments.tools, in.arguments.ini};
  if (!in.arguments.files.empty()) in.program_file = in.arguments.files.front();
  if (!in.arguments.scenario.empty()) take_scenario(in);
  if (in.diagnostics.has_errors()) return;
  in.machine_good =
      load_machine(in.machine, in.arguments.settings, in.sources, in.given.machine, in.diagnostics);
  if (in.machine_good) refuse_offsets(in.arguments, in.given.machine.model);
  if (!in.program_file.path.empty()) {
    in.given.program = load_program(in.program_file, in.arguments.bounds, in.sources);
    in.program = program_text(in.program_file.path);
  }
  const auto next = static_cast<std::uint32_t>(in.sources.size());
  in.started = load_reading(in.arguments, in.given.program, in.reading, in.sources, in.given.reading,
                            in.diagnostics) &&
               in.machine_good;
  if (!in.started) return;
  list_files(in, next);
  if (!in.scenario) return;
  // also of a timeline without steps: it has a highest override
  scenario::place_inputs(*in.scenario, in.scenario_file, in.given, in.diagnostics);
  in.started = !in.diagnostics.has_errors();
}

Json head(const RunInputs& in, int exit_code) {
  Json j;
  j["kadr"] = KADR_VERSION;
  j["command"] = "run";
  j["exit_code"] = exit_code;
  j["program"] = in.program;
  j["machine"] = in.machine_good ? Json(in.given.machine.model.name) : Json(nullptr);
  j["scenario"] = in.scenario_name.empty() ? Json(nullptr) : Json(in.scenario_name);
  j["diagnostics"] = text::json_of(in.diagnostics, in.sources);
  return j;
}

/// The run does not start: prints the diagnostics in the requested format.
int refuse(const RunInputs& in, int exit_code, Console& console) {
  if (console.options().json) {
    Json j = head(in, exit_code);
    j["run"] = nullptr;
    console.document(j);
  } else {
    const std::string subject = in.started        ? in.program
                                : in.machine_good ? file_in_error(in.diagnostics, in.sources)
                                                  : "the machine or scenario file";
    console.diagnostics(in.diagnostics, in.sources, subject, Console::Where::errors);
  }
  return exit_code;
}

/// Ends a run that an I/O error or the plant's numerics stopped.
[[noreturn]] void fail(const std::string& what) { throw WorldError(what); }
[[noreturn]] void fail(const log::LogError& e) { fail(fmt::format("{}: {}", e.path, e.reason)); }

std::unique_ptr<log::RunLog> open_log(const RunInputs& in, const log::RunHeader& header,
                                      const std::string& path) {
  const Arguments& arguments = in.arguments;
  if (path.empty() && arguments.publish_url.empty()) return nullptr;
  auto log = log::open_lcm_log({path, arguments.publish_url, arguments.log_bytes});
  if (!log) fail(log.error());
  if (auto begun = (*log)->begin(header); !begun) fail(begun.error());
  for (const Diagnostic* d : by_place(in.diagnostics))
    if (auto written = (*log)->diagnostic(*d, Ticks{-1}); !written) fail(written.error());
  return std::move(*log);
}

int exit_code(const log::RunSummary& summary, int signal) {
  if (summary.outcome == log::Outcome::interrupted && signal != 0) return kSignal + signal;
  return summary.alarms > 0 || summary.outcome == log::Outcome::plant_error ? kAlarm : kYes;
}

/// Where the log of this run goes; empty: it has none.
std::string log_path_of(const RunInputs& in) {
  if (!in.arguments.log) return {};
  if (!in.arguments.log_path.empty()) return in.arguments.log_path;
  return default_log_path(in.sources[in.given.program].name());
}

cycle::RunOptions run_options(const RunInputs& in, SignalGuard& signals) {
  cycle::RunOptions options;
  options.plant = in.arguments.plant;
  options.threads = in.arguments.threads;
  options.until_s = in.arguments.until_s;
  options.interrupt = signals.flag();
  options.warnings = in.diagnostics.warnings();
  options.exit_code = [&signals](const log::RunSummary& summary) {
    return exit_code(summary, signals.signal());
  };
  return options;
}

answers::SummaryContext summary_context(const RunInputs& in, const cycle::Job& job,
                                        const log::AlarmList& alarms) {
  const machine::MachineModel& model = job.given.machine.model;
  answers::SummaryContext context;
  context.program = in.program;
  context.machine = machine_text(in.machine.path, model);
  context.scenario = in.scenario_name;
  context.model = &model;
  context.path_unit = answers::path_unit(job.read.path, model);
  context.approach = answers::approach_row(job);
  context.plant = in.arguments.plant;
  context.program_warnings = in.diagnostics.warnings();
  context.alarms = alarms.alarms();
  context.alarm_counts = alarms.counts();
  return context;
}

/// Prints what came of a run.
void tell_summary(const RunInputs& in, const log::RunSummary& summary, const answers::SummaryContext& context,
                  Console& console) {
  if (console.options().json) {
    Json j = head(in, summary.exit_code);
    j["run"] = answers::json_of(summary, context);
    console.document(j);
  } else if (!console.options().quiet) {
    console.summary(answers::render_summary(summary, context));
  }
  if (summary.outcome == log::Outcome::interrupted)
    console.error(fmt::format(
        "interrupted{}", context.log_path.empty() ? "" : "; what was written is in " + context.log_path));
}

int move(const RunInputs& in, const cycle::Job& job, Console& console) {
  const Arguments& arguments = in.arguments;
  const std::string log_path = log_path_of(in);
  SignalGuard signals;
  cycle::RunOptions options = run_options(in, signals);
  const log::RunHeader header = run_header(job, options, in.scenario_toml, in.files);
  if (!log_path.empty()) {
    refuse_bad_log_path(log_path, console);
    tell_expected_size(job, arguments, log_path, header, console);
  }
  // a FIFO waits for its reader here
  const auto log = open_log(in, header, log_path);
  signals.hold();
  log::AlarmList alarms(log.get());

  Progress progress(arguments.output, count_lines(in.sources[in.given.program].text()));
  options.progress = [&](double done, std::uint32_t line, double sim_s) {
    progress.update(done, line, sim_s);
  };
  const auto result = cycle::run(job, &alarms, options);
  const double wall_s = progress.wall_s();
  progress.erase();
  if (!result) fail(result.error().what);

  answers::SummaryContext context = summary_context(in, job, alarms);
  context.wall_s = wall_s;
  if (!log_path.empty()) {
    context.log_path = result->outcome == log::Outcome::interrupted ? written_as(log_path) : log_path;
    std::error_code error;
    const auto size = fs::file_size(context.log_path, error);
    if (!error) context.log_bytes = static_cast<std::int64_t>(size);
    context.log_path = output_text(context.log_path);
  }
  tell_summary(in, *result, context, console);
  return result->exit_code;
}

}  // namespace

int run_program(const Arguments& arguments, Console& console) {
  RunInputs in;
  in.arguments = arguments;
  read_inputs(in);
  if (!in.started) return refuse(in, kNotStarted, console);
  const auto job = cycle::prepare(in.given, in.sources, in.diagnostics, cycle::SoftLimitRule::warning);
  if (!job || refused(in.diagnostics, arguments.strict)) return refuse(in, kNo, console);
  if (!console.options().json)
    console.diagnostics(in.diagnostics, in.sources, in.program, Console::Where::errors);
  return move(in, *job, console);
}

}  // namespace kadr::cli
