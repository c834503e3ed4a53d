#include <benchmark/benchmark.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <string>

#include "emulator/cycle/operator/operator_panel.h"
#include "emulator/text/json.h"
#include "emulator/text/sarif.h"
#include "gcode/gcode.h"
#include "machine/machine.h"
#include "machine/machine_file.h"

/// Time of each construct at n, 2n and 4n: it grows with the text, not with its square. A mean ratio above 2.5 is an error.
namespace {

using namespace kadr;

constexpr double kMostRatio = 2.5;
constexpr int kRepeats = 5, kMostRepeats = 50;

struct Construct {
  const char* name;
  int n;  ///< so many that 4n take a tenth of a second or less
  std::string (*text)(int n);
  void (*read)(const std::string& text);
};

std::string repeated(int n, const std::function<std::string(int)>& piece) {
  std::string text;
  for (int i = 1; i <= n; ++i) text += piece(i);
  return text;
}

void check_program(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto file = sources.add(SourceText("p.ngc", text));
  std::uint64_t blocks = 0;
  gcode::interpret(
      sources, file, {}, [&](const gcode::Block&) { ++blocks; }, diagnostics);
  std::size_t told = 0;
  for (const Diagnostic& d : diagnostics.list()) told += render_human(d, sources).size();
  benchmark::DoNotOptimize(blocks + told);
}

/// A program of macro B.
void check_macro(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  gcode::InterpretOptions options;
  options.dialect = gcode::Dialect::fanuc;
  std::uint64_t blocks = 0;
  gcode::interpret(
      sources, sources.add(SourceText("p.nc", text)), options, [&](const gcode::Block&) { ++blocks; },
      diagnostics);
  std::size_t told = 0;
  for (const Diagnostic& d : diagnostics.list()) told += render_human(d, sources).size();
  benchmark::DoNotOptimize(blocks + told);
}

void check_as_sarif(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto file = sources.add(SourceText("p.ngc", text));
  gcode::interpret(
      sources, file, {}, [](const gcode::Block&) {}, diagnostics);
  text::SarifLog log("/");
  for (const Diagnostic& d : diagnostics.list()) log.add(d, sources);
  benchmark::DoNotOptimize(text::json_line(log.document(1)).size());
}

void format(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  std::string out;
  gcode::format_program(sources, sources.add(SourceText("p.ngc", text)), diagnostics, out);
  benchmark::DoNotOptimize(out.size());
}

void read_machine(const std::string& text) {
  SourceSet sources;
  const auto read = machine::read_machine(SourceText("m.toml", text), sources);
  std::size_t told = 0;
  if (!read)
    for (const Diagnostic& d : read.error().list()) told += render_human(d, sources).size();
  benchmark::DoNotOptimize(told);
}

/// A program with a table of as many tools as it has lines.
void check_with_tools(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  gcode::InterpretOptions options;
  options.tools.emplace();
  const auto lines = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  for (int i = 1; i <= lines; ++i) {
    gcode::Tool tool;
    tool.number = tool.pocket = i;
    options.tools->tools.push_back(tool);
  }
  std::uint64_t blocks = 0;
  gcode::interpret(
      sources, sources.add(SourceText("p.ngc", text)), options, [&](const gcode::Block&) { ++blocks; },
      diagnostics);
  benchmark::DoNotOptimize(blocks);
}

/// A timeline with a step of the override for each byte, at its place on the path, taken control tick by control tick.
void take_steps(const std::string& text) {
  const machine::MachineModel machine;
  const planner::Path path(1);
  std::vector<cycle::OperatorStep> steps(text.size());
  std::vector<double> places_u;
  for (cycle::OperatorStep& step : steps) {
    step.place.emplace();
    places_u.push_back(static_cast<double>(places_u.size()));
  }
  cycle::EventList events(path);
  cycle::OperatorPanel panel(steps, places_u, machine, events);
  for (std::size_t i = 0; i < steps.size(); ++i)
    panel.advance(ControlTicks{static_cast<std::int64_t>(i)}, places_u[i]);
  benchmark::DoNotOptimize(panel.spindle_override());
}

std::string nested_ifs(int n) {
  return repeated(n, [](int i) { return fmt::format("O{} if [1]\n", i); }) +
         repeated(n, [n](int i) { return fmt::format("O{} endif\n", n + 1 - i); }) + "M2\n";
}

const Construct kConstructs[] = {
    {"names", 20'000,
     [](int n) { return repeated(n, [](int i) { return fmt::format("#<v{0}>={0}\n", i); }); }, check_program},
    {"names_of_one_line", 4'000,
     [](int n) { return repeated(n, [](int i) { return fmt::format("#<v{0}>=#<v{0}> ", i); }) + "\nM2\n"; },
     check_program},
    {"open_subs", 20'000, [](int n) { return repeated(n, [](int) { return "O1 sub\n"; }); }, check_program},
    {"ends_without_begin", 10'000,
     [](int n) {
       return repeated(n, [](int i) { return fmt::format("O{} if [1]\n", i); }) +
              repeated(n, [](int) { return "O0 endif\n"; });
     },
     check_program},
    {"nested_ifs", 10'000, nested_ifs, check_program},
    {"form_of_nested_ifs", 10'000, nested_ifs, format},
    {"elseifs_of_a_loop", 5'000,
     [](int n) {
       return "O1 repeat [20]\nO2 if [0]\n" + repeated(n, [](int) { return "O2 elseif [0]\n"; }) +
              "O2 endif\nO1 endrepeat\nM2\n";
     },
     check_program},
    {"calls", 20'000,
     [](int n) { return "O1 sub\nO1 endsub\n" + repeated(n, [](int) { return "O1 call\n"; }) + "M2\n"; },
     check_program},
    {"macro_numbers", 20'000,
     [](int n) {
       return fmt::format("GOTO {}\n", n) +
              repeated(n, [](int i) { return fmt::format("N{} G0 X{}\n", i, i % 97); });
     },
     check_macro},
    {"macro_jumps_forward", 20'000,
     [](int n) {
       return repeated(n, [](int i) { return fmt::format("N{} GOTO {}\n", i, i + 1); }) +
              fmt::format("N{} M30\n", n + 1);
     },
     check_macro},
    {"macro_jumps_back", 20'000,
     [](int n) {
       return fmt::format("GOTO {}\nN0 M30\n", n) +
              repeated(n, [](int i) { return fmt::format("N{} GOTO [{}]\n", i, i - 1); });
     },
     check_macro},
    {"macro_missing_numbers", 20'000,
     [](int n) { return repeated(n, [](int i) { return fmt::format("GOTO {}\n", i); }); }, check_macro},
    {"macro_loops", 10'000,
     [](int n) {
       return repeated(n, [](int) { return "DO1\nDO2\nDO3\nGOTO 1\nEND3\nEND2\nEND1\n"; }) + "N1 M30\n";
     },
     check_macro},
    {"macro_open_loops", 10'000,
     [](int n) { return repeated(n, [](int) { return "WHILE [#1 EQ 1] DO1\n"; }) + "M30\n"; }, check_macro},
    {"macro_calls", 10'000,
     [](int n) { return repeated(n, [](int) { return "G65 P1 A1 B2\n"; }) + "M30\nO1\nG0 X#1\nM99\n"; },
     check_macro},
    {"macro_programs", 10'000,
     [](int n) {
       return "M98 P1\nM30\n" +
              repeated(n, [](int i) { return fmt::format("O{}\nIF [1 EQ 2] GOTO 5\nN5 M99\n", i); });
     },
     check_macro},
    {"macro_right_side", 20'000,
     [](int n) { return "#1=1" + repeated(n, [](int) { return "+#2*3"; }) + "\n"; }, check_macro},
    {"nurbs", 1'000,
     [](int n) {
       return "F9000\nG5.2 P1 L16\n" +
              repeated(
                  n,
                  [](int i) { return fmt::format("X{} Y{} P{}\n", i * 37 % 91, i * 53 % 89, 1 + i % 7); }) +
              "G5.3\nM2\n";
     },
     check_program},
    {"nurbs_of_one_point", 100,
     [](int n) {
       return "F9000\nG0 X1.1 Y1.3\nG5.2 P1 L4\n" +
              repeated(n, [](int i) { return fmt::format("X1.1 Y1.3 P{}\n", 0.1 + i % 7); }) + "G5.3\nM2\n";
     },
     check_program},
    {"tools", 10'000,
     [](int n) { return repeated(n, [](int i) { return fmt::format("T{} M6\n", i); }) + "M2\n"; },
     check_with_tools},
    {"operator_steps", 10'000, [](int n) { return std::string(static_cast<std::size_t>(n), 'x'); },
     take_steps},
    {"errors_of_one_line", 50'000, [](int n) { return repeated(n, [](int) { return "X1 "; }) + "\n"; },
     check_program},
    {"sarif_of_one_line", 50'000, [](int n) { return repeated(n, [](int) { return "X1 "; }) + "\n"; },
     check_as_sarif},
    {"toml_array", 50'000,
     [](int n) { return "[xx]\na = [" + repeated(n, [](int) { return "1,"; }) + "]\n"; }, read_machine},
    {"toml_array_of_cyrillic", 20'000,
     [](int n) { return "[xx]\na = [" + repeated(n, [](int) { return "'\xD0\xB4',"; }) + "]\n"; },
     read_machine},
    {"toml_inline_table", 5'000,
     [](int n) {
       return "a = {" + repeated(n, [](int i) { return fmt::format("k{} = 1, ", i); }) + "z = 1}\n";
     },
     read_machine},
    {"toml_keys", 10'000,
     [](int n) { return repeated(n, [](int i) { return fmt::format("k{} = 1\n", i); }); }, read_machine},
    {"toml_axes", 5'000, [](int n) { return repeated(n, [](int) { return "[[axis]]\n"; }); }, read_machine},
};

/// Processor time of one reading, in seconds: what else the machine does is not counted, though it cools the caches.
double time_s(const Construct& construct, const std::string& text) {
  const std::clock_t begin = std::clock();
  construct.read(text);
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

/// The shortest times at n and 4n, measured in turn. A neighbour makes a time longer, never shorter, so that a ratio too
/// high is measured on before it is believed.
void doubling(benchmark::State& state, const Construct& construct) {
  const std::string text_n = construct.text(construct.n);
  const std::string text_4n = construct.text(4 * construct.n);
  double ratio = 0, time_n_s = 1e9, time_4n_s = 1e9;
  for (auto _ : state) {
    for (int i = 0; i < kMostRepeats && (i < kRepeats || ratio > kMostRatio); ++i) {
      time_n_s = std::min(time_n_s, time_s(construct, text_n));
      time_4n_s = std::min(time_4n_s, time_s(construct, text_4n));
      ratio = std::sqrt(time_4n_s / time_n_s);
    }
  }
  state.counters["ratio"] = ratio;
  state.counters["time_4n_ms"] = 1e3 * time_4n_s;
  if (ratio > kMostRatio) state.SkipWithError("the time grows faster than the text");
}

const bool registered = [] {
  for (const Construct& construct : kConstructs)
    benchmark::RegisterBenchmark(construct.name, doubling, construct)
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
