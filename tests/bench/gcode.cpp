#include <benchmark/benchmark.h>

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "gcode/gcode.h"
#include "gcode/read/program.h"

/// Speed of the front end on a program of a million short moves (about 30 MB), an arc each 50 lines.
namespace {

using namespace kadr;

constexpr std::int64_t kLines = 1'000'000;

std::string short_moves() {
  std::string text = "G21 G90 G94 G17\nF1200 G0 X0 Y0 Z0\n";
  std::uint64_t random = 42;
  const auto next = [&random](double scale) {
    random = random * 6364136223846793005ULL + 1442695040888963407ULL;
    return scale * static_cast<double>(random >> 40) / static_cast<double>(1 << 24);
  };
  double x = 0, y = 0;
  for (std::int64_t i = 2; i < kLines - 1; ++i) {
    x += next(1.0) - 0.5;
    y += next(1.0) - 0.5;
    if (i % 50 == 0) {
      // a full circle about a point 2.5 mm away ends where it starts
      text += fmt::format("G3 I{:.4f} J{:.4f} F{:.0f}\n", 2.5, next(1.0), 600 + next(600));
      continue;
    }
    text += fmt::format("G1 X{:.4f} Y{:.4f} Z{:.4f}\n", 100 + x, 100 + y, -next(2.0));
  }
  text += "M2\n";
  return text;
}

SourceSet& sources() {
  static SourceSet set = [] {
    SourceSet s;
    s.add(SourceText("short_moves.ngc", short_moves()));
    return s;
  }();
  return set;
}

void count_lines(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * kLines);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(sources()[0].text().size()));
}

void parse(benchmark::State& state) {
  for (auto _ : state) {
    Diagnostics diagnostics;
    gcode::Report report(diagnostics);
    gcode::Names names;
    gcode::Program program(sources(), 0, gcode::ReadingBounds{}, names, report);
    std::size_t items = 0;
    while (const gcode::Line* line = program.next()) items += line->items.size();
    benchmark::DoNotOptimize(items);
  }
  count_lines(state);
}
BENCHMARK(parse)->Unit(benchmark::kMillisecond);

void interpret(benchmark::State& state) {
  for (auto _ : state) {
    Diagnostics diagnostics;
    double sum = 0;
    gcode::interpret(
        sources(), 0, {},
        [&](const gcode::Block& b) {
          if (const gcode::Move* move = gcode::move_of(b)) sum += move->end[0];
        },
        diagnostics);
    benchmark::DoNotOptimize(sum);
    if (diagnostics.has_errors()) state.SkipWithError("the program has errors");
  }
  count_lines(state);
}
BENCHMARK(interpret)->Unit(benchmark::kMillisecond);

void canon(benchmark::State& state) {
  std::string out;
  for (auto _ : state) {
    Diagnostics diagnostics;
    std::size_t bytes = 0;
    gcode::interpret(
        sources(), 0, {},
        [&](const gcode::Block& b) {
          gcode::append_canon(out, b);
          out += '\n';
          if (out.size() < 60000) return;
          bytes += out.size();
          out.clear();
        },
        diagnostics);
    benchmark::DoNotOptimize(bytes);
  }
  count_lines(state);
}
BENCHMARK(canon)->Unit(benchmark::kMillisecond);

}  // namespace
