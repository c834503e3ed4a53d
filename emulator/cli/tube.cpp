#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/inputs.h"
#include "emulator/cli/key_list.h"
#include "emulator/cli/progress.h"
#include "emulator/cli/result_file.h"
#include "emulator/studies/time_law/law_report.h"
#include "emulator/studies/time_law/problem_keys.h"
#include "emulator/studies/time_law/sweep_report.h"
#include "emulator/studies/time_law/tube_page.h"

/// `kadr tube`: time laws of a stated path, by several methods side by side.
namespace kadr::cli {
namespace {

using machine::PlanMethod;
using studies::LawStudy;
using studies::TimeLawProblem;
using text::Json;

/// Methods of the command line, in the order of the table; all of the problem's if none is named.
std::vector<PlanMethod> chosen_methods(const Arguments& arguments, const TimeLawProblem& problem) {
  std::vector<PlanMethod> methods;
  for (const std::string& name : arguments.methods) methods.push_back(*machine::kLawMethods.find(name));
  if (methods.empty()) return studies::methods_of(problem);
  std::sort(methods.begin(), methods.end());
  methods.erase(std::unique(methods.begin(), methods.end()), methods.end());
  if (methods.back() == PlanMethod::jerk_limited && !problem.jerk_mm_s3)
    throw WorldError("--method jerk-limited: the problem gives no limit; write [jerk] with max_mm_s3 = ...");
  return methods;
}

void write_files(const Arguments& arguments, const LawStudy& study, const TimeLawProblem& problem,
                 const std::string& name) {
  if (!arguments.csv_path.empty()) {
    ResultFile csv(arguments.csv_path);
    studies::write_law_csv(study, problem, [&](std::string_view text) { csv.write(text); });
    csv.close();
  }
  if (!arguments.page_path.empty())
    write_file(arguments.page_path, studies::render_tube_page(study, problem, name));
}

std::string tables(const Arguments& arguments, const LawStudy& study, const TimeLawProblem& problem,
                   const std::string& name) {
  std::string out = studies::render_problem(problem, name);
  const planner::LawSolution* law = nullptr;
  for (const studies::MethodOutcome& o : study.outcomes)
    if (o.method == PlanMethod::tube && o.law) law = &*o.law;
  if (!study.tube.passes.empty())
    out += '\n' + studies::render_tube_log(study.tube, law, problem.law.length_u(), problem.tube);
  out += '\n' + studies::render_law_table(study, arguments.timing);
  return out + '\n' + studies::render_law_checks(study, problem);
}

/// Standard output has the same bytes on a terminal; wall times go to standard error.
void note_times(const Arguments& arguments, const LawStudy& study, Console& console) {
  if (arguments.timing || !::isatty(STDERR_FILENO)) return;
  std::string text = "wall";
  for (const studies::MethodOutcome& o : study.outcomes)
    text += fmt::format("{} {} {:.1f} ms", o.method == study.outcomes.front().method ? "" : ",",
                        machine::kLawMethods.word(o.method), 1000 * o.wall_s);
  console.note(text);
}

/// Shows the progress of a problem, if it is due.
void tell(ProgressLine& progress, const std::string& stage, double done) {
  const auto text = [&] { return stage_bar(stage, done); };
  progress.update(text, text);
}

int sweep_tube(const Arguments& arguments, const TimeLawProblem& problem, const std::string& name,
               Console& console) {
  ProgressLine progress(arguments.output, ProgressLine::Elsewhere::nothing);
  const std::int32_t first = arguments.first_level, last = arguments.last_level;
  const studies::LevelSweep sweep = studies::sweep_levels(problem, first, last, [&](std::int32_t levels) {
    tell(progress, fmt::format("{} levels of {} to {}", levels, first, last),
         static_cast<double>(levels - first) / (last - first + 1));
  });
  progress.erase();
  if (!arguments.csv_path.empty()) write_file(arguments.csv_path, studies::sweep_csv(sweep));
  if (!arguments.page_path.empty())
    write_file(arguments.page_path, studies::render_sweep_page(sweep, problem, name));
  const int code = sweep.good() ? kYes : kNo;
  if (console.options().json) {
    Json j = {{"kadr", KADR_VERSION}, {"command", "tube"}, {"file", name}, {"exit_code", code}};
    j["diagnostics"] = Json::array();
    j.update(studies::json_of(sweep));
    console.document(j);
  } else if (!console.options().quiet) {
    console.summary(studies::render_problem(problem, name) + '\n' + studies::render_sweep_table(sweep));
  }
  return code;
}

int study_tube(const Arguments& arguments, const TimeLawProblem& problem,
               const std::vector<PlanMethod>& methods, const std::string& name, Console& console) {
  ProgressLine progress(arguments.output, ProgressLine::Elsewhere::nothing);
  const LawStudy study = studies::study_laws(
      problem, methods, !arguments.page_path.empty(),
      [&](PlanMethod method, std::string_view stage, double done) {
        tell(progress, fmt::format("{}: {}", machine::kLawMethods.word(method), stage), done);
      });
  progress.erase();
  write_files(arguments, study, problem, name);
  const int code = study.good() ? kYes : kNo;
  if (console.options().json) {
    Json j = {{"kadr", KADR_VERSION}, {"command", "tube"}, {"file", name}, {"exit_code", code}};
    j["diagnostics"] = Json::array();
    j.update(studies::json_of(study, problem));
    console.document(j);
    return code;
  }
  if (!console.options().quiet) console.summary(tables(arguments, study, problem, name));
  note_times(arguments, study, console);
  return code;
}

}  // namespace

int solve_tube(const Arguments& arguments, Console& console) {
  if (arguments.list) return list_keys(studies::problem_keys(), console);
  if (arguments.files.empty()) {
    console.error(
        "PROBLEM is required, e.g. kadr tube docs/tube/laying.toml; kadr tube --keys lists the keys of one");
    return kNotStarted;
  }
  for (const std::string* file : {&arguments.csv_path, &arguments.page_path}) console.claim_output(*file);
  const std::string& path = arguments.files.front();
  const std::string name = program_text(path);
  SourceSet sources;
  const std::uint32_t file = load_settings(path, sources);
  const auto refuse = [&](const Diagnostics& diagnostics) {
    if (console.options().json)
      console.document({{"kadr", KADR_VERSION},
                        {"command", "tube"},
                        {"file", name},
                        {"exit_code", kNotStarted},
                        {"diagnostics", text::json_of(diagnostics, sources)}});
    else
      console.diagnostics(diagnostics, sources, name, Console::Where::errors);
    return kNotStarted;
  };
  const auto problem =
      studies::read_time_law_problem(sources, file, arguments.allowed_folders, arguments.bounds);
  if (!problem) return refuse(problem.error());
  if (!problem->warnings.list().empty())
    console.diagnostics(problem->warnings, sources, name, Console::Where::errors);
  const bool sweep = arguments.first_level > 0;
  TimeLawProblem sized = *problem;  // as large as it will get
  if (sweep) sized.tube.levels = arguments.last_level;
  const std::vector<PlanMethod> methods =
      sweep ? std::vector{PlanMethod::tube, PlanMethod::optimum} : chosen_methods(arguments, *problem);
  const bool keep_profiles = !arguments.page_path.empty();
  if (auto large = studies::check_size(sized, methods, keep_profiles && !sweep)) {
    Diagnostics diagnostics;
    diagnostics.add(std::move(*large));
    return refuse(diagnostics);
  }
  if (sweep) return sweep_tube(arguments, *problem, name, console);
  return study_tube(arguments, *problem, methods, name, console);
}

}  // namespace kadr::cli
