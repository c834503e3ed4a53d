#include "emulator/cli/options.h"

#include <fmt/format.h>

#include <cmath>

#include "emulator/cli/commands.h"

namespace kadr::cli {
namespace {

void add_run(Options& o) {
  CLI::App* sub =
      o.command(o.app, "run", run_program, "Run a program: step pulses, motion of the machine, log, summary");
  o.programs(sub, "PROG", false)->required(false);
  sub->parse_complete_callback([&o] {
    if (o.arguments.files.empty() && o.arguments.scenario.empty()) throw CLI::RequiredError("PROG");
    if (!o.arguments.log && !o.arguments.log_path.empty())
      throw CLI::ValidationError(fmt::format(
          "--no-log writes no log, --log writes '{}': give only one of them", o.arguments.log_path));
  });
  o.machine(sub);
  o.reading(sub, Options::Writes::log);
  sub->add_option("-s,--scenario", o.arguments.scenario,
                  "Take PROG, machine and settings from this scenario where the command line gives none "
                  "(`kadr scenario\n"
                  "run` also compares its expectations)")
      ->type_name("FILE");
  sub->add_option("-o,--log", o.arguments.log_path,
                  "Log to write (default: PROG.lcmlog in the current folder)")
      ->type_name("LOG");
  sub->add_flag_function(
      "--no-log", [&o](std::int64_t) { o.arguments.log = false; }, "Write no log");
  sub->add_flag_function(
      "--no-plant", [&o](std::int64_t) { o.arguments.plant = false; },
      "Make step pulses only; do not simulate the flexible machine");
  sub->add_option_function<std::string>(
         "--until",
         [&o](const std::string& text) {
           double& value = o.arguments.until_s;
           if (!read_number(text, value) || !(value > 0) || !std::isfinite(value))
             throw CLI::ValidationError(
                 fmt::format("--until takes seconds of machine time above 0, e.g. 12.5; got '{}'", text));
         },
         "Stop after S seconds of machine time (default: run to the end)")
      ->type_name("S");
  sub->add_option_function<std::string>(
         "--threads",
         [&o](const std::string& text) {
           if (text != "1" && text != "2")
             throw CLI::ValidationError(fmt::format("--threads takes 1 or 2; got '{}'", text));
           o.arguments.threads = text == "1" ? 1 : 2;
         },
         "Threads, 1 or 2 (default 1); with 2, the second one writes the log. Same bytes either way")
      ->type_name("N");
  sub->add_option("--publish", o.arguments.publish_url,
                  "Also send the log live over LCM, e.g. to udpm://239.255.76.67:7667 (ttl 0 unless the URL "
                  "says ttl=N)")
      ->type_name("URL");
  o.strict(sub);
  o.progress(sub);
  o.diagnostics(sub);
  o.output(sub);
  o.words(sub->get_option("--threads"), {"1", "2"});
  sub->footer("Example: kadr run part.ngc -m winder4 --until 20 -o first20.lcmlog");
}

void add_check(Options& o) {
  CLI::App* sub =
      o.command(o.app, "check", check_programs,
                "Check programs: mistakes, time in s with acceleration, soft limits, what limits the feed");
  o.programs(sub, "PROG", true);
  o.machine(sub);
  o.reading(sub);
  o.strict(sub);
  o.diagnostics(sub);
  o.output(sub);
  sub->footer("Example: kadr check *.ngc --format gcc");
}

void add_plan(Options& o) {
  CLI::App* sub =
      o.command(o.app, "plan", plan_program,
                "Plan a program: a row per block with length in mm or deg, time in s, peak and end feed in\n"
                "mm/s or deg/s, and what limited it");
  o.programs(sub, "PROG", false);
  o.machine(sub);
  o.reading(sub);
  sub->add_flag("--csv", o.arguments.csv, "Write comma-separated values with full precision");
  o.strict(sub);
  o.diagnostics(sub);
  o.output(sub);
  sub->footer("Example: kadr plan part.ngc --csv > blocks.csv");
}

void read_lines(Arguments& arguments, const std::string& text) {
  const auto dash = text.find('-');
  std::uint32_t& first = arguments.first_line;
  std::uint32_t& last = arguments.last_line;
  bool good = read_number(text.substr(0, dash), first);
  last = first;
  if (dash != std::string::npos) good = good && read_number(text.substr(dash + 1), last);
  if (!good || first < 1 || last < first)
    throw CLI::ValidationError(fmt::format("--lines takes line numbers such as 10-40, got '{}'", text));
}

void add_canon(Options& o) {
  CLI::App* sub = o.command(
      o.app, "canon", canon_program,
      "Print what a program means: one machining call per line, machine coordinates in mm and deg,\n"
      "feeds in mm/min, dwells in s");
  o.programs(sub, "PROG", false);
  o.reading(sub);
  sub->add_option_function<std::string>(
         "--lines", [&o](const std::string& text) { read_lines(o.arguments, text); },
         "Print only the calls of these program lines, e.g. 10-40 or 12 (default: all)")
      ->type_name("FIRST-LAST");
  o.diagnostics(sub);
  o.output(sub);
}

void add_fmt(Options& o) {
  CLI::App* sub = o.command(o.app, "fmt", format_programs,
                            "Print programs in normal form: words in order of action, aligned comments,\n"
                            "indentation by O words; same lines, same meaning");
  o.programs(sub, "PROG", true);
  CLI::Option* check = sub->add_flag("--check", o.arguments.only_check,
                                     "Print only the names of programs that differ; exit 1 if there are any");
  sub->add_flag("-i,--in-place", o.arguments.in_place, "Rewrite the files that differ")->excludes(check);
  o.dialect(sub);
  o.limits(sub);
  o.diagnostics(sub);
  o.output(sub);
  sub->footer("Example: kadr fmt --check *.ngc");
}

}  // namespace

void add_program_commands(Options& o) {
  add_run(o);
  add_check(o);
  add_plan(o);
  add_canon(o);
  add_fmt(o);
}

}  // namespace kadr::cli
