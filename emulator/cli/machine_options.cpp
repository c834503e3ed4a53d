#include "emulator/cli/options.h"

#include "emulator/cli/commands.h"

namespace kadr::cli {
namespace {

void add_machine(Options& o) {
  CLI::App* group = o.app.add_subcommand("machine", "Show, check and make machine files");
  group->require_subcommand(1);
  CLI::App* show = o.command(*group, "show", machine_show,
                             "Print every value in force with unit and origin, as a machine file");
  show->add_option("MACHINE", o.arguments.machine, "Machine file or shipped name; default: mill3")
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
  CLI::App* make =
      o.command(*group, "new", machine_new, "Write NAME.toml, a commented machine file to start from");
  make->add_option("NAME", o.arguments.files, "Name of the new machine")
      ->required()
      ->expected(1)
      ->type_name("");
  make->add_option("--from", o.arguments.machine, "Machine to copy: file or shipped name; default: mill3")
      ->type_name("MACHINE");
  make->add_flag("--force", o.arguments.force, "Overwrite the file if it is there");
  o.output(make);
}

void add_explain(Options& o) {
  CLI::App* sub = o.command(o.app, "explain", explain_codes, "Explain a diagnostic at length");
  sub->add_option("CODE", o.arguments.files, "Codes such as K2107")->type_name("");
  sub->add_flag("--list", o.arguments.list, "List all codes");
  o.output(sub);
}

void add_scenario(Options& o) {
  CLI::App* group =
      o.app.add_subcommand("scenario", "Run scenarios: a program, a machine and what must come out");
  group->require_subcommand(1);
  CLI::App* run = o.command(*group, "run", scenario_run, "Run scenarios and compare; exit 1 if one fails");
  run->add_option("DIR", o.arguments.files, "Scenario files or folders; default: scenarios")->type_name("");
  run->add_option("--junit", o.arguments.junit_path,
                  "Write the results as JUnit XML (times in s of machine time)")
      ->type_name("FILE");
  run->add_flag("--update", o.arguments.update,
                "Write what was measured into the expectations of the scenario files");
  o.output(run);
  o.output(o.command(*group, "keys", machine_keys,
                     "List every key of a machine file: what it takes, its default and what it means"));
  CLI::App* check = o.command(*group, "check", scenario_check,
                              "Check scenario files and the machine files they name; nothing runs");
  check->add_option("DIR", o.arguments.files, "Scenario files or folders; default: scenarios")->type_name("");
  o.diagnostics(check);
  o.output(check);
  CLI::App* list = o.command(*group, "list", scenario_list, "List scenarios");
  list->add_option("DIR", o.arguments.files, "Scenario files or folders; default: scenarios")->type_name("");
  o.output(list);
}

}  // namespace

void add_machine_commands(Options& o) {
  add_machine(o);
  add_explain(o);
  add_scenario(o);
  o.output(o.command(o.app, "version", print_version, "Print version, compiler and log format"));
}

}  // namespace kadr::cli
