#include "emulator/cli/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <string_view>

#include "emulator/cli/exit_codes.h"
#include "emulator/time_law/law_study.h"
#include "machine/base/parse_number.h"

namespace kadr::cli {
namespace {

/// Reads a whole text as a number, whatever the locale; `_` between digits is skipped as everywhere in kadr.
template <class T>
bool read_number(std::string text, T& value) {
  text.erase(std::remove(text.begin(), text.end(), '_'), text.end());
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

class Reader {
 public:
  Reader() : app_("kadr runs a control program on a simulated machine, exactly and repeatably.", "kadr") {
    app_.require_subcommand(1);
    app_.footer(
        "`kadr COMMAND --help` tells more. `-` is standard input. Data go to standard output, messages to "
        "standard\n"
        "error. Exit codes: 0 yes, 1 no (the program has errors), 2 could not start (usage, unreadable or "
        "bad file),\n"
        "3 the run ended with an alarm, 70 a fault of kadr, 130 and 143 stopped by a signal.");
    app_.set_version_flag("--version", "kadr " KADR_VERSION);
    add_run();
    add_check();
    add_plan();
    add_canon();
    add_fmt();
    add_info();
    add_diff();
    add_tube();
    add_machine();
    add_explain();
    add_scenario();
    add_wind();
    output(command(app_, "version", Command::version, "Print version, compiler and log format"));
  }

  std::variant<Arguments, int> read(int argc, const char* const* argv) {
    if (argc > 1 && argv[1][0] != '-' && !known(argv[1])) {
      fmt::print(stderr, "kadr: there is no command '{}'; commands: {}\n", argv[1], command_names(app_));
      return kNotStarted;
    }
    try {
      app_.parse(argc, argv);
      if (arguments_.command == Command::run && arguments_.files.empty() && arguments_.scenario.empty())
        throw CLI::RequiredError("PROG");
      if (arguments_.command == Command::diff) check_diff();
    } catch (const CLI::CallForHelp&) {
      const CLI::App* asked = &app_;
      std::string before;
      while (!asked->get_subcommands().empty()) {
        before += (before.empty() ? "" : " ") + asked->get_name();
        asked = asked->get_subcommands().front();
      }
      fmt::print("{}", asked->help(before));
      return kYes;
    } catch (const CLI::Success& e) {
      fmt::print("{}\n", e.what());
      return kYes;
    } catch (const CLI::ParseError& e) {
      const CLI::App* asked = &app_;
      std::string name = "kadr";
      while (!asked->get_subcommands().empty()) {
        asked = asked->get_subcommands().front();
        name += ' ' + asked->get_name();
      }
      std::string complaint = e.what();
      if (const std::string names = command_names(*asked); !names.empty())
        complaint = "which command? " + names;
      fmt::print(stderr, "{}: {}\n{} --help tells more\n", name, complaint, name);
      return kNotStarted;
    }
    return arguments_;
  }

 private:
  CLI::App* command(CLI::App& parent, const std::string& name, Command value,
                    const std::string& description) {
    CLI::App* sub = parent.add_subcommand(name, description);
    sub->callback([this, value] { arguments_.command = value; });
    return sub;
  }

  void output(CLI::App* sub) {
    OutputOptions& out = arguments_.output;
    sub->add_flag("--json", out.json, "One JSON document on standard output; keys carry units")
        ->group("Output");
    sub->add_flag("-q,--quiet", out.quiet, "Only data and errors: no notes, no progress, no tables")
        ->group("Output");
    choice(sub, "--color", out.color,
           {{"auto", When::automatic}, {"always", When::always}, {"never", When::never}},
           "Colour messages: auto|always|never (auto: on a terminal; NO_COLOR and CLICOLOR_FORCE are kept)");
  }

  void diagnostics(CLI::App* sub) {
    OutputOptions& out = arguments_.output;
    choice(sub, "--format", out.format,
           {{"human", DiagnosticFormat::human},
            {"gcc", DiagnosticFormat::gcc},
            {"json", DiagnosticFormat::json},
            {"sarif", DiagnosticFormat::sarif}},
           "Form of diagnostics: human|gcc|json|sarif (json: one object a line; sarif: one SARIF 2.1.0 "
           "document)");
    sub->add_option("--max-errors", out.max_errors,
                    "Show that many diagnostics, 0: all (default 20; all with sarif)")
        ->type_name("N")
        ->group("Output");
  }

  void progress(CLI::App* sub) {
    choice(
        sub, "--progress", arguments_.output.progress,
        {{"auto", ProgressMode::automatic}, {"never", ProgressMode::never}, {"plain", ProgressMode::plain}},
        "Progress on standard error: auto|never|plain (auto: a bar on a terminal, else a line every 10 s)");
  }

  template <class Enum>
  CLI::Option* choice(CLI::App* sub, const std::string& name, Enum& value, std::map<std::string, Enum> names,
                      const std::string& description) {
    return sub
        ->add_option_function<std::string>(
            name,
            [&value, names, name](const std::string& text) {
              const auto it = names.find(text);
              if (it == names.end()) {
                std::string known;
                for (const auto& entry : names) known += (known.empty() ? "" : ", ") + entry.first;
                throw CLI::ValidationError(fmt::format("{} knows {}; got '{}'", name, known, text));
              }
              value = it->second;
            },
            description)
        ->type_name("WORD")
        ->group("Output");
  }

  void machine(CLI::App* sub) {
    sub->add_option("-m,--machine", arguments_.machine,
                    "Machine file, or the name of a shipped machine (`kadr machine list`); default: mill3")
        ->type_name("FILE|NAME");
    sub->add_option("--set", arguments_.settings,
                    "Change one value of the machine file, e.g. feed.max_mm_s=80; repeatable")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false)
        ->take_all();
  }

  void reading(CLI::App* sub) {
    sub->add_flag("--block-delete", arguments_.block_delete, "Leave out lines that begin with /");
    sub->add_option("--subs", arguments_.sub_folders,
                    "Folder in which called files are looked for after the program's own; repeatable")
        ->type_name("DIR")
        ->allow_extra_args(false)
        ->take_all();
    sub->add_option_function<std::vector<std::string>>(
           "--limit",
           [this](const std::vector<std::string>& texts) {
             for (const std::string& text : texts) limit(text);
           },
           "Bound on a program: blocks, call_depth, loop_passes, file_bytes, line_bytes; 0: none; repeatable")
        ->type_name("NAME=N")
        ->allow_extra_args(false)
        ->take_all();
    sub->add_option("--tools", arguments_.tools,
                    "Tool table, LinuxCNC's .tbl text with lengths in mm; default: tools without length")
        ->type_name("TABLE");
    sub->add_option_function<std::string>(
           "--dialect",
           [this](const std::string& text) {
             arguments_.dialect = gcode::dialect_of(text);
             if (!arguments_.dialect)
               throw CLI::ValidationError(
                   fmt::format("--dialect knows linuxcnc, grbl, marlin, fanuc; got '{}'", text));
           },
           "How codes that controllers read differently are meant: linuxcnc|grbl|marlin|fanuc")
        ->type_name("WORD");
  }

  /// NAME=N of --limit.
  void limit(const std::string& text) {
    const auto equals = text.find('=');
    const std::string name = text.substr(0, equals);
    std::uint64_t value = 0;
    const bool number = equals != std::string::npos && read_number(text.substr(equals + 1), value);
    if (!number || !gcode::set_bound(arguments_.bounds, name, value))
      throw CLI::ValidationError(fmt::format(
          "--limit takes NAME=N with NAME one of {} (0: no bound); got '{}'", gcode::kBoundNames, text));
  }

  void strict(CLI::App* sub) {
    sub->add_flag("--strict", arguments_.strict, "Warnings count as errors (exit 1)");
  }

  CLI::Option* programs(CLI::App* sub, const std::string& name, bool several) {
    CLI::Option* option = sub->add_option(name, arguments_.files,
                                          several ? "Control programs; `-`: standard input"
                                                  : "Control program; `-`: standard input")
                              ->required();
    if (!several) option->expected(1);
    return option->type_name("");
  }

  void add_run() {
    CLI::App* sub =
        command(app_, "run", Command::run, "Run a program: step pulses, motion of the machine, log, summary");
    programs(sub, "PROG", false)->required(false);
    machine(sub);
    reading(sub);
    sub->add_option(
           "-s,--scenario", arguments_.scenario,
           "Scenario: gives PROG, machine and settings that the command line does not (`kadr scenario run`\n"
           "compares its expectations)")
        ->type_name("FILE");
    sub->add_option("-o,--log", arguments_.log_path,
                    "Log to write; default: PROG.lcmlog in the current folder")
        ->type_name("LOG");
    sub->add_flag_function(
        "--no-log", [this](std::int64_t) { arguments_.log = false; }, "Write no log");
    sub->add_flag_function(
        "--no-plant", [this](std::int64_t) { arguments_.plant = false; },
        "Step pulses only; do not simulate the flexible machine");
    sub->add_option_function<std::string>(
           "--until",
           [this](const std::string& text) {
             double& value = arguments_.until_s;
             if (!read_number(text, value) || !(value > 0) || !std::isfinite(value))
               throw CLI::ValidationError(
                   fmt::format("--until takes seconds of machine time above 0, e.g. 12.5; got '{}'", text));
           },
           "Stop after that many seconds of machine time")
        ->type_name("S");
    sub->add_option("--threads", arguments_.threads, "1, or 2: a second thread writes the log; same bytes")
        ->type_name("N")
        ->check([](const std::string& text) {
          return text == "1" || text == "2" ? std::string() : "takes 1 or 2, got '" + text + "'";
        });
    sub->add_option(
           "--publish", arguments_.publish_url,
           "Send the log live over LCM besides, e.g. udpm://239.255.76.67:7667 (ttl 0 unless it says ttl=N)")
        ->type_name("URL");
    strict(sub);
    progress(sub);
    diagnostics(sub);
    output(sub);
    sub->footer("Example: kadr run part.ngc -m winder4 --until 20 -o first20.lcmlog");
  }

  void add_check() {
    CLI::App* sub =
        command(app_, "check", Command::check,
                "Check programs: mistakes, time in s with acceleration, soft limits, what limits the feed");
    programs(sub, "PROG", true);
    machine(sub);
    reading(sub);
    strict(sub);
    diagnostics(sub);
    output(sub);
    sub->footer("Example: kadr check *.ngc --format gcc");
  }

  void add_plan() {
    CLI::App* sub =
        command(app_, "plan", Command::plan,
                "Plan a program: a row a block with length in mm or deg, time in s, peak and end feed in\n"
                "mm/s or deg/s, and what limited it");
    programs(sub, "PROG", false);
    machine(sub);
    reading(sub);
    sub->add_flag("--csv", arguments_.csv, "Comma-separated values with full precision");
    strict(sub);
    diagnostics(sub);
    output(sub);
    sub->footer("Example: kadr plan part.ngc --csv > blocks.csv");
  }

  void add_canon() {
    CLI::App* sub =
        command(app_, "canon", Command::canon,
                "Print what a program means: one machining call a line, machine coordinates in mm and deg,\n"
                "feeds in mm/min, dwells in s");
    programs(sub, "PROG", false);
    reading(sub);
    sub->add_option_function<std::string>(
           "--lines", [this](const std::string& text) { read_lines(text); },
           "Only calls of these program lines")
        ->type_name("FIRST-LAST");
    diagnostics(sub);
    output(sub);
  }

  void add_fmt() {
    CLI::App* sub = command(app_, "fmt", Command::fmt,
                            "Print programs in normal form: words in order of action, aligned comments,\n"
                            "indentation by O words; same lines, same meaning");
    programs(sub, "PROG", true);
    CLI::Option* check =
        sub->add_flag("--check", arguments_.only_check,
                      "Print only the names of programs that differ; exit 1 if there are any");
    sub->add_flag("-i,--in-place", arguments_.in_place, "Rewrite the files that differ")->excludes(check);
    diagnostics(sub);
    output(sub);
    sub->footer("Example: kadr fmt --check *.ngc");
  }

  void read_lines(const std::string& text) {
    const auto dash = text.find('-');
    std::uint32_t& first = arguments_.first_line;
    std::uint32_t& last = arguments_.last_line;
    bool good = read_number(text.substr(0, dash), first);
    last = first;
    if (dash != std::string::npos) good = good && read_number(text.substr(dash + 1), last);
    if (!good || first < 1 || last < first)
      throw CLI::ValidationError(fmt::format("--lines takes line numbers such as 10-40, got '{}'", text));
  }

  void add_info() {
    CLI::App* sub =
        command(app_, "info", Command::info, "Tell what a log holds: run, channels, span in s, hashes");
    sub->add_option("LOG", arguments_.files, "Logs written by kadr run")->required()->type_name("");
    output(sub);
  }

  void add_diff() {
    CLI::App* sub =
        command(app_, "diff", Command::diff,
                "Compare two logs: the first control tick at which they differ, what differs, what is\n"
                "around it; exit 1 if anything but the inputs differs");
    for (const char* name : {"A", "B"})
      sub->add_option_function<std::string>(
             name, [this](const std::string& file) { arguments_.files.push_back(file); },
             "Log written by kadr run")
          ->required()
          ->type_name("");
    choice(sub, "--align", arguments_.diff.align,
           {{"tick", emulator::DiffAlign::tick}, {"path", emulator::DiffAlign::path}},
           "What is put side by side: tick|path (path: same path length, whatever the override)")
        ->group("Options");
    repeated(
        sub, "--tolerance", "KEY=VALUE",
        "Allowed difference with unit, e.g. load=0.5um; keys load, base, link, base_rate, link_rate, force,\n"
        "and with --align path feed; default: none; repeatable",
        [this](const std::string& text) { return emulator::add_tolerance(arguments_.diff.tolerance, text); });
    repeated(
        sub, "--ignore", "CHANNEL/FIELD",
        "Leave out a channel (KADR_EVENT), a field (KADR_EVENT/text) or a group (load, feed); repeatable",
        [this](const std::string& text) { return emulator::add_ignored(arguments_.diff, text); });
    sub->add_option_function<std::string>(
           "--context",
           [this](const std::string& text) {
             int& context = arguments_.diff.context;
             if (!read_number(text, context) || context < 0 || context > emulator::kMostContext)
               throw CLI::ValidationError(fmt::format("--context takes a whole number from 0 to {}; got '{}'",
                                                      emulator::kMostContext, text));
           },
           "Control ticks shown before and after the first difference (default 2)")
        ->type_name("N");
    sub->add_flag("--all", arguments_.diff.all, "Every difference, not only the first");
    sub->add_flag("--strict", arguments_.strict, "Inputs that differ count too (exit 1)");
    output(sub);
    sub->footer("Example: kadr diff golden.lcmlog new.lcmlog --tolerance load=0.5um");
  }

  void add_tube() {
    CLI::App* sub =
        command(app_, "tube", Command::tube,
                "Find time laws along a stated path by several methods: times in s, how far from\n"
                "the best, smoothness, what the check found; exit 1 if a law breaks a limit");
    sub->add_option("PROBLEM", arguments_.files, "Problem file (docs/time_law.md); `-`: standard input")
        ->required()
        ->expected(1)
        ->type_name("");
    repeated(sub, "--method", "NAME",
             fmt::format("Only this method: {};\nrepeatable; default: all that the problem states",
                         fmt::join(emulator::kLawMethods, ", ")),
             [this](const std::string& text) -> tl::expected<void, std::string> {
               if (!emulator::method_of(text))
                 return tl::unexpected(
                     fmt::format("knows {}; got '{}'", fmt::join(emulator::kLawMethods, ", "), text));
               arguments_.methods.push_back(text);
               return {};
             });
    sub->add_option(
           "--csv", arguments_.csv_path,
           "Write a row a node: s in mm, highest speed and what holds it, speed in mm/s and time in s\n"
           "of every law")
        ->type_name("FILE");
    sub->add_option("--page", arguments_.page_path, "Write charts and tables as one HTML file")
        ->type_name("FILE");
    sub->add_flag("--timing", arguments_.timing, "A column of wall times; two runs are then not the same");
    diagnostics(sub);
    output(sub);
    sub->footer("Example: kadr tube docs/tube/laying.toml --page laying.html");
  }

  /// An option whose every value is handed to `take`, which may find fault with it.
  void repeated(CLI::App* sub, const std::string& name, const char* type, const std::string& description,
                std::function<tl::expected<void, std::string>(const std::string&)> take) {
    sub->add_option_function<std::vector<std::string>>(
           name,
           [name, take](const std::vector<std::string>& texts) {
             for (const std::string& text : texts)
               if (const auto taken = take(text); !taken)
                 throw CLI::ValidationError(fmt::format("{} {}", name, taken.error()));
           },
           description)
        ->type_name(type)
        ->allow_extra_args(false)
        ->take_all();
  }

  void add_machine() {
    CLI::App* group = app_.add_subcommand("machine", "Show, check and make machine files");
    group->require_subcommand(1);
    CLI::App* show = command(*group, "show", Command::machine_show,
                             "Print every value in force with unit and origin, as a machine file");
    show->add_option("MACHINE", arguments_.machine, "Machine file or shipped name; default: mill3")
        ->type_name("");
    show->add_option("--set", arguments_.settings, "Change one value, e.g. feed.max_mm_s=80; repeatable")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false)
        ->take_all();
    diagnostics(show);
    output(show);
    output(command(*group, "list", Command::machine_list, "List the machines that ship with kadr"));
    CLI::App* check = command(*group, "check", Command::machine_check, "Check machine files");
    check->add_option("FILE", arguments_.files, "Machine files")->required()->type_name("");
    diagnostics(check);
    output(check);
    CLI::App* make = command(*group, "new", Command::machine_new,
                             "Write NAME.toml, a commented machine file to start from");
    make->add_option("NAME", arguments_.files, "Name of the new machine")
        ->required()
        ->expected(1)
        ->type_name("");
    make->add_option("--from", arguments_.machine, "Machine to copy: file or shipped name; default: mill3")
        ->type_name("MACHINE");
    make->add_flag("--force", arguments_.force, "Overwrite the file if it is there");
    output(make);
  }

