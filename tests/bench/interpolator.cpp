#include "emulator/interpolator/interpolator.h"

#include <benchmark/benchmark.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "planner/path/path.h"
#include "tests/emulator/interpolator/interpolator_paths.h"

using namespace kadr;
using namespace kadr::test;

namespace {

std::atomic<std::int64_t> allocations{0};

}  // namespace

// every allocation of this program is counted: after the first ticks there may be none
[[gnu::noinline]] void* operator new(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

/// Runs a path over and over; reports ns per pulse, per tick, and allocations of the second half of each run.
void play(benchmark::State& state, const planner::Path& path, const machine::MachineModel& machine,
          const std::vector<planner::TickMotion>& motions, bool hashed) {
  std::int64_t pulses = 0, late_allocations = 0;
  double worst_clock = 0;
  StepBatch batch;
  for (auto _ : state) {
    state.PauseTiming();
    interpolator::CrossingInterpolator interpolator(path, machine);
    StepHash hash;
    state.ResumeTiming();
    std::int64_t before = 0;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      if (i == motions.size() / 2) before = allocations.load(std::memory_order_relaxed);
      interpolator.advance(motions[i], batch);
      if (hashed) hash.add(batch);
      for (const AxisPulses& axis : batch.axis) pulses += static_cast<std::int64_t>(axis.count());
    }
    late_allocations += allocations.load(std::memory_order_relaxed) - before;
    worst_clock += static_cast<double>(hash.digest() & 1u);
  }
  benchmark::DoNotOptimize(worst_clock);
  const auto ticks = static_cast<double>(state.iterations()) * static_cast<double>(motions.size());
  state.SetItemsProcessed(pulses);
  state.counters["pulses_per_tick"] = static_cast<double>(pulses) / ticks;
  state.counters["s_per_pulse"] = benchmark::Counter(
      static_cast<double>(pulses), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["s_per_tick"] =
      benchmark::Counter(ticks, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["late_allocations"] = static_cast<double>(late_allocations);
}

/// Lines: 3 axes at 50 kHz each.
void lines(benchmark::State& state, Feed feed, bool hashed) {
  const auto machine = machine_with(3);
  PathMaker maker({0.0, 0.0, 0.0});
  maker.line({200.0, 199.0, -198.0});
  play(state, maker.path, machine, drive(maker.path.length_u(), 86.0, machine, feed, 1), hashed);
}
void lines_steady(benchmark::State& s) { lines(s, Feed::constant, false); }
void lines_ramps(benchmark::State& s) { lines(s, Feed::wild, false); }
void lines_steady_hash(benchmark::State& s) { lines(s, Feed::constant, true); }
void lines_ramps_hash(benchmark::State& s) { lines(s, Feed::wild, true); }

/// A circle of 50 mm, about 32 kHz on the mean of both axes; a spiral as rounding makes it; a helix of 1000 turns.
void arcs(benchmark::State& state, double radius, double growth, double turns, double z) {
  const auto machine = machine_with(3);
  PathMaker maker({radius, 0.0, 0.0});
  maker.arc(0, 1, -radius, 0.0, turns * 2 * kPi, growth, {0.0, 0.0, z});
  play(state, maker.path, machine, drive(maker.path.length_u(), 50.0, machine, Feed::wild, 1), true);
}
void circle_hash(benchmark::State& s) { arcs(s, 50.0, 0.0, 2.0, 0.0); }
void spiral_rounding_hash(benchmark::State& s) { arcs(s, 50.0, 1e-12, 1.99, 0.0); }
void spiral_hash(benchmark::State& s) { arcs(s, 50.0, 0.01, 1.99, 0.0); }
void helix_hash(benchmark::State& s) { arcs(s, 0.5, 0.0, 200.0, 20.0); }

/// Segments of 0.05 mm and of 0.001 mm.
void short_lines(benchmark::State& state, double length, int count) {
  const auto machine = machine_with(3);
  Dice dice(1);
  PathMaker maker({0.0, 0.0, 0.0});
  for (int i = 0; i < count; ++i) {
    auto end = maker.at;
    for (double& x : end) x += dice.between(-0.5, 1.0) * length;
    maker.line(end);
  }
  play(state, maker.path, machine, drive(maker.path.length_u(), 50.0, machine, Feed::wild, 1), true);
  state.counters["segments_per_tick"] =
      static_cast<double>(count) /
      static_cast<double>(drive(maker.path.length_u(), 50.0, machine, Feed::wild, 1).size());
}
void short_lines_50um_hash(benchmark::State& s) { short_lines(s, 0.05, 20'000); }
void short_lines_1um_hash(benchmark::State& s) { short_lines(s, 0.001, 200'000); }

/// Nine axes that wait.
void rest(benchmark::State& state) {
  const auto machine = machine_with(9);
  PathMaker maker(std::vector<double>(9, 0.0));
  maker.line(std::vector<double>(9, 1.0));
  play(state, maker.path, machine, std::vector<planner::TickMotion>(10'000), true);
}

BENCHMARK(lines_steady)->Unit(benchmark::kMillisecond);
BENCHMARK(lines_ramps)->Unit(benchmark::kMillisecond);
BENCHMARK(lines_steady_hash)->Unit(benchmark::kMillisecond);
BENCHMARK(lines_ramps_hash)->Unit(benchmark::kMillisecond);
BENCHMARK(circle_hash)->Unit(benchmark::kMillisecond);
BENCHMARK(spiral_rounding_hash)->Unit(benchmark::kMillisecond);
BENCHMARK(spiral_hash)->Unit(benchmark::kMillisecond);
BENCHMARK(helix_hash)->Unit(benchmark::kMillisecond);
BENCHMARK(short_lines_50um_hash)->Unit(benchmark::kMillisecond);
BENCHMARK(short_lines_1um_hash)->Unit(benchmark::kMillisecond);
BENCHMARK(rest)->Unit(benchmark::kMillisecond);

}  // namespace
