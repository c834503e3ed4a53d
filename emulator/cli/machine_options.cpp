#include "emulator/cli/options.h"

#include "emulator/cli/commands.h"

namespace kadr::cli {
namespace {

/// Options of a data sheet, read by machine::read_data_sheet.
void add_data_sheet(CLI::App* make, Arguments& arguments) {
  machine::DataSheetWords& sheet = arguments.sheet;
  const auto word = [make](const char* name, std::string& value, const char* type, const char* description) {
    make->add_option(name, value, description)->type_name(type)->group("Data sheet");
  };
  word("--axes", sheet.axes, "LETTERS", "Axes of the machine, of X Y Z A B C U V W (default XYZ)");
  word("--travel", sheet.travel, "LENGTH,...",
       "Travel of the axes in mm (A B C: deg; inf: turns without end): a length, or LOW..HIGH in machine\n"
       "coordinates. A length runs from 0 up; for Z half below 0, half above");
  word("--max-speed", sheet.max_speed, "SPEED,...",
       "Rapid rate with its unit: mm/min, mm/s, m/min, in/min; A B C: deg/min, deg/s, rpm");
  word("--acceleration", sheet.acceleration, "ACC,...",
       "Acceleration, mm/s2 (A B C: deg/s2) unless it says m/s2 or g (default 500)");
  word("--jerk", sheet.jerk, "JERK,...",
       "Jerk, mm/s3 (A B C: deg/s3) unless it says m/s3; inf: acceleration jumps (default)");
  word("--steps-per-mm", sheet.steps, "N,...",
       "Motor steps per mm (A B C: per deg), microsteps included (default 400; A B C: 100)");
  word("--home", sheet.home, "POSITION,...",
       "Where an axis stands when a program begins, mm (A B C: deg), within its travel (default 0)");
  word("--tool-change", sheet.tool_change, "TIME", "Time that M6 takes, s unless it says min (default 0)");
  make->add_flag("--ask", arguments.ask,
                 "Ask for axes, travel, speed, acceleration, steps and tool change that are not given; needs "
                 "a\nterminal")
      ->group("Data sheet");
}

void add_machine_new(Options& o, CLI::App* group) {
  CLI::App* make = o.command(*group, "new", machine_new,
                             "Write NAME.toml, a commented machine file: from a data sheet's numbers, or a\n"
                             "copy of another machine");
  make->add_option("NAME", o.arguments.files, "Name of the new machine: letters, digits, _ and -")
      ->required()
      ->expected(1)
      ->type_name("");
  make->add_option("--from", o.arguments.machine, "Machine to copy: file or shipped name (default mill3)")
      ->type_name("FILE|NAME");
  make->add_flag("--force", o.arguments.force, "Overwrite the file if it exists");
  add_data_sheet(make, o.arguments);
  o.output(make);
  make->footer(
      "One value applies to all axes; a list with commas has one per axis, in the order of --axes. Without "
      "any\n"
      "data sheet option the file is a copy.\n"
      "Example: kadr machine new router --travel 800,800,80 --max-speed 5000mm/min --acceleration 200 "
      "--steps-per-mm 40");
}

void add_machine(Options& o) {
  CLI::App* group = o.app.add_subcommand("machine", "Show, check and make machine files");
  group->require_subcommand(1);
  CLI::App* show = o.command(*group, "show", machine_show,
                             "Print every value in force with unit and origin, as a machine file");
  show->add_option("MACHINE", o.arguments.machine, "Machine file or shipped name (default mill3)")
      ->type_name("");
  show->add_option("--set", o.arguments.settings, "Change one value, e.g. feed.max_mm_s=80; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->take_all();
  o.diagnostics(show);
  o.output(show);
  o.output(o.command(*group, "list", machine_list, "List the machines that ship with kadr"));
  o.output(o.command(*group, "keys", machine_keys,
                     "List every key of a machine file: what it takes, its default and what it means"));
  CLI::App* check = o.command(*group, "check", machine_check, "Check machine files");
  check->add_option("FILE", o.arguments.files, "Machine files")->required()->type_name("");
  o.diagnostics(check);
  o.output(check);
  add_machine_new(o, group);
}

void add_explain(Options& o) {
  CLI::App* sub = o.command(o.app, "explain", explain_codes, "Explain a diagnostic at length");
  sub->add_option("CODE", o.arguments.files, "Codes such as K2107")->type_name("");
  sub->add_flag("--list", o.arguments.list, "List all codes with their titles");
  o.output(sub);
}

void add_scenario(Options& o) {
  CLI::App* group =
      o.app.add_subcommand("scenario", "Run scenarios: a program, a machine and the expected results");
  group->require_subcommand(1);
  CLI::App* run = o.command(*group, "run", scenario_run, "Run scenarios and compare; exit 1 if one fails");
  run->add_option("DIR", o.arguments.files, "Scenario files or folders (default: scenarios)")->type_name("");
  run->add_option("--junit", o.arguments.junit_path,
                  "Also write the results as JUnit XML; its times are machine time in s")
      ->type_name("FILE");
  run->add_flag("--update", o.arguments.update,
                "Write the measured values into the expectations of the scenario files");
  o.limits(run);
  o.allow(run);
  o.output(run);
  CLI::App* check = o.command(*group, "check", scenario_check,
                              "Check scenario files and the machine files they name; nothing runs");
  check->add_option("DIR", o.arguments.files, "Scenario files or folders (default: scenarios)")
      ->type_name("");
  o.limits(check);
  o.allow(check);
  o.diagnostics(check);
  o.output(check);
  CLI::App* list = o.command(*group, "list", scenario_list, "List scenarios");
  list->add_option("DIR", o.arguments.files, "Scenario files or folders (default: scenarios)")->type_name("");
  o.allow(list);
  o.output(list);
}

}  // namespace

void add_machine_commands(Options& o) {
  add_machine(o);
  add_explain(o);
  add_scenario(o);
  o.output(o.command(o.app, "version", print_version,
                     "Print version, commit, compiler, libraries, log format and pages"));
}

}  // namespace kadr::cli
