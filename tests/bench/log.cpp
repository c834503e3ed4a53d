#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "emulator/log/pulse_code.h"
#include "emulator/log/run_log.h"
#include "machine/machine.h"

/// Encoding and writing of the log: nanoseconds per pulse and control tick, bytes per pulse and tick, MB/s.
namespace {

using namespace kadr;
using namespace kadr::log;

constexpr std::int64_t kTicks = 2048;
constexpr std::int64_t kTau = 10'000;

/// Control ticks of pulses at a steady rate that is no whole number of base ticks.
std::vector<StepBatch> make_batches(int axes, double steps_per_s) {
  std::vector<StepBatch> batches(kTicks);
  for (std::int64_t k = 0; k < kTicks; ++k) {
    StepBatch& batch = batches[static_cast<std::size_t>(k)];
    batch.tick = ControlTicks{k};
    batch.axis.resize(static_cast<std::size_t>(axes));
    for (int a = 0; a < axes; ++a) {
      const double interval = 1e7 / (steps_per_s * (1 - 0.07 * a));
      auto& offsets = batch.axis[static_cast<std::size_t>(a)].offset_ticks;
      for (double n = std::ceil(static_cast<double>(k * kTau) / interval);; ++n) {
        const auto at = static_cast<std::int64_t>(std::floor(n * interval)) - k * kTau;
        if (at >= kTau) break;
        offsets.push_back(static_cast<std::uint16_t>(at < 0 ? 0 : at));
      }
    }
  }
  return batches;
}

std::int64_t count(const std::vector<StepBatch>& batches) {
  std::int64_t pulses = 0;
  for (const StepBatch& b : batches)
    for (const AxisPulses& p : b.axis) pulses += static_cast<std::int64_t>(p.count());
  return pulses;
}

void encode_pulses(benchmark::State& state) {
  const auto batches = make_batches(1, static_cast<double>(state.range(0)) * 1000);
  PulseEncoder encoder;
  std::vector<std::uint8_t> code;
  std::size_t bytes = 0;
  for (auto _ : state) {
    bytes = 0;
    for (std::size_t k = 0; k < batches.size(); ++k) {
      if (k % 32 == 0) encoder.begin_block();
      encoder.add(batches[k].axis[0], static_cast<std::int32_t>(k % 32 * kTau));
      if (k % 32 != 31) continue;
      code.clear();
      encoder.finish_block(code);
      bytes += code.size();
    }
    benchmark::DoNotOptimize(code.data());
  }
  const auto pulses = static_cast<double>(count(batches));
  state.counters["s_per_pulse"] =
      benchmark::Counter(pulses, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["B_per_pulse"] = static_cast<double>(bytes) / pulses;
}
BENCHMARK(encode_pulses)->Arg(1)->Arg(10)->Arg(50)->Arg(100)->Unit(benchmark::kMicrosecond);

void decode_pulses_of_a_block(benchmark::State& state) {
  const auto batches = make_batches(1, 50e3);
  PulseEncoder encoder;
  encoder.begin_block();
  for (std::size_t k = 0; k < 32; ++k) encoder.add(batches[k].axis[0], static_cast<std::int32_t>(k * kTau));
  std::vector<std::uint8_t> code;
  encoder.finish_block(code);
  std::vector<StepBatch> out(32);
  for (StepBatch& b : out) b.axis.resize(1);
  for (auto _ : state) {
    const auto decoded = decode_pulses(code, {encoder.pulses(), encoder.reversals(), 32, kTau}, out, 0);
    benchmark::DoNotOptimize(decoded.has_value());
  }
  state.counters["s_per_pulse"] = benchmark::Counter(
      encoder.pulses(), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(decode_pulses_of_a_block)->Unit(benchmark::kMicrosecond);

/// A whole log to a file in the working folder. Arguments: kHz of each axis, plant, viewer rate in Hz.
void write_log(benchmark::State& state) {
  machine::MachineModel machine;
  for (const char letter : {'X', 'Y', 'Z'}) {
    machine::AxisModel axis;
    axis.letter = letter;
    axis.step_u = 0.001;
    machine.axis.push_back(axis);
  }
  machine.log.viewer_rate_hz = static_cast<double>(state.range(2));
  const bool moves = state.range(0) > 0;
  const auto batches = make_batches(3, moves ? static_cast<double>(state.range(0)) * 1000 : 1e-3);
  const std::string path = "bench-log-" + std::to_string(::getpid()) + ".lcmlog";
  RunHeader header;
  header.machine = &machine;
  const std::vector<AxisState> states(3, {1.5, 2.5, 3.5, 4.5, 5.5});
  std::int64_t bytes = 0;
  for (auto _ : state) {
    auto log = open_lcm_log({path, ""});
    bool good = log.has_value() && (*log)->begin(header).has_value();
    std::vector<std::int64_t> position(3);
    TickMotion motion;
    TickRecord record;
    record.motion = &motion;
    record.position_steps = &position;
    record.axis = state.range(1) ? &states : nullptr;
    for (const StepBatch& batch : batches) {
      record.tick = motion.tick = batch.tick;
      for (std::size_t a = 0; a < 3; ++a) position[a] += batch.axis[a].net_steps().value;
      good = good && (*log)->tick(record, batch).has_value();
    }
    RunSummary summary;
    summary.axis.resize(3);
    good = good && (*log)->end(summary).has_value();
    if (!good) state.SkipWithError("the log was not written");
  }
  if (std::FILE* file = std::fopen(path.c_str(), "rb")) {
    std::fseek(file, 0, SEEK_END);
    bytes = std::ftell(file);
    std::fclose(file);
  }
  std::remove(path.c_str());
  const auto pulses = static_cast<double>(count(batches));
  using benchmark::Counter;
  state.counters["s_per_tick"] = Counter(kTicks, Counter::kIsIterationInvariantRate | Counter::kInvert);
  if (moves)
    state.counters["s_per_pulse"] = Counter(pulses, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["B_per_tick"] = static_cast<double>(bytes) / kTicks;
  state.counters["machine_s_per_s"] = Counter(kTicks * 1e-3, Counter::kIsIterationInvariantRate);
  state.SetBytesProcessed(state.iterations() * bytes);
}
BENCHMARK(write_log)
    ->ArgNames({"kHz", "plant", "viewer_Hz"})
    ->Args({50, 1, 100})
    ->Args({50, 0, 0})
    ->Args({100, 1, 100})
    ->Args({0, 1, 100})
    ->Args({0, 1, 0})
    ->Unit(benchmark::kMillisecond);

}  // namespace
