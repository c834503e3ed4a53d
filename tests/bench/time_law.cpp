#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

#include "../planner/literal_dp.h"
#include "../planner/reference_law.h"
#include "calibration.h"
#include "planner/time_law/certified.h"
#include "planner/time_law/formula_path.h"
#include "planner/time_law/greedy.h"
#include "planner/time_law/interior_point.h"
#include "planner/time_law/jerk_limited.h"
#include "planner/time_law/tube.h"

// The methods of paper 000 on its path, one thread. Counters: T and J, units (calibration loops; one is about
// a millisecond), nanoseconds a transition, times of the peer that the method is measured against.
namespace kadr::planner {
namespace {

/// Time of one call in calibration units, from what the benchmark measured.
void count_units(benchmark::State& state, double seconds) {
  state.counters["units"] = seconds / static_cast<double>(state.iterations()) / bench::calibration_unit_s();
}

void count_law(benchmark::State& state, const LawSolution& law) {
  state.counters["T_s"] = law.time_s;
  state.counters["J_s"] = law.cost_s;
  if (law.lower_bound_s > 0.0) state.counters["gap"] = law.cost_s / law.lower_bound_s - 1.0;
  state.counters["iterations"] = law.iterations;
}

using MakeSolver = std::unique_ptr<LawSolver> (*)();

void method(benchmark::State& state, MakeSolver make) {
  const ReferenceLaw law = paper_law(static_cast<std::size_t>(state.range(0)));
  LawSolution found;
  double seconds = 0;
  for (auto _ : state) {
    const double begin = bench::seconds_now();
    LawResult result = make()->solve(law.problem);
    seconds += bench::seconds_now() - begin;
    if (!result) return state.SkipWithError(result.error().reason.c_str());
    found = std::move(*result);
  }
  count_law(state, found);
  count_units(state, seconds);
}
template <class Solver>
std::unique_ptr<LawSolver> make() {
  return std::make_unique<Solver>();
}
std::unique_ptr<LawSolver> make_classical() { return std::make_unique<ClassicalDp>(1100); }
std::unique_ptr<LawSolver> make_jerk_limited() { return std::make_unique<JerkLimitedLaw>(2e4); }
BENCHMARK_CAPTURE(method, greedy, make<GreedyOptimum>)
    ->Arg(893)
    ->Arg(8921)
    ->Arg(89201)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(method, classical_1100, make_classical)->Arg(893)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(method, tube_100, make<TubeDp>)->Arg(893)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(method, optimum, make<InteriorPointOptimum>)
    ->Arg(893)
    ->Arg(8921)
    ->Arg(89201)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(method, certified, make<CertifiedLaw>)->Arg(893)->Arg(8921)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(method, jerk_2e4, make_jerk_limited)->Arg(893)->Unit(benchmark::kMillisecond);

/// A tube pass by lanes, against the programme word by word.
void tube_lanes(benchmark::State& state, DpStepFunction step) {
  const ReferenceLaw law = paper_law();
  const std::vector<NodeCap> caps = node_caps(law.problem);
  std::vector<LevelRange> levels;
  for (const NodeCap& c : caps) levels.push_back(LevelRange::uniform(1100, 0.0, c.speed_u_s));
  levels.front() = levels.back() = LevelRange::single(0.0);
  DynamicProgramme programme(law.problem, step);
  double seconds = 0;
  for (auto _ : state) {
    const double begin = bench::seconds_now();
    benchmark::DoNotOptimize(programme.run(levels)->time_s);
    seconds += bench::seconds_now() - begin;
  }
  state.counters["ns_per_transition"] = 1e9 * seconds / static_cast<double>(programme.transitions());
  count_units(state, seconds);
  const double begin = bench::seconds_now();
  benchmark::DoNotOptimize(literal_dp(law.problem, levels)->time_s);
  state.counters["literal_per_this"] =
      (bench::seconds_now() - begin) * static_cast<double>(state.iterations()) / seconds;
}
BENCHMARK_CAPTURE(tube_lanes, classical_1100_sse2, dp_step_sse2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tube_lanes, classical_1100_widest, dp_step_function())->Unit(benchmark::kMillisecond);

/// Paper 000, time against the number of levels: passes, and whether the number of passes alone ended the loop.
void tube_levels(benchmark::State& state) {
  const ReferenceLaw law = paper_law();
  TubeOptions options;
  options.levels = static_cast<std::int32_t>(state.range(0));
  LawSolution found;
  bool capped = false;
  for (auto _ : state) {
    TubeDp tube(options);
    LawResult result = tube.solve(law.problem);
    if (!result) return state.SkipWithError(result.error().reason.c_str());
    found = std::move(*result);
    capped = tube.capped();
  }
  count_law(state, found);
  state.counters["capped"] = capped;
}
BENCHMARK(tube_levels)->DenseRange(50, 200, 1)->Unit(benchmark::kMillisecond);

/// A path of a million nodes as close to each other as on the reference path.
void certified_million(benchmark::State& state) {
  ReferenceLaw law = paper_law();
  const double longer = 1'000'000.0 / 893.0;
  LawProblem& p = law.problem;
  for (FormulaAxis& axis : law.axes) {
    axis.slope *= longer;
    for (FormulaAxis::Wave& wave : axis.waves) wave.turns *= std::floor(longer);
    axis.steps.clear();
  }
  p.zones.clear();
  sample(law.axes, 2846.9 * longer, 1'000'000, p);
  p.penalty.per_length = false;
  LawSolution found;
  double seconds = 0;
  for (auto _ : state) {
    const double begin = bench::seconds_now();
    LawResult result = CertifiedLaw().solve(p);
    seconds += bench::seconds_now() - begin;
    if (!result) return state.SkipWithError(result.error().reason.c_str());
    found = std::move(*result);
  }
  count_law(state, found);
  state.counters["us_per_node"] = 1e6 * seconds / static_cast<double>(p.nodes());
}
BENCHMARK(certified_million)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace kadr::planner
