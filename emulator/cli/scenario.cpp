#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/result_file.h"
#include "emulator/scenario/scenario.h"
#include "emulator/text/text.h"
#include "machine/base/terminal_text.h"

namespace kadr::cli {
namespace {

using text::Json;
namespace fs = std::filesystem;

/// Where `cmake --install` put the scenarios of this kadr.
std::string installed_scenarios() {
  std::error_code unknown;
  const fs::path kadr = fs::read_symlink("/proc/self/exe", unknown);
  const fs::path folder = kadr.parent_path().parent_path() / "share/kadr/scenarios";
  return !unknown && fs::is_directory(folder, unknown) ? folder.string() : "PREFIX/share/kadr/scenarios";
}

/// @throws WorldError if there is none, with the paths tried
std::vector<InputFile> scenarios_of(const Arguments& arguments) {
  try {
    return scenario::find_scenarios(arguments.files, arguments.allowed_folders);
  } catch (const fs::filesystem_error& e) {
    const std::string path = e.path1().string();
    if (e.code() != std::errc::no_such_file_or_directory)
      throw WorldError(fmt::format("scenario {}: {}", path, e.code().message()));
    throw WorldError(fmt::format(
        "there is no scenario file {0}, {0}/scenario.toml or {0}/*/scenario.toml; give a scenario "
        "file or a folder; installed scenarios are in {1}",
        path, installed_scenarios()));
  }
}

/// Rewrites the expectations of a scenario with the measured values.
void update(const InputFile& file, const std::vector<std::string>& allowed,
            const scenario::ScenarioResult& result, Console& console) {
  SourceSet sources;
  const auto scenario = scenario::read_scenario(file, sources, allowed);
  if (!scenario || !result.failure.empty()) return;
  const std::string text = scenario::updated_text(*scenario, result);
  if (text == scenario->text) return;
  write_file(scenario->file, text, {.own_input = true});
  console.note(fmt::format("updated {}", scenario->file));
}

}  // namespace

int scenario_run(const Arguments& arguments, Console& console) {
  console.claim_output(arguments.junit_path);
  std::vector<scenario::ScenarioResult> results;
  bool all_passed = true, all_ran = true;
  for (const InputFile& file : scenarios_of(arguments)) {
    results.push_back(scenario::run_scenario(file, {}, arguments.allowed_folders, arguments.bounds));
    const scenario::ScenarioResult& result = results.back();
    all_passed = all_passed && result.passed();
    all_ran = all_ran && result.failure.empty();
    if (arguments.update) update(file, arguments.allowed_folders, result, console);
    if (console.options().json || (console.options().quiet && result.passed())) continue;
    std::string text = scenario::render_result(result);
    if (text.empty() || text.back() != '\n') text += '\n';
    console.summary(text);
  }
  if (console.options().json) {
    std::string text = scenario::render_json(results);
    if (text.empty() || text.back() != '\n') text += '\n';
    console.data(text);
  } else if (!console.options().quiet) {
    std::string text = scenario::render_totals(results);
    if (text.empty() || text.back() != '\n') text += '\n';
    console.summary(text);
  }
  if (!arguments.junit_path.empty()) write_file(arguments.junit_path, scenario::render_junit(results));
  // expectations that were not met are now those that were measured; one that did not run has measured nothing
  return all_passed || (arguments.update && all_ran) ? kYes : kNo;
}

int scenario_check(const Arguments& arguments, Console& console) {
  const bool tells = !console.options().json && !console.options().quiet &&
                     console.options().format == DiagnosticFormat::human;
  Json documents = Json::array();
  int worst = kYes;
  for (const InputFile& file : scenarios_of(arguments)) {
    const std::string& path = file.path;
    SourceSet sources;
    cycle::JobInputs given;
    given.reading.bounds = arguments.bounds;
    Diagnostics diagnostics;
    std::optional<scenario::Scenario> scenario;
    int code = kNo;
    try {
      if (auto read = scenario::read_scenario(file, sources, arguments.allowed_folders)) {
        scenario = std::move(*read);
        if (scenario::open_job(*scenario, given, sources, diagnostics)) code = kYes;
      } else {
        diagnostics.add(read.error());
      }
    } catch (const std::system_error& e) {
      // the other scenarios are still checked
      console.error(scenario ? fmt::format("{}: {}", path, e.what()) : std::string(e.what()));
      code = kNotStarted;
    }
    worst = std::max(worst, code);
    if (console.options().json) {
      documents.push_back(
          {{"file", path}, {"exit_code", code}, {"diagnostics", text::json_of(diagnostics, sources)}});
      continue;
    }
    console.diagnostics(diagnostics, sources, path, Console::Where::output);
    if (code == kYes && tells)
      console.data(fmt::format("{}: scenario {}, program {}, machine {}: no errors\n", displayable(path),
                               displayable(scenario->name), displayable(scenario->program_name),
                               displayable(given.machine.model.name)));
  }
  if (console.options().json) console.document(documents);
  return worst;
}

int scenario_list(const Arguments& arguments, Console& console) {
  using Align = text::TextTable::Align;
  text::TextTable table({{"scenario", Align::left},
                         {"machine", Align::left},
                         {"program", Align::left},
                         {"what it shows", Align::left}});
  Json list = Json::array();
  int code = kYes;
  for (const InputFile& file : scenarios_of(arguments)) {
    const std::string& path = file.path;
    SourceSet sources;
    std::optional<scenario::Scenario> scenario;
    try {
      if (auto read = scenario::read_scenario(file, sources, arguments.allowed_folders))
        scenario = std::move(*read);
      else
        console.diagnostics(read.error(), sources, path, Console::Where::errors);
    } catch (const std::system_error& e) {
      // the other scenarios are still listed
      console.error(e.what());
      code = kNotStarted;
    }
    if (!scenario) {
      code = std::max(code, kNo);
      continue;
    }
    table.add(
        {scenario->name, scenario->machine, scenario->program_name, text::one_line(scenario->summary, 200)});
    list.push_back({{"name", scenario->name},
                    {"file", scenario->file},
                    {"machine", scenario->machine},
                    {"program", scenario->program_name},
                    {"summary", scenario->summary}});
  }
  if (console.options().json)
    console.document(list);
  else
    console.data(table.render());
  return code;
}

}  // namespace kadr::cli
