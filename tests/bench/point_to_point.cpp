#include <benchmark/benchmark.h>

#include "machine/base/numbers.h"
#include "planner/point_to_point/point_to_point.h"
#include "planner/positioning/positioning.h"
#include "tests/genetic/genetic.h"

// Paper 001: exact synthesis (below 1 ms), laws for rapids, and the genetic algorithm that they replace.
namespace kadr::planner {
namespace {

const PointTask kTask{3.5, 3, 1};
DrivenMode mode(double zeta) { return {{100 * kPi / 3, zeta}, 1}; }
Load printed_load() {
  Load load;
  load.gravity_m_s2 = printed_gravity_m_s2(3.5, 4);
  return load;
}

/// Argument: damping in thousandths.
void synthesis(benchmark::State& state) {
  const DrivenMode m = mode(1e-3 * static_cast<double>(state.range(0)));
  const Load load = printed_load();
  TChoice choice;
  for (auto _ : state) {
    choice = best_t_law(kTask, 4, m, load).value();
    benchmark::DoNotOptimize(choice);
  }
  state.counters["xi"] = choice.xi;
  state.counters["E_J"] = choice.energy_J;
  state.counters["X_mm"] = 1e3 * choice.amplitude_u;
}
BENCHMARK(synthesis)->Arg(0)->Arg(5)->Unit(benchmark::kMicrosecond);

void rapid(benchmark::State& state) {
  const ExcitedMode excited{mode(0), 0, 1};
  const PositioningTask task{
      3.5, 3, 1, machine::kInfinity, {&excited, 1}, static_cast<machine::RapidShape>(state.range(0)), 1e-4};
  for (auto _ : state) benchmark::DoNotOptimize(plan_positioning(task));
}
BENCHMARK(rapid)->DenseRange(0, 4)->Unit(benchmark::kMicrosecond);

/// Arguments: population, generations. Counters: how many of 200 seeds find the exact optimum.
void genetic(benchmark::State& state) {
  test::GeneticProblem problem;
  problem.driven = mode(0);
  problem.load = printed_load();
  test::GeneticOptions options;
  options.population = static_cast<std::uint32_t>(state.range(0));
  options.generations = static_cast<std::uint32_t>(state.range(1));
  test::GeneticOutcome outcome;
  for (auto _ : state) outcome = test::run_genetic(problem, options);
  state.counters["hits_of_200"] = outcome.hits;
  state.counters["on_zeros"] = outcome.on_zeros;
}
BENCHMARK(genetic)->Args({20, 50})->Args({50, 100})->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace kadr::planner