  void add_explain() {
    CLI::App* sub = command(app_, "explain", Command::explain, "Explain a diagnostic at length");
    sub->add_option("CODE", arguments_.files, "Codes such as K2107")->type_name("");
    sub->add_flag("--list", arguments_.list, "List all codes");
    output(sub);
  }

  void add_scenario() {
    CLI::App* group =
        app_.add_subcommand("scenario", "Run scenarios: a program, a machine and what must come out");
    group->require_subcommand(1);
    CLI::App* run =
        command(*group, "run", Command::scenario_run, "Run scenarios and compare; exit 1 if one fails");
    run->add_option("DIR", arguments_.files, "Scenario files or folders; default: scenarios")->type_name("");
    run->add_option("--junit", arguments_.junit_path,
                    "Write the results as JUnit XML (times in s of machine time)")
        ->type_name("FILE");
    run->add_flag("--update", arguments_.update,
                  "Write what was measured into the expectations of the scenario files");
    output(run);
    CLI::App* check = command(*group, "check", Command::scenario_check,
                              "Check scenario files and the machine files they name; nothing runs");
    check->add_option("DIR", arguments_.files, "Scenario files or folders; default: scenarios")
        ->type_name("");
    diagnostics(check);
    output(check);
    CLI::App* list = command(*group, "list", Command::scenario_list, "List scenarios");
    list->add_option("DIR", arguments_.files, "Scenario files or folders; default: scenarios")->type_name("");
    output(list);
  }

