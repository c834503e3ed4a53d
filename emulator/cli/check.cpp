#include <fmt/format.h>

#include <algorithm>

#include "emulator/answers/answers_json.h"
#include "emulator/answers/check_report.h"
#include "emulator/answers/plan_table.h"
#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/inputs.h"
#include "emulator/text/text.h"

/// `kadr check` and `kadr plan`: everything up to the motion law, nothing that moves.
namespace kadr::cli {
namespace {

using text::Json;

Json head(const char* command, const std::string& program, const machine::MachineModel& machine,
          const Diagnostics& diagnostics, const SourceSet& sources) {
  Json j;
  j["kadr"] = KADR_VERSION;
  j["command"] = command;
  j["program"] = program;
  j["machine"] = machine.name;
  j["diagnostics"] = text::json_of(diagnostics, sources);
  return j;
}

/// The whole text of one program's check. `kadr: unreadable` goes to standard error, everything else is data.
int check_one(const Arguments& arguments, const std::string& path, Console& console, Json& documents) {
  const std::string program = program_text(path);
  SourceSet sources;
  cycle::JobInputs given;
  Diagnostics diagnostics;
  if (!load_machine(arguments.machine, arguments.settings, sources, given.machine, diagnostics)) {
    console.diagnostics(diagnostics, sources, "the machine file", Console::Where::errors);
    return kNotStarted;
  }
  refuse_offsets(arguments, given.machine.model);
  try {
    given.program = load_program(path, arguments.bounds, sources);
  } catch (const WorldError& e) {
    // the other programs are still checked
    console.error(e.what());
    return kNotStarted;
  }
  if (!load_reading(arguments, given.program, sources, given.reading, diagnostics)) {
    console.diagnostics(diagnostics, sources, file_in_error(diagnostics, sources), Console::Where::errors);
    return kNotStarted;
  }
  const auto job = cycle::prepare(given, sources, diagnostics);
  const int code = refused(diagnostics, arguments.strict) || !job ? kNo : kYes;

  if (console.options().json) {
    Json j = head("check", program, given.machine.model, diagnostics, sources);
    j["exit_code"] = code;
    j["check"] = job ? answers::json_of(answers::check_result(*job), given.machine.model) : Json(nullptr);
    documents.push_back(std::move(j));
    return code;
  }
  console.diagnostics(diagnostics, sources, program, Console::Where::output);
  const bool table = job && !console.options().quiet && console.options().format == DiagnosticFormat::human;
  if (table) {
    if (!diagnostics.list().empty()) console.data("\n");
    console.data(answers::render_check(answers::check_result(*job), program,
                                       machine_text(arguments.machine, given.machine.model),
                                       given.machine.model));
  }
  return code;
}

/// @param j    the document so far; the rows of a long program are streamed into its last key
/// @param job  nullptr: the program has no plan
void print_plan_json(Json j, const cycle::Job* job, Console& console) {
  j["time_s"] = job ? Json(job->planned.plan.motion_s + job->planned.plan.pause_s) : Json(nullptr);
  const planner::Smoothing smoothing = job ? job->read.path.smoothing : planner::Smoothing{};
  j["smoothing"] = {{"corners", smoothing.corners},
                    {"corner_deviation_u", smoothing.corner_deviation_u},
                    {"curves", smoothing.curves},
                    {"curve_deviation_u", smoothing.curve_deviation_u}};
  j["rows"] = Json::array();
  std::string text = text::json_text(j);
  text.erase(text.rfind("[]"));
  console.data(text + "[");
  bool first = true;
  if (job)
    answers::for_each_plan_row(*job, [&](const answers::PlanRow& row) {
      console.data((first ? "\n    " : ",\n    ") + text::json_line(answers::json_of(row)));
      first = false;
    });
  console.data(first ? "]\n}\n" : "\n  ]\n}\n");
}

void print_plan_csv(const cycle::Job& job, Console& console) {
  const machine::MachineModel& model = job.given.machine.model;
  console.data(answers::plan_csv_title(model));
  answers::for_each_plan_row(
      job, [&](const answers::PlanRow& row) { console.bytes(answers::plan_csv_row(row, model)); });
}

void print_plan_table(const cycle::Job& job, Console& console) {
  const answers::PlanTable table(job);
  std::size_t rows = 0;
  console.data(table.title());
  answers::for_each_plan_row(job, [&](const answers::PlanRow& row) {
    console.data(table.row(row));
    ++rows;
  });
  console.data(table.footer(job, rows));
}

}  // namespace

int check_programs(const Arguments& arguments, Console& console) {
  int worst = kYes;
  Json documents = Json::array();
  bool first = true;
  for (const std::string& path : arguments.files) {
    const bool separated = !first && !console.options().json && !console.options().quiet &&
                           console.options().format == DiagnosticFormat::human;
    if (separated) console.data("\n");
    first = false;
    worst = std::max(worst, check_one(arguments, path, console, documents));
  }
  if (console.options().json) console.document(documents);
  return worst;
}

int plan_program(const Arguments& arguments, Console& console) {
  const std::string& path = arguments.files.front();
  const std::string program = program_text(path);
  SourceSet sources;
  cycle::JobInputs given;
  Diagnostics diagnostics;
  if (!load_machine(arguments.machine, arguments.settings, sources, given.machine, diagnostics)) {
    console.diagnostics(diagnostics, sources, "the machine file", Console::Where::errors);
    return kNotStarted;
  }
  refuse_offsets(arguments, given.machine.model);
  given.program = load_program(path, arguments.bounds, sources);
  if (!load_reading(arguments, given.program, sources, given.reading, diagnostics)) {
    console.diagnostics(diagnostics, sources, file_in_error(diagnostics, sources), Console::Where::errors);
    return kNotStarted;
  }
  // a plan shows the program as written, even if the machine is too small: `kadr check` refuses that
  const auto job = cycle::prepare(given, sources, diagnostics, cycle::SoftLimitRule::warning);
  const int code = !job || refused(diagnostics, arguments.strict) ? kNo : kYes;

  if (console.options().json) {
    Json j = head("plan", program, given.machine.model, diagnostics, sources);
    j["exit_code"] = code;
    print_plan_json(std::move(j), job ? &*job : nullptr, console);
    return code;
  }
  console.diagnostics(diagnostics, sources, program, Console::Where::errors);
  if (code != kYes) return code;
  if (arguments.csv)
    print_plan_csv(*job, console);
  else
    print_plan_table(*job, console);
  return code;
}

}  // namespace kadr::cli
