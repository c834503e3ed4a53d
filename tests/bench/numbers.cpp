#include "machine/base/numbers.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

using namespace kadr;

namespace {

std::vector<double> arguments(double low, double high) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> pick(low, high);
  std::vector<double> list(4096);
  for (double& x : list) x = pick(random);
  return list;
}

template <class F>
void each(benchmark::State& state, double low, double high, F&& f) {
  const std::vector<double> list = arguments(low, high);
  for (auto _ : state)
    for (const double x : list) benchmark::DoNotOptimize(f(x));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(list.size()));
}

void sincos_exact(benchmark::State& s) {
  each(s, -1000, 1000, [](double x) { return exact_sincos(x); });
}
void sincos_libm(benchmark::State& s) {
  each(s, -1000, 1000, [](double x) { return SinCos{std::sin(x), std::cos(x)}; });
}
void atan2_exact(benchmark::State& s) {
  each(s, -3, 3, [](double x) { return exact_atan2(x, 1 - x); });
}
void atan2_libm(benchmark::State& s) {
  each(s, -3, 3, [](double x) { return std::atan2(x, 1 - x); });
}
void exp_exact(benchmark::State& s) { each(s, -50, 50, exact_exp); }
void log_exact(benchmark::State& s) { each(s, 0.01, 100, exact_log); }
void pow_exact(benchmark::State& s) {
  each(s, 0.01, 100, [](double x) { return exact_pow(x, 0.2); });
}

}  // namespace

BENCHMARK(sincos_exact);
BENCHMARK(sincos_libm);
BENCHMARK(atan2_exact);
BENCHMARK(atan2_libm);
BENCHMARK(exp_exact);
BENCHMARK(log_exact);
BENCHMARK(pow_exact);