  void add_wind() {
    CLI::App* group = app_.add_subcommand("wind", "Write a filament-winding program for axes X Y A B");
    group->require_subcommand(1);
    group->footer(
        "X: carriage, Y: eye (distance from the mandrel's axis), A: mandrel, B: eye roll. Feed is inverse "
        "time (G93).\n`kadr wind hoop --help` lists the parameters.");
    for (const scenarios::WindKind& kind : scenarios::wind_kinds()) {
      CLI::App* sub = group->add_subcommand(std::string(kind.name), std::string(kind.meaning));
      sub->callback([this, &kind] {
        arguments_.command = Command::wind;
        arguments_.wind_kind = kind.name;
      });
      for (const scenarios::WindParameter& p : kind.parameters) wind_parameter(sub, p);
      sub->add_option("-o,--output", arguments_.program_path, "Program to write; default: standard output")
          ->type_name("FILE");
      output(sub);
      sub->footer(fmt::format("Example: kadr wind {0} --length-mm 120 -o {0}.ngc", kind.name));
    }
  }

  /// Bounds are left to the generator, which knows those that hang on other parameters too.
  void wind_parameter(CLI::App* sub, const scenarios::WindParameter& p) {
    const std::string flag = scenarios::wind_flag(p.key);
    sub->add_option_function<std::string>(
           flag,
           [this, &p, flag](const std::string& text) {
             const auto value = parse_number(text);
             if (!value) throw CLI::ValidationError(fmt::format("{} takes a number; got '{}'", flag, text));
             arguments_.wind_settings.emplace_back(p.key, *value);
           },
           fmt::format("{}; {}{} to {} (default {})", p.meaning, p.whole ? "whole, " : "",
                       number_text(p.least), number_text(p.most), number_text(p.preset)))
        ->type_name("N");
  }

  /// Commands are compared to the last bit by ticks: only between places of the path there is something to
  /// allow.
  void check_diff() const {
    const auto feed = static_cast<std::size_t>(emulator::ToleranceKey::feed);
    const emulator::Tolerances& tolerance = arguments_.diff.tolerance;
    if (arguments_.diff.align == emulator::DiffAlign::tick &&
        (tolerance.linear[feed] || tolerance.rotary[feed]))
      throw CLI::ValidationError(
          "--tolerance feed goes with --align path: by tick, commands are compared exactly");
  }

  static std::string command_names(const CLI::App& app) {
    std::string names;
    for (const CLI::App* sub : app.get_subcommands({}))
      names += (names.empty() ? "" : ", ") + sub->get_name();
    return names;
  }
  bool known(const std::string& name) const {
    const auto all = app_.get_subcommands({});
    return std::any_of(all.begin(), all.end(), [&](const CLI::App* sub) { return sub->get_name() == name; });
  }

  CLI::App app_;
  Arguments arguments_;
};

}  // namespace

std::variant<Arguments, int> read_arguments(int argc, const char* const* argv) {
  return Reader().read(argc, argv);
}

}  // namespace kadr::cli
