#include <fmt/format.h>

#include <cmath>

#include "emulator/cli/commands.h"
#include "emulator/cli/options.h"
#include "machine/base/parse_number.h"

namespace kadr::cli {
namespace {

constexpr std::size_t kMostCompared = 4;
constexpr std::int64_t kMostSlots = 10'000'000;

/// An option that takes a number between two bounds.
template <class T>
void bounded(CLI::App* sub, const std::string& name, T& value, double least, double most,
             const std::string& description) {
  sub->add_option_function<std::string>(
         name,
         [name, &value, least, most](const std::string& text) {
           const auto number = parse_number(text);
           const bool whole = !std::is_integral_v<T> || (number && *number == std::floor(*number));
           if (!number || !whole || !(*number >= least && *number <= most))
             throw CLI::ValidationError(fmt::format("{} takes a {}number from {} to {}; got '{}'", name,
                                                    std::is_integral_v<T> ? "whole " : "", least, most,
                                                    text));
           value = static_cast<T>(*number);
         },
         fmt::format("{}; {}{:g} to {:g}", description, std::is_integral_v<T> ? "whole, " : "", least, most))
      ->type_name("N");
}

/// Words that may follow in a case.
void case_words(Options& o, const CLI::App* sub) {
  o.words(sub->get_option("CASE"), studies::kCaseKinds.strings());
}

void subject(Options& o, CLI::App* sub) {
  std::string kinds;
  for (const auto& k : studies::kCaseKinds)
    kinds += fmt::format("\n  {} {}: {}", k.word, studies::case_numbers(k.value), k.sentence);
  sub->add_option("CASE", o.arguments.files, "What is interpolated, in whole steps:" + kinds)
      ->required()
      ->expected(1, 4096)
      ->type_name("");
  case_words(o, sub);
  studies::TeachOptions& options = o.arguments.teach.options;
  bounded(sub, "--axes", o.arguments.teach.axes, 2, 9, "Axes of a polyline or Bezier (default 2)");
  o.choice(
       sub, "--mode", options.mode, studies::kTeachModes,
       fmt::format(
           "How axes move: {} (default cp: together along the path; ptp: each at its own rate from node to\n"
           "node)",
           studies::kTeachModes.list("|")))
      ->group("Options");
  bounded(sub, "--bits", options.method.fraction_bits, 1, 60,
          "Fraction bits of progression and newton (default 16)");
  bounded(sub, "--tolerance", options.method.chord_tolerance, 1e-3, 1e6,
          "Largest sagitta of chords in steps (default 0.1)");
  sub->add_flag("--tie-to-y", options.method.tie_to_y,
                "half_step: where a line passes through a corner, step Y instead of X, as its way back does");
  bounded(sub, "--most", options.most_slots, 1, static_cast<double>(kMostSlots),
          "Largest number of slots (default 100000)");
  sub->add_flag("--csv", o.arguments.csv, "Write comma-separated values instead of a table")->group("Output");
}

void methods(Options& o, CLI::App* sub, std::size_t most) {
  std::string names;
  for (const auto& m : interpolator::lattice::methods())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", m.name());
  o.repeated(sub, "--method", "NAME",
             most == 1
                 ? "Interpolator (default half_step); `kadr teach methods` lists them"
                 : fmt::format("Interpolator, up to {}, repeatable; default: the first {} that know the case",
                               most, most),
             [&o, names, most](const std::string& text) -> tl::expected<void, std::string> {
               if (!interpolator::lattice::method_of(text))
                 return tl::unexpected(fmt::format("takes one of {}; got '{}'", names, text));
               if (o.arguments.methods.size() == most)
                 return tl::unexpected(fmt::format("is taken {} at most; '{}' is one more",
                                                   most == 1 ? "once" : fmt::format("{} times", most), text));
               o.arguments.methods.push_back(text);
               return {};
             });
  std::vector<std::string> list;
  for (const auto& m : interpolator::lattice::methods()) list.emplace_back(m.name());
  o.words(sub->get_option("--method"), std::move(list));
}

void add_table(Options& o, CLI::App* group) {
  CLI::App* sub = o.command(*group, "table", teach_table,
                            "Print a case step by step: node, F, what was tested, move, deviation in steps");
  subject(o, sub);
  methods(o, sub, 1);
  studies::PulseTiming& timing = o.arguments.teach.timing;
  o.choice(sub, "--timing", timing, studies::kPulseTimings,
           fmt::format("When pulses fire: {} (default uniform: slot after slot; crossing: where the path\n"
                       "crosses the middle between two nodes, at a constant feed)",
                       studies::kPulseTimings.list("|")))
      ->group("Options");
  bounded(sub, "--feed", o.arguments.teach.feed_steps_s, 1e-3, 1e7,
          "Slots per second, or steps per second along the path (default 1000)");
  sub->add_option("--vcd", o.arguments.teach.vcd_path,
                  "Also write STEP and DIR as a value change dump with ticks of 0.1 us")
      ->type_name("FILE");
  sub->add_flag("--spacing", o.arguments.teach.spacing, "Add the times between pulses of each axis in us");
  o.output(sub);
  sub->footer("Example: kadr teach table line 7 4 --method half_step");
}

void add_compare(Options& o, CLI::App* group) {
  CLI::App* sub = o.command(*group, "compare", teach_compare,
                            "Follow a case by up to four methods: slots, pulses, deviations in steps, ends");
  subject(o, sub);
  methods(o, sub, kMostCompared);
  o.output(sub);
  sub->footer("Example: kadr teach compare arc 7 0 0 7 --method classic --method half_step");
}

void add_methods(Options& o, CLI::App* group) {
  CLI::App* sub = o.command(*group, "methods", teach_methods, "List the interpolators and what they follow");
  o.output(sub);
}

const CLI::Option* page_path(Options& o, CLI::App* sub) {
  return sub
      ->add_option("-o,--output", o.arguments.teach.page_path,
                   "Page to write (default teach.html); `-`: standard output")
      ->type_name("FILE");
}

void add_page(Options& o, CLI::App* group) {
  CLI::App* sub = o.command(*group, "page", teach_page,
                            "Write the teaching page: the same interpolators, to be clicked through in a\n"
                            "browser; one file, no network");
  sub->add_option("CASE", o.arguments.files, "Case to open with, as in `kadr teach table`, of two axes")
      ->expected(0, 4096)
      ->type_name("");
  case_words(o, sub);
  methods(o, sub, kMostCompared);
  page_path(o, sub);
  o.output(sub);
  sub->footer("Example: kadr teach page arc 7 0 0 7 ccw -o arc.html");
}

void add_sweep(Options& o, CLI::App* group) {
  CLI::App* sub = o.command(*group, "sweep", teach_sweep,
                            "One hash over the traces of many cases by all methods: the same in every build\n"
                            "and on the page");
  bounded(sub, "--cases", o.arguments.teach.cases, 1, 10'000'000, "Number of cases (default 20000)");
  o.output(sub);
}

void add_bezier(Options& o, CLI::App* group) {
  CLI::App* sub =
      o.command(*group, "bezier", teach_bezier,
                "Examine Bezier curves end to end: polynomials, length, smallest radius, joints,\n"
                "speed that an acceleration allows; exit 1 if a feed is not allowed or curves don't meet");
  sub->add_option("CURVE", o.arguments.files,
                  "Control points of a curve, 2 to 4, in mm: coordinates by commas, points by blanks:\n"
                  "'0,0,0 2,2,4 5,-0.5,2'")
      ->required()
      ->expected(1, 4096)
      ->type_name("");
  bounded(sub, "--feed", o.arguments.teach.feed_mm_s, 1e-6, 1e9, "Feed to check in mm/s");
  bounded(sub, "--accel", o.arguments.teach.acceleration_mm_s2, 1e-6, 1e12,
          "Acceleration that the machine allows in mm/s2");
  sub->add_flag("--paper", o.arguments.teach.paper,
                "Show errors of t(S) by Newton's polynomials, minimax polynomials and the quintic table");
  o.output(sub);
  sub->footer("Example: kadr teach bezier '0,0,0 2,2,4 5,-0.5,2' --feed 1000 --accel 500000");
}

}  // namespace

void add_teach_commands(Options& o) {
  CLI::App* group = o.app.add_subcommand("teach", "Show how interpolators and splines work, step by step");
  group->require_subcommand(0, 1);
  const CLI::Option* page = page_path(o, group);
  group->callback([&o, group, page] {
    if (group->get_subcommands().empty())
      o.arguments.command = teach_page;
    else if (page->count() > 0)
      throw CLI::ValidationError("options follow the command");
  });
  group->footer(
      "Alone it writes the teaching page, as `kadr teach page`. `kadr teach table --help` lists the cases; "
      "docs/interpolators.md explains the methods.");
  add_table(o, group);
  add_compare(o, group);
  add_methods(o, group);
  add_page(o, group);
  add_sweep(o, group);
  add_bezier(o, group);
}

}  // namespace kadr::cli
