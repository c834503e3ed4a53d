#include "emulator/cli/options.h"

#include <fmt/format.h>

#include "emulator/cli/commands.h"

namespace kadr::cli {
namespace {

void add_info(Options& o) {
  CLI::App* sub =
      o.command(o.app, "info", log_info, "Show what a log contains: run, channels, span in s, hashes");
  sub->add_option("LOG", o.arguments.files, "Logs written by kadr run")->required()->type_name("");
  o.output(sub);
}

/// Commands are compared to the last bit by ticks; only a comparison by path can have a tolerance.
void check_diff(const Arguments& arguments) {
  const auto feed = static_cast<std::size_t>(log::ToleranceKey::feed);
  const log_tools::Tolerances& tolerance = arguments.diff.tolerance;
  if (arguments.diff.align == log_tools::DiffAlign::tick &&
      (tolerance.linear[feed] || tolerance.rotary[feed]))
    throw CLI::ValidationError("--tolerance feed needs --align path: by tick, commands are compared exactly");
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
  o.choice(sub, "--align", o.arguments.diff.align, log_tools::kDiffAligns,
           fmt::format(
               "Compare at the same tick or at the same path length: {} (default tick; path: whatever the\n"
               "override)",
               log_tools::kDiffAligns.list("|")))
      ->group("Options");
  o.repeated(
      sub, "--tolerance", "KEY=VALUE",
      "Allow a difference, with unit, e.g. load=0.5um; keys: load, base, link, base_rate, link_rate, force,\n"
      "and with --align path feed; repeatable (default: none allowed)",
      [&o](const std::string& text) { return log_tools::add_tolerance(o.arguments.diff.tolerance, text); });
  o.words(sub->get_option("--tolerance"),
          {"load=", "base=", "link=", "base_rate=", "link_rate=", "force=", "feed="});
  o.repeated(
      sub, "--ignore", "CHANNEL/FIELD",
      "Leave out a channel (KADR_EVENT), a field (KADR_EVENT/text) or a group (load, feed); repeatable",
      [&o](const std::string& text) { return log_tools::add_ignored(o.arguments.diff, text); });
  sub->add_option_function<std::string>(
         "--context",
         [&o](const std::string& text) {
           int& context = o.arguments.diff.context;
           if (!read_number(text, context) || context < 0 || context > log_tools::kMostContext)
             throw CLI::ValidationError(fmt::format("--context takes a whole number from 0 to {}; got '{}'",
                                                    log_tools::kMostContext, text));
         },
         fmt::format("Control ticks to show before and after the first difference, 0 to {} (default 2)",
                     log_tools::kMostContext))
      ->type_name("N");
  sub->add_flag("--all", o.arguments.diff.all, "Show every difference, not only the first");
  sub->add_flag("--strict", o.arguments.strict, "Count differing inputs, too (exit 1)");
  o.output(sub);
  sub->footer("Example: kadr diff golden.lcmlog new.lcmlog --tolerance load=0.5um");
}

/// A number of at least `least`.
std::function<void(const std::string&)> number_option(const char* name, double& value, double least) {
  return [name, &value, least](const std::string& text) {
    if (!read_number(text, value) || !(value >= least) || value > 1e15)
      throw CLI::ValidationError(
          fmt::format("{} takes a number of at least {}; got '{}'", name, least, text));
  };
}

std::function<void(const std::string&)> cells_option(const char* name, int& value, int least) {
  return [name, &value, least](const std::string& text) {
    if (!read_number(text, value) || value < least || value > 1000)
      throw CLI::ValidationError(
          fmt::format("{} takes a whole number from {} to 1000; got '{}'", name, least, text));
  };
}

/// Which signals, and which part of the run.
void add_choice(Options& o, CLI::App* sub, const char* signals_help) {
  log_tools::SampleChoice& choice = o.arguments.exported.choice;
  sub->add_option("--signals", choice.signals, signals_help)->type_name("NAME,...");
  sub->add_option_function<std::string>("--from", number_option("--from", choice.from_s, 0),
                                        "Begin at this time of the run, s (default 0)")
      ->type_name("S");
  sub->add_option_function<std::string>("--to", number_option("--to", choice.to_s, 0),
                                        "End at this time of the run, s (default: its end)")
      ->type_name("S");
}

void add_export(Options& o) {
  ExportOptions& out = o.arguments.exported;
  CLI::App* sub = o.command(o.app, "export", export_log,
                            "Write a log in a form that other tools read: CSV, JSON lines, VCD, SVG");
  sub->add_option("LOG", o.arguments.files, "Log written by kadr run")
      ->required()
      ->expected(1)
      ->type_name("");
  CLI::Option_group* forms = sub->add_option_group("Form");
  forms->add_flag_callback(
      "--csv", [&out] { out.form = ExportForm::csv; },
      "CSV with comma and decimal point, a row per control tick");
  forms->add_flag_callback(
      "--excel", [&out] { out.form = ExportForm::excel; },
      "CSV with semicolon, decimal comma and byte order mark, for spreadsheets");
  forms->add_flag_callback(
      "--json", [&out] { out.form = ExportForm::json; },
      "JSON lines, an object per line: run, blocks, events, samples, summary");
  forms->add_flag_callback(
      "--vcd", [&out] { out.form = ExportForm::vcd; },
      "Value change dump: step and direction wires, chosen signals as reals");
  forms->add_flag_callback(
      "--svg", [&out] { out.form = ExportForm::svg; }, "SVG: charts over time");
  forms->add_flag("--list", o.arguments.list,
                  "List the log's signals with their units, and what the values of codes mean");
  forms->require_option(1);
  add_choice(o, sub,
             "Signals, `*` for any text, e.g. 'feed.*,axis.X.load_mm' (default: all; vcd, svg: a few)");
  sub->add_option_function<std::string>(
         "--rate-hz", number_option("--rate-hz", out.choice.rate_hz, 1e-6),
         "Take every n-th control tick, as near to this rate in Hz as possible (default: every one)")
      ->type_name("HZ");
  sub->add_option("-o,--output", out.output_path, "File to write (default: standard output)")
      ->type_name("FILE");
  sub->add_flag("-q,--quiet", o.arguments.output.quiet, "Only data and errors")->group("Output");
  sub->footer("Example: kadr export part.lcmlog --csv --signals 'feed.*' --rate-hz 100 -o part.csv");
}

void add_plot(Options& o) {
  ExportOptions& out = o.arguments.exported;
  CLI::App* sub =
      o.command(o.app, "plot", plot_log, "Draw a log in the terminal: signals over time, or the path");
  sub->add_option("LOG", o.arguments.files, "Log written by kadr run")
      ->required()
      ->expected(1)
      ->type_name("");
  add_choice(o, sub, "Signals, `*` for any text (default: feed and path error)");
  sub->add_flag("--path", out.path, "Draw the commanded path, seen along Z, instead of signals");
  sub->add_option_function<std::string>("--width", cells_option("--width", out.plot.width, 24),
                                        "Columns of the picture, 24 to 1000 (default 80)")
      ->type_name("N");
  sub->add_option_function<std::string>(
         "--height", cells_option("--height", out.plot.height, 3),
         "Rows of each picture, 3 to 1000 (default 10); of a path at most (default 20)")
      ->type_name("N");
  sub->add_flag("--ascii", out.plot.ascii, "Draw with # instead of Braille dots");
  sub->footer("Example: kadr plot part.lcmlog --signals 'axis.*.following*' --from 1.2 --to 1.4");
}

void add_report(Options& o) {
  ExportOptions& out = o.arguments.exported;
  CLI::App* sub =
      o.command(o.app, "report", report_log,
                "Write one HTML page of a log: summary, path, charts, program; opens without network");
  sub->add_option("LOG", o.arguments.files, "Log written by kadr run")
      ->required()
      ->expected(1)
      ->type_name("");
  sub->add_option("-o,--output", out.output_path, "Page to write (default: the log's name with .html)")
      ->type_name("FILE");
  sub->add_option_function<std::string>("--from", number_option("--from", out.choice.from_s, 0),
                                        "Begin at this time of the run, s (default 0)")
      ->type_name("S");
  sub->add_option_function<std::string>("--to", number_option("--to", out.choice.to_s, 0),
                                        "End at this time of the run, s (default: its end)")
      ->type_name("S");
  sub->add_option_function<std::string>(
         "--max-size-mb", number_option("--max-size-mb", out.max_size_mb, 0.2),
         "Largest size of the page in MB, at least 0.2 (default 10); a longer run shows extremes only")
      ->type_name("MB");
  sub->add_flag("--plain", out.plain, "Tables and drawings alone, without script");
  sub->add_flag("-q,--quiet", o.arguments.output.quiet, "Only errors")->group("Output");
  sub->footer("Example: kadr report part.lcmlog -o part.html");
}

void add_compare(Options& o) {
  ExportOptions& out = o.arguments.exported;
  CLI::App* sub = o.command(o.app, "compare", compare_logs,
                            "Put runs of one program side by side: time, vibration, path error, work");
  sub->add_option("LOG", o.arguments.files, "2 to 16 logs written by kadr run, of one program")
      ->required()
      ->expected(2, 16)
      ->type_name("");
  sub->add_option("-o,--output", out.output_path, "Also write a page with the runs drawn over each other")
      ->type_name("FILE");
  o.output(sub);
  sub->footer("Example: kadr compare before.lcmlog after.lcmlog -o both.html");
}

}  // namespace

void add_log_commands(Options& o) {
  add_info(o);
  add_diff(o);
  add_export(o);
  add_plot(o);
  add_report(o);
  add_compare(o);
}

}  // namespace kadr::cli
