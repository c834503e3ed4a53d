// The whole pipeline: machine seconds per wall second and pulses per wall second, 3 axes at 50 kHz each.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cstdio>
#include <string>

#include "emulator/emulator.h"
#include "tests/bench/calibration.h"
#include "tests/support/test_machine.h"

namespace {

using namespace kadr;

/// Long diagonals there and back: each axis at 100 mm/s over 2 um steps, so 50,000 pulses a second and axis.
std::string diagonals(int count) {
  std::string program = "G21 G90 G94 G64\n";
  for (int i = 0; i < count; ++i) {
    const int at = i % 2 == 0 ? 400 : 0;
    program += fmt::format("G1 X{} Y{} Z{} F10392.3\n", at, at, at);  // 100 mm/s * sqrt(3) * 60
  }
  return program + "M2\n";
}

machine::MachineModel bench_machine(machine::MotorModel motor) {
  machine::MachineModel m = test::test_machine(3);
  for (machine::AxisModel& axis : m.axis) axis.plant.motor = motor;
  m.path.max_accel_mm_s2 = machine::kInfinity;
  m.path.max_jerk_mm_s3 = machine::kInfinity;
  return m;
}

std::int64_t file_bytes(const std::string& path) {
  struct stat s {};
  return stat(path.c_str(), &s) == 0 ? s.st_size : 0;
}

/// @param plant, log  stages that take part
void run_pipeline(benchmark::State& state, machine::MotorModel motor, bool plant, bool log, int threads,
                  int moves, machine::IntegratorKind integrator = machine::IntegratorKind::smooth) {
  machine::MachineModel model = bench_machine(motor);
  model.plant.integrator = integrator;
  SourceSet sources;
  cycle::JobInputs given;
  given.program = sources.add(SourceText("bench.ngc", diagonals(moves)));
  given.machine.model = model;
  Diagnostics diagnostics;
  const auto job = cycle::prepare(given, sources, diagnostics);
  const std::string path = "/tmp/kadr_bench.lcmlog";
  cycle::RunOptions options;
  options.plant = plant;
  options.threads = threads;
  double machine_s = 0, wall_s = 0, pulses = 0, ticks = 0;
  for (auto _ : state) {
    std::remove(path.c_str());  // giving back the disk space of the last log is not part of a run
    const double begin_s = bench::seconds_now();
    std::unique_ptr<log::RunLog> file;
    if (log) {
      file = *log::open_lcm_log({path, ""});
      log::RunHeader header;
      header.machine = &model;
      if (!file->begin(header)) state.SkipWithError("log");
    }
    const auto summary = cycle::run(*job, file.get(), options);
    if (!summary) {
      state.SkipWithError("run");
      break;
    }
    file.reset();
    wall_s += bench::seconds_now() - begin_s;
    machine_s += static_cast<double>(summary->ticks.value) / 1e7;
    pulses += static_cast<double>(summary->pulses);
    ticks += static_cast<double>(summary->control_ticks.value);
  }
  if (wall_s == 0) return;
  state.counters["machine_s_per_wall_s"] = machine_s / wall_s;
  state.counters["pulses_per_wall_s"] = pulses / wall_s;
  state.counters["units_per_tick"] = wall_s / ticks / bench::calibration_unit_s();
  if (log) {
    const double runs = static_cast<double>(state.iterations());
    const double bytes = static_cast<double>(file_bytes(path));
    state.counters["log_bytes_per_tick_above_1.5_per_pulse"] = (bytes - 1.5 * pulses / runs) / (ticks / runs);
    std::remove(path.c_str());
  }
}

void linear_plant_with_log(benchmark::State& s) {
  run_pipeline(s, machine::MotorModel::spring, true, true, 1, 8);
}
void linear_plant_with_log_two_threads(benchmark::State& s) {
  run_pipeline(s, machine::MotorModel::spring, true, true, 2, 8);
}
void linear_plant_without_log(benchmark::State& s) {
  run_pipeline(s, machine::MotorModel::spring, true, false, 1, 8);
}
void stepper_with_log(benchmark::State& s) {
  run_pipeline(s, machine::MotorModel::stepper, true, true, 1, 1);
}
void pulses_with_log(benchmark::State& s) { run_pipeline(s, machine::MotorModel::spring, false, true, 1, 8); }
void pulses_alone(benchmark::State& s) { run_pipeline(s, machine::MotorModel::spring, false, false, 1, 8); }

void linear_plant_closed_form_with_log(benchmark::State& s) {
  run_pipeline(s, machine::MotorModel::spring, true, true, 1, 8, machine::IntegratorKind::oracle);
}

BENCHMARK(linear_plant_closed_form_with_log)->Unit(benchmark::kMillisecond);
BENCHMARK(linear_plant_with_log)->Unit(benchmark::kMillisecond);
BENCHMARK(linear_plant_with_log_two_threads)->Unit(benchmark::kMillisecond);
BENCHMARK(linear_plant_without_log)->Unit(benchmark::kMillisecond);
BENCHMARK(stepper_with_log)->Unit(benchmark::kMillisecond);
BENCHMARK(pulses_with_log)->Unit(benchmark::kMillisecond);
BENCHMARK(pulses_alone)->Unit(benchmark::kMillisecond);

}  // namespace
