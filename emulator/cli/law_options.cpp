#include "emulator/cli/options.h"

#include <fmt/format.h>

#include "emulator/cli/commands.h"
#include "emulator/studies/time_law/law_study.h"
#include "machine/base/parse_number.h"

namespace kadr::cli {
namespace {

constexpr int kLeastLevels = 3, kMostLevels = 2000, kMostRuns = 500;

/// "50..200".
tl::expected<std::pair<int, int>, std::string> level_range(const std::string& text) {
  const std::size_t dots = text.find("..");
  const auto whole = [](const std::string& part) -> int {
    const auto value = parse_number(part);
    return value && *value >= kLeastLevels && *value <= kMostLevels && *value == static_cast<int>(*value)
               ? static_cast<int>(*value)
               : 0;
  };
  const int first = dots == std::string::npos ? 0 : whole(text.substr(0, dots));
  const int last = dots == std::string::npos ? 0 : whole(text.substr(dots + 2));
  if (first == 0 || last < first || last - first >= kMostRuns)
    return tl::unexpected(fmt::format("takes A..B, levels from {} to {}, at most {} of them; got '{}'",
                                      kLeastLevels, kMostLevels, kMostRuns, text));
  return std::pair(first, last);
}

void add_tube(Options& o) {
  CLI::App* sub =
      o.command(o.app, "tube", solve_tube,
                "Find time laws along a stated path by several methods: times in s, how far from\n"
                "the best, smoothness, what the check found; exit 1 if a law breaks a limit");
  sub->add_option("PROBLEM", o.arguments.files, "Problem file (docs/time_law.md); `-`: standard input")
      ->expected(1)
      ->type_name("");
  sub->add_flag("--keys", o.arguments.list,
                "List every key of a problem file: what it takes, its default and what it means");
  o.repeated(
      sub, "--method", "NAME",
      fmt::format("Use only this method: {};\nrepeatable (default: all that the problem states)",
                  machine::kLawMethods.list()),
      [&o](const std::string& text) -> tl::expected<void, std::string> {
        if (!machine::kLawMethods.find(text))
          return tl::unexpected(fmt::format("takes one of {}; got '{}'", machine::kLawMethods.list(), text));
        o.arguments.methods.push_back(text);
        return {};
      });
  sub->add_option(
         "--csv", o.arguments.csv_path,
         "Write a CSV file, a row per node: s in mm, highest speed and what limits it, speed in mm/s "
         "and time\n"
         "in s of every law")
      ->type_name("FILE");
  sub->add_option("--page", o.arguments.page_path, "Write charts and tables as one HTML file")
      ->type_name("FILE");
  sub->add_option_function<std::string>(
         "--sweep-levels",
         [&o](const std::string& text) {
           const auto range = level_range(text);
           if (!range) throw CLI::ValidationError("--sweep-levels " + range.error());
           o.arguments.first_level = range->first;
           o.arguments.last_level = range->second;
         },
         "Instead, run the tube with each number of levels from A to B, 3 to 2000: time, gap, passes;\n"
         "--csv and --page then show the sweep")
      ->type_name("A..B")
      ->excludes("--method");
  sub->add_flag("--timing", o.arguments.timing, "Add a column of wall times, which differ from run to run");
  o.limits(sub);
  o.allow(sub);
  o.diagnostics(sub);
  o.output(sub);
  o.words(sub->get_option("--method"), machine::kLawMethods.strings());
  sub->footer("Example: kadr tube docs/tube/laying.toml --page laying.html");
}

/// A number, stored by `take`; the library checks its range.
void number(CLI::App* sub, const std::string& name, const std::string& unit, const std::string& meaning,
            std::function<void(double)> take) {
  sub->add_option_function<std::string>(
         name,
         [name, take = std::move(take)](const std::string& text) {
           const auto value = parse_number(text);
           if (!value) throw CLI::ValidationError(fmt::format("{} takes a number; got '{}'", name, text));
           take(*value);
         },
         meaning)
      ->type_name(unit);
}

void add_law(Options& o) {
  CLI::App* sub = o.command(o.app, "law", compare_laws,
                            "Compare motions from rest to rest: energy in J, residual vibration in mm, how\n"
                            "sensitive to the frequency; the default question is Table 1 of paper 001");
  studies::PointQuestion& q = o.arguments.point;
  number(sub, "--distance-m", "M", "Distance in m (default 3.5)", [&q](double x) { q.task.distance_u = x; });
  number(sub, "--time-s", "S", "Time of the motion in s (default 4)", [&q](double x) { q.time_s = x; });
  sub->add_flag("--time-optimal", q.time_optimal, "As fast as the limits allow, instead of --time-s");
  number(sub, "--accel-m-s2", "A", "Largest acceleration in m/s2 (default 1)",
         [&q](double x) { q.task.accel_limit_u_s2 = x; });
  number(sub, "--speed-m-s", "V", "Largest speed in m/s (default 3)",
         [&q](double x) { q.task.speed_limit_u_s = x; });
  number(sub, "--omega-rad-s", "W", "Natural frequency of the load on its base in rad/s (default 100 pi/3)",
         [&q](double x) { q.mode.omega_rad_s = x; });
  number(sub, "--zeta", "Z", "Damping ratio of the load (default 0)", [&q](double x) { q.mode.zeta = x; });
  number(sub, "--mass-kg", "M", "Mass m of the load in kg (default 1)",
         [&q](double x) { q.load.mass_kg = x; });
  number(sub, "--drive-ratio", "P", "Inertia of the drive as a multiple of m (default 4)",
         [&q](double x) { q.load.drive_ratio = x; });
  number(sub, "--counterweight-ratio", "K", "Counterweight as a multiple of m (default 0.5)",
         [&q](double x) { q.load.counterweight_ratio = x; });
  number(sub, "--gravity-m-s2", "G", "Gravity along the axis in m/s2 (default 9.81; 0: level)",
         [&q](double x) { q.load.gravity_m_s2 = x; });
  sub->add_flag("--printed-gravity", q.printed_gravity,
                "Take 9.81 for K_g, as the paper does, whatever time and distance are");
  o.choice(sub, "--drive", q.drive, planner::kDrives,
           fmt::format("What moves the base: {} (default position: stiff)", planner::kDrives.list("|")))
      ->group("Options");
  number(sub, "--uncertainty-pct", "U",
         "How far off the natural frequency may be, in %, for the advice (default 1)",
         [&q](double x) { q.omega_uncertainty = x / 100; });
  o.repeated(sub, "--xi", "XI", "Add the T law of this xi to the comparison; repeatable",
             [&q](const std::string& text) -> tl::expected<void, std::string> {
               const auto value = parse_number(text);
               if (!value) return tl::unexpected(fmt::format("takes a number; got '{}'", text));
               q.xi.push_back(*value);
               return {};
             });
  sub->add_flag("--paper", o.arguments.table2,
                "Show Table 2 of the paper instead: printed, reproduced, and by physics");
  sub->add_option("--csv", o.arguments.csv_path, "Write the table as CSV, a row per law")->type_name("FILE");
  sub->add_option("--page", o.arguments.page_path, "Write charts and table as one HTML file")
      ->type_name("FILE");
  o.output(sub);
  sub->footer("Example: kadr law --zeta 0.005 --xi 0.3601 --page laws.html");
}

/// The generator checks the bounds, since some depend on other parameters.
void wind_parameter(Options& o, CLI::App* sub, const scenarios::WindParameter& p) {
  const std::string flag = scenarios::wind_flag(p.key);
  sub->add_option_function<std::string>(
         flag,
         [&o, &p, flag](const std::string& text) {
           const auto value = parse_number(text);
           if (!value) throw CLI::ValidationError(fmt::format("{} takes a number; got '{}'", flag, text));
           o.arguments.wind_settings.emplace_back(p.key, *value);
         },
         fmt::format("{}; {}{} to {} (default {})", p.meaning, p.whole ? "whole, " : "", number_text(p.least),
                     number_text(p.most), number_text(p.preset)))
      ->type_name("N");
}

void add_wind(Options& o) {
  CLI::App* group = o.app.add_subcommand("wind", "Write a filament-winding program for axes X Y A B");
  group->require_subcommand(1);
  group->footer(
      "X: carriage, Y: eye (distance from the mandrel's axis), A: mandrel, B: eye roll. Feed is inverse "
      "time (G93).\n`kadr wind hoop --help` lists the parameters.");
  for (const scenarios::WindKind& kind : scenarios::wind_kinds()) {
    CLI::App* sub = group->add_subcommand(std::string(kind.name), std::string(kind.meaning));
    sub->callback([&o, &kind] {
      o.arguments.command = write_winding;
      o.arguments.wind_kind = kind.name;
    });
    for (const scenarios::WindParameter& p : kind.parameters) wind_parameter(o, sub, p);
    sub->add_option("-o,--output", o.arguments.program_path, "Program to write (default: standard output)")
        ->type_name("FILE");
    o.output(sub);
    sub->footer(fmt::format("Example: kadr wind {0} --length-mm 120 -o {0}.ngc", kind.name));
  }
}

}  // namespace

void add_law_commands(Options& o) {
  add_tube(o);
  add_law(o);
  add_wind(o);
}

}  // namespace kadr::cli
