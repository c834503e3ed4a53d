#include "emulator/cli/options.h"

#include <fmt/format.h>

#include "emulator/cli/commands.h"

namespace kadr::cli {
namespace {

void add_info(Options& o) {
  CLI::App* sub =
      o.command(o.app, "info", log_info, "Tell what a log holds: run, channels, span in s, hashes");
  sub->add_option("LOG", o.arguments.files, "Logs written by kadr run")->required()->type_name("");
  o.output(sub);
}

/// Commands are compared to the last bit by ticks: only between places of the path there is something to
/// allow.
void check_diff(const Arguments& arguments) {
  const auto feed = static_cast<std::size_t>(emulator::ToleranceKey::feed);
  const emulator::Tolerances& tolerance = arguments.diff.tolerance;
  if (arguments.diff.align == emulator::DiffAlign::tick && (tolerance.linear[feed] || tolerance.rotary[feed]))
    throw CLI::ValidationError(
        "--tolerance feed goes with --align path: by tick, commands are compared exactly");
}

void add_diff(Options& o) {
  CLI::App* sub =
      o.command(o.app, "diff", diff_logs,
                "Compare two logs: the first control tick at which they differ, what differs, what is\n"
                "around it; exit 1 if anything but the inputs differs");
  sub->parse_complete_callback([&o] { check_diff(o.arguments); });
  for (const char* name : {"A", "B"})
    sub->add_option_function<std::string>(
           name, [&o](const std::string& file) { o.arguments.files.push_back(file); },
           "Log written by kadr run")
        ->required()
        ->type_name("");
  o.choice(sub, "--align", o.arguments.diff.align,
           {{"tick", emulator::DiffAlign::tick}, {"path", emulator::DiffAlign::path}},
           "What is put side by side: tick|path (path: same path length, whatever the override)")
      ->group("Options");
  o.repeated(
      sub, "--tolerance", "KEY=VALUE",
      "Allowed difference with unit, e.g. load=0.5um; keys load, base, link, base_rate, link_rate, force,\n"
      "and with --align path feed; default: none; repeatable",
      [&o](const std::string& text) { return emulator::add_tolerance(o.arguments.diff.tolerance, text); });
  o.repeated(
      sub, "--ignore", "CHANNEL/FIELD",
      "Leave out a channel (KADR_EVENT), a field (KADR_EVENT/text) or a group (load, feed); repeatable",
      [&o](const std::string& text) { return emulator::add_ignored(o.arguments.diff, text); });
  sub->add_option_function<std::string>(
         "--context",
         [&o](const std::string& text) {
           int& context = o.arguments.diff.context;
           if (!read_number(text, context) || context < 0 || context > emulator::kMostContext)
             throw CLI::ValidationError(fmt::format("--context takes a whole number from 0 to {}; got '{}'",
                                                    emulator::kMostContext, text));
         },
         "Control ticks shown before and after the first difference (default 2)")
      ->type_name("N");
  sub->add_flag("--all", o.arguments.diff.all, "Every difference, not only the first");
  sub->add_flag("--strict", o.arguments.strict, "Inputs that differ count too (exit 1)");
  o.output(sub);
  sub->footer("Example: kadr diff golden.lcmlog new.lcmlog --tolerance load=0.5um");
}

}  // namespace

void add_log_commands(Options& o) {
  add_info(o);
  add_diff(o);
}

}  // namespace kadr::cli
