// What it costs that every plan is verified and every run checks its nodes:
//   verify_of_plan_pct      verify() against the planner
//   verify_of_prepare_pct   the same against reading and planning
//   node_check_of_run_pct   the node check against a run without plant and log
// CPU time of this thread, the least of several rounds.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <optional>
#include <string>

#include "emulator/emulator.h"
#include "emulator/interpolator/interpolator.h"
#include "emulator/scenario/scenario.h"
#include "machine/base/numbers.h"
#include "planner/laws/motion_source.h"
#include "planner/planner.h"
#include "scenarios/generator/wind.h"

namespace kadr {
namespace {

double cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Least CPU time of a piece of work: of as many rounds as fit into a quarter of a second, at least three.
template <class Work>
double least_s(const Work& work) {
  double best_s = 1e300;
  const double begin_s = cpu_s();
  for (int round = 0; round < 3 || cpu_s() - begin_s < 0.25; ++round) {
    const double from_s = cpu_s();
    work();
    best_s = std::min(best_s, cpu_s() - from_s);
  }
  return best_s;
}

/// A smooth curve of a million rounded facets of 0.02 mm.
std::string million_lines(const char* mode) {
  std::string program = fmt::format("G21 G90 G94 G17 {}\nF6000\n", mode);
  std::uint64_t state = 1;
  double x = 0, y = 0, angle = 0, turn = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    turn = 0.98 * turn + 0.01 * (static_cast<double>(state >> 11) * 0x1p-53 - 0.5);
    angle += turn;
    const SinCos d = exact_sincos(angle);
    x += 0.02 * d.cos;
    y += 0.02 * d.sin;
    program += fmt::format("G1 X{:.3f} Y{:.3f}\n", x, y);
  }
  return program + "M2\n";
}

struct Work {
  std::string name, text, machine;  // a program on a shipped machine
};
Work scenario_work(const std::string& folder) { return {folder, "", ""}; }
Work wind_work(const char* kind) {
  return {std::string("wind ") + kind,
          scenarios::render_winding(*scenarios::wind(kind, {}), scenarios::wind_command(kind, {})),
          "winder4"};
}

struct Inputs {
  SourceSet sources;
  cycle::JobInputs given;
};

Inputs inputs_of(const Work& work) {
  Inputs in;
  Diagnostics diagnostics;
  if (work.text.empty()) {
    const auto scenario =
        scenario::read_scenario(std::string(KADR_SOURCE_DIR "/scenarios/") + work.name, in.sources);
    scenario::open_job(*scenario, in.given, in.sources, diagnostics);
    return in;
  }
  in.given.machine = *machine::read_machine(
      SourceText(work.machine + ".toml", std::string(machine::shipped_machine(work.machine))), in.sources,
      {});
  in.given.program = in.sources.add(SourceText("bench.ngc", work.text));
  return in;
}

void verify(benchmark::State& state, const Work& work) {
  double prepare_s = 1e300, plan_s = 0, verify_s = 0, segments = 0;
  for (auto _ : state) {
    const auto options = planner::production_check();
    std::optional<Inputs> in;
    std::optional<cycle::Job> job;
    const double begin_s = cpu_s();
    for (int round = 0; round < 3 || cpu_s() - begin_s < 0.25; ++round) {
      job.reset();
      in.emplace(inputs_of(work));
      Diagnostics diagnostics;
      const double from_s = cpu_s();
      auto made = cycle::prepare(in->given, in->sources, diagnostics, cycle::SoftLimitRule::warning);
      if (!made) return state.SkipWithError("refused");
      prepare_s = std::min(prepare_s, cpu_s() - from_s);
      job.emplace(std::move(*made));
    }
    const auto& machine = in->given.machine.model;
    auto plan = *planner::plan(job->read.path, machine);
    plan_s = least_s([&] { benchmark::DoNotOptimize(planner::plan(job->read.path, machine)); });
    verify_s =
        least_s([&] { benchmark::DoNotOptimize(planner::verify(job->read.path, plan, machine, options)); });
    segments = static_cast<double>(job->read.path.size());
  }
  state.counters["segments"] = segments;
  state.counters["verify_ms"] = 1e3 * verify_s;
  state.counters["verify_of_plan_pct"] = 100 * verify_s / plan_s;
  state.counters["verify_of_prepare_pct"] = 100 * verify_s / (prepare_s - verify_s);
}

/// Every control tick of a run with and without the check: the difference, as often as a run makes it.
void node_check(benchmark::State& state, const Work& work) {
  constexpr double kEvery = 127;  // emulator/cycle/session.cpp
  double percent = 0;
  for (auto _ : state) {
    Inputs in = inputs_of(work);
    Diagnostics diagnostics;
    const auto job = cycle::prepare(in.given, in.sources, diagnostics, cycle::SoftLimitRule::warning);
    const auto ticks_s = [&](bool check) {
      return least_s([&] {
        interpolator::CrossingInterpolator interpolator(job->read.path, in.given.machine.model);
        interpolator.set_self_check(check);
        planner::LawSource source(job->planned.plan.law, in.given.machine.model);
        StepBatch batch;
        while (!source.finished()) interpolator.advance(source.advance({}), batch);
      });
    };
    cycle::RunOptions options;
    options.plant = false;
    const double run_s = least_s([&] { benchmark::DoNotOptimize(cycle::run(*job, nullptr, options)); });
    percent = 100 * (ticks_s(true) - ticks_s(false)) / kEvery / run_s;
  }
  state.counters["node_check_of_run_pct"] = percent;
}

BENCHMARK_CAPTURE(verify, pocket, scenario_work("02_pocket"))->Iterations(1);
BENCHMARK_CAPTURE(verify, engraving, scenario_work("03_engraving"))->Iterations(1);
BENCHMARK_CAPTURE(verify, helix_bore, scenario_work("04_helix_bore"))->Iterations(1);
BENCHMARK_CAPTURE(verify, drilling, scenario_work("07_drilling"))->Iterations(1);
BENCHMARK_CAPTURE(verify, splines, scenario_work("13_splines"))->Iterations(1);
BENCHMARK_CAPTURE(verify, smooth_corners, scenario_work("26_smooth_corners"))->Iterations(1);
BENCHMARK_CAPTURE(verify, wind_hoop, wind_work("hoop"))->Iterations(1);
BENCHMARK_CAPTURE(verify, wind_helix, wind_work("helix"))->Iterations(1);
BENCHMARK_CAPTURE(verify, wind_dome, wind_work("dome"))->Iterations(1);
BENCHMARK_CAPTURE(verify, million_lines, Work{"", million_lines("G64"), "mill3"})->Iterations(1);
BENCHMARK_CAPTURE(verify, million_lines_smoothed, Work{"", million_lines("G64 P0.01"), "mill3"})
    ->Iterations(1);
BENCHMARK_CAPTURE(node_check, pocket, scenario_work("02_pocket"))->Iterations(1);
BENCHMARK_CAPTURE(node_check, engraving, scenario_work("03_engraving"))->Iterations(1);
BENCHMARK_CAPTURE(node_check, helix_bore, scenario_work("04_helix_bore"))->Iterations(1);
BENCHMARK_CAPTURE(node_check, splines, scenario_work("13_splines"))->Iterations(1);
BENCHMARK_CAPTURE(node_check, wind_dome, wind_work("dome"))->Iterations(1);

}  // namespace
}  // namespace kadr
