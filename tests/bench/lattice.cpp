#include "emulator/interpolator/lattice/lattice.h"

#include <benchmark/benchmark.h>

#include <vector>

#include "planner/bezier/bezier.h"

/// The inner loops of the lattice methods, a byte written per slot; asked for: 200 M steps/s a line kernel,
/// 10 M events/s of a Bezier in 3 axes, 20 ns a t(S).
namespace {

using namespace kadr::interpolator::lattice;

constexpr std::int64_t kA = 1'000'003, kB = 618'035;

template <class Kernel>
void line_kernel(benchmark::State& state, std::int64_t slots) {
  std::vector<std::uint8_t> out(static_cast<std::size_t>(slots));
  for (auto _ : state) {
    Kernel kernel(kA, kB);
    for (std::uint8_t& slot : out) slot = kernel.next();
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * slots);
}
void classic(benchmark::State& state) { line_kernel<ClassicLine>(state, kA + kB); }
void half_step(benchmark::State& state) { line_kernel<HalfStepLine>(state, kA + kB); }
void diagonal(benchmark::State& state) { line_kernel<DiagonalLine>(state, kA); }
BENCHMARK(classic);
BENCHMARK(half_step);
BENCHMARK(diagonal);

void quarter_circle(benchmark::State& state) {
  std::vector<std::uint8_t> out(2'000'000);
  for (auto _ : state) {
    QuarterCircle kernel(1'000'000);
    std::size_t i = 0;
    while (!kernel.done()) out[i++] = kernel.next();
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * 2'000'000);
}
BENCHMARK(quarter_circle);

/// The same behind the door that all methods share.
void stepper(benchmark::State& state, Method method, const Curve& curve) {
  std::int64_t slots = 0;
  for (auto _ : state) {
    const Made made = make_stepper(curve, method);
    Slot slot;
    for (int i = 0; i < 1'000'000 && made.stepper->next(slot); ++i) ++slots;
    benchmark::DoNotOptimize(slot);
  }
  state.SetItemsProcessed(slots);
}
BENCHMARK_CAPTURE(stepper, line_half_step, Method::half_step, LineCurve{2, {kA, kB}});
BENCHMARK_CAPTURE(stepper, line_4_axes_diagonal, Method::diagonal, LineCurve{4, {kA, kB, 414'213, 271'828}});
BENCHMARK_CAPTURE(stepper, arc_half_step, Method::half_step, ArcCurve{{125'000, 0}, {125'000, 0}, Turn::ccw});
BENCHMARK_CAPTURE(stepper, ellipse_half_step, Method::half_step, ellipse(20'000, 9'000));

void bezier_events(benchmark::State& state) {
  const BezierCurve curve{
      3, 3, {{{0, 0, 0}, {90'000, -40'000, 20'000}, {-30'000, 80'000, 70'000}, {60'000, 50'000, -90'000}}}};
  std::int64_t count = 0;
  for (auto _ : state) {
    BezierEvents events(curve);
    BezierEvents::Event event;
    while (events.next(event)) ++count;
    benchmark::DoNotOptimize(event);
  }
  state.SetItemsProcessed(count);
}
BENCHMARK(bezier_events);

/// t(S) of paper 004's quadratic; asked for: 20 ns.
void t_of_length(benchmark::State& state) {
  using namespace kadr::planner;
  const ArcLength arc(Bezier(3, {{0, 0, 0}, {2, 2, 4}, {5, -0.5, 2}}));
  const ArcTable table(arc, static_cast<int>(state.range(0)));
  std::uint32_t place = 0;
  double sum = 0;
  for (auto _ : state) {
    place = place * 1664525u + 1013904223u;
    sum += table.t(arc.length_u() * (place >> 8) * (1.0 / 16777216));
  }
  benchmark::DoNotOptimize(sum);
}
BENCHMARK(t_of_length)->Arg(32)->Arg(128);

}  // namespace
