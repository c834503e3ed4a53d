#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include "gcode/block.h"
#include "machine/base/numbers.h"
#include "machine/machine.h"
#include "planner/planner.h"

// A million short segments: from blocks to path, from path to law.
namespace kadr {
namespace {

machine::MachineModel bench_machine(bool jerk, bool blocks = false) {
  machine::MachineModel m;
  m.name = "bench";
  for (const char letter : {'X', 'Y', 'Z'}) {
    machine::AxisModel axis;
    axis.letter = letter;
    axis.step_u = 0.001;
    axis.max_feed_u_s = 110.0;
    axis.max_accel_u_s2 = 2000.0;
    axis.max_jerk_u_s3 = jerk ? 40000.0 : machine::kInfinity;
    axis.junction_accel_u_s2 = 2000.0;
    m.axis.push_back(axis);
  }
  m.path.centripetal_accel_mm_s2 = 2000.0;
  if (blocks) m.planner.scheduler = machine::SchedulerKind::blockwise;
  return m;
}

enum class Shape { curve, zigzag, straight };

/// A rounded smooth curve of 0.2 mm facets, a zigzag of random corners, or one straight line in pieces.
std::vector<gcode::Block> make_blocks(Shape shape, int count) {
  std::vector<gcode::Block> blocks;
  blocks.reserve(static_cast<std::size_t>(count));
  std::uint64_t state = 1;
  const auto unit = [&] {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(state >> 11) * 0x1p-53;
  };
  double x = 0, y = 0, angle = 0, turn = 0, last_x = 0, last_y = 0;
  for (int i = 0; i < count; ++i) {
    if (shape == Shape::curve) {
      turn = 0.98 * turn + 0.01 * (unit() - 0.5);
      angle += turn;
    } else if (shape == Shape::zigzag) {
      angle += 3.0 * (unit() - 0.5);
    }
    const double step = shape == Shape::zigzag ? 0.05 + unit() : 0.2;
    const SinCos d = exact_sincos(angle);
    x += step * d.cos;
    y += step * d.sin;
    gcode::Feed b;
    b.end[0] = std::floor(x * 1e4 + 0.5) / 1e4;
    b.end[1] = std::floor(y * 1e4 + 0.5) / 1e4;
    b.length_u =
        std::sqrt((b.end[0] - last_x) * (b.end[0] - last_x) + (b.end[1] - last_y) * (b.end[1] - last_y));
    b.feed_u_s = 100.0;
    last_x = b.end[0];
    last_y = b.end[1];
    blocks.push_back({{}, b});
  }
  return blocks;
}

long resident_kB() {
  long pages = 0, unused = 0;
  if (std::FILE* f = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(f, "%ld %ld", &unused, &pages) != 2) pages = 0;
    std::fclose(f);
  }
  return pages * 4;
}

void plan_million(benchmark::State& state) {
  const machine::MachineModel machine = bench_machine(state.range(1) != 0, state.range(2) != 0);
  const auto blocks = make_blocks(static_cast<Shape>(state.range(0)), 1'000'000);
  const long before = resident_kB();
  double duration = 0, pieces = 0, after = 0, plan_s = 0;
  for (auto _ : state) {
    planner::PathBuilder builder(machine, {});
    for (const gcode::Block& b : blocks) builder.add(b);
    const planner::Path path = builder.take();
    const auto begin = std::chrono::steady_clock::now();
    const auto plan = planner::plan(path, machine);
    plan_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    duration = plan->law.duration_s;
    pieces = static_cast<double>(plan->law.pieces.size());
    after = static_cast<double>(resident_kB());
    benchmark::DoNotOptimize(duration);
  }
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  state.counters["plan_ms"] =
      1e3 * plan_s / static_cast<double>(state.iterations());  // the rest makes the path
  state.counters["motion_s"] = duration;
  state.counters["pieces"] = pieces;
  state.counters["path_and_plan_MB"] = (after - static_cast<double>(before)) / 1024.0;
  state.counters["peak_process_MB"] = static_cast<double>(use.ru_maxrss) / 1024.0;
}
BENCHMARK(plan_million)
    ->ArgNames({"shape", "jerk", "blockwise"})
    ->Args({0, 1, 0})
    ->Args({1, 1, 0})
    ->Args({2, 1, 0})
    ->Args({0, 0, 0})
    ->Args({1, 0, 0})
    ->Args({0, 1, 1})
    ->Args({1, 1, 1})
    ->Args({2, 1, 1})
    ->Args({0, 0, 1})
    ->Unit(benchmark::kMillisecond);

void law_source_tick(benchmark::State& state) {
  const machine::MachineModel machine = bench_machine(true);
  planner::PathBuilder builder(machine, {});
  for (const gcode::Block& b : make_blocks(Shape::curve, 100'000)) builder.add(b);
  const auto plan = planner::plan(builder.path(), machine);
  auto source = std::make_unique<planner::LawSource>(plan->law, machine);
  for (auto _ : state) {
    if (source->finished()) source = std::make_unique<planner::LawSource>(plan->law, machine);
    benchmark::DoNotOptimize(source->advance({}).s_end_u);
  }
}
BENCHMARK(law_source_tick);

/// The control law of one tick: the plan played as it is, a settled override, one that changes in every tick.
enum class Hand { none, settled, restless };

void control_tick(benchmark::State& state, Shape shape, Hand hand) {
  const auto machine = bench_machine(true);
  planner::PathBuilder builder(machine, {});
  for (const gcode::Block& b : make_blocks(shape, 100'000)) builder.add(b);
  const planner::Path path = builder.take();
  const auto plan = planner::plan(path, machine);
  if (!plan) return state.SkipWithError("no plan");
  std::unique_ptr<planner::MotionSource> source;
  std::int64_t tick = 0;
  planner::OperatorInput input;
  for (auto _ : state) {
    if (!source || source->finished()) {
      state.PauseTiming();
      source = planner::override_source(path, *plan, machine, 1.2);
      state.ResumeTiming();
    }
    if (hand == Hand::settled) input.feed_override = 0.7;
    if (hand == Hand::restless) input.feed_override = 0.7 + 0.001 * static_cast<double>(++tick % 300);
    benchmark::DoNotOptimize(source->advance(input).s_end_u);
  }
}
BENCHMARK_CAPTURE(control_tick, law, Shape::straight, Hand::none);
BENCHMARK_CAPTURE(control_tick, straight_settled, Shape::straight, Hand::settled);
BENCHMARK_CAPTURE(control_tick, straight_changing_each_tick, Shape::straight, Hand::restless);
BENCHMARK_CAPTURE(control_tick, facets_settled, Shape::curve, Hand::settled);
BENCHMARK_CAPTURE(control_tick, facets_changing_each_tick, Shape::curve, Hand::restless);

}  // namespace
}  // namespace kadr
