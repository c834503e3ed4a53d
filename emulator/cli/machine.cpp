#include <fmt/format.h>

#include <algorithm>

#include "emulator/answers/travel.h"
#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/inputs.h"
#include "emulator/cli/key_list.h"
#include "emulator/text/text.h"
#include "machine/base/terminal_text.h"

namespace kadr::cli {
namespace {

using text::Json;

std::string axis_letters(const machine::MachineModel& model) {
  std::string letters;
  for (const machine::AxisModel& axis : model.axis)
    letters += (letters.empty() ? "" : " ") + std::string(1, axis.letter);
  return letters;
}

/// First comment line of a shipped machine: what it is.
std::string description(std::string_view toml) {
  const std::string_view line = toml.substr(0, toml.find('\n'));
  if (line.empty() || line.front() != '#') return {};
  return text::one_line(line.substr(1), 100);
}

Json machine_json(const std::string& file, bool good, const machine::MachineFile& machine,
                  const Diagnostics& diagnostics, const SourceSet& sources) {
  Json j;
  j["file"] = file;
  j["exit_code"] = good ? kYes : kNo;
  j["name"] = good ? Json(machine.model.name) : Json(nullptr);
  j["axes"] = good ? Json(axis_letters(machine.model)) : Json(nullptr);
  j["diagnostics"] = text::json_of(diagnostics, sources);
  return j;
}

}  // namespace

int machine_show(const Arguments& arguments, Console& console) {
  SourceSet sources;
  machine::MachineFile machine;
  Diagnostics diagnostics;
  const bool good = load_machine(arguments.machine, arguments.settings, sources, machine, diagnostics);
  if (console.options().json) {
    Json j = machine_json(arguments.machine.empty() ? "mill3" : arguments.machine, good, machine, diagnostics,
                          sources);
    j["toml"] = good ? Json(machine::render_machine(machine)) : Json(nullptr);
    console.document(j);
  } else if (good) {
    console.data(machine::render_machine(machine));
  } else {
    console.diagnostics(diagnostics, sources, "the machine file", Console::Where::errors);
  }
  return good ? kYes : kNotStarted;
}

int machine_list(const Arguments&, Console& console) {
  using Align = text::TextTable::Align;
  text::TextTable table({{"machine", Align::left}, {"axes", Align::left}, {"what it is", Align::left}});
  Json list = Json::array();
  for (const std::string_view name : machine::shipped_machine_names()) {
    SourceSet sources;
    machine::MachineFile machine;
    Diagnostics diagnostics;
    load_machine(std::string(name), {}, sources, machine, diagnostics);
    const std::string axes = axis_letters(machine.model);
    const std::string what = description(machine::shipped_machine(name));
    table.add({std::string(name), axes, what});
    list.push_back({{"name", name}, {"axes", axes}, {"description", what}});
  }
  if (console.options().json)
    console.document(list);
  else
    console.data(table.render());
  return kYes;
}

int machine_keys(const Arguments&, Console& console) { return list_keys(machine::machine_keys(), console); }

int machine_check(const Arguments& arguments, Console& console) {
  int worst = kYes;
  Json documents = Json::array();
  for (const std::string& file : arguments.files) {
    SourceSet sources;
    machine::MachineFile machine;
    Diagnostics diagnostics;
    bool good = false;
    try {
      good = load_machine(file, {}, sources, machine, diagnostics);
    } catch (const WorldError& e) {
      console.error(e.what());
      worst = kNotStarted;
      continue;
    }
    worst = std::max(worst, good ? kYes : kNo);
    if (console.options().json) {
      documents.push_back(machine_json(file, good, machine, diagnostics, sources));
      continue;
    }
    console.diagnostics(diagnostics, sources, file, Console::Where::output);
    if (good && !console.options().quiet && console.options().format == DiagnosticFormat::human)
      console.data(fmt::format("{}: machine {}, axes {}: no errors\n", displayable(file),
                               displayable(machine.model.name), axis_letters(machine.model)));
  }
  if (console.options().json) console.document(documents);
  return worst;
}

}  // namespace kadr::cli
