#include "plant/plant.h"

#include <benchmark/benchmark.h>

#include <cmath>

#include "machine/machine.h"

// Plant alone: three axes, control tick 1 ms. "machine_s_per_s" is machine seconds per wall second.

namespace {

using namespace kadr;

// Two masses with the given frequencies (whole on the motor's spring, link alone) and damping ratios 0.1 and 0.02.
machine::AxisModel make_axis(machine::MotorModel motor, double base_kg, double motor_hz, double link_hz) {
  constexpr double kTwoPi = 6.283185307179586;
  machine::AxisModel axis;
  axis.step_u = 0.0015625;
  axis.has_plant = true;
  const double link_kg = base_kg / 4, all_kg = base_kg + link_kg;
  const double motor_rad_s = kTwoPi * motor_hz, link_rad_s = kTwoPi * link_hz;
  machine::TwoMassModel& m = axis.plant;
  m.motor = motor;
  m.base_mass_kg = base_kg;
  m.link_mass_kg = link_kg;
  m.link_stiffness_N_per_m = link_kg * link_rad_s * link_rad_s;
  m.link_damping_Ns_per_m = 2 * 0.02 * link_rad_s * link_kg;
  m.motor_stiffness_N_per_m = all_kg * motor_rad_s * motor_rad_s;
  m.motor_damping_Ns_per_m = 2 * 0.1 * motor_rad_s * all_kg;
  m.tooth_pitch_u = 256 * axis.step_u;
  m.holding_force_N = m.motor_stiffness_N_per_m * m.tooth_pitch_u * 1e-3 / kTwoPi;
  return axis;
}

// Rates swing between 60 and 100 % of the peak, so that the command is never a straight line.
std::vector<StepBatch> train(const machine::MachineModel& machine, double peak_hz, std::int64_t ticks) {
  std::vector<StepBatch> batches(static_cast<std::size_t>(ticks));
  const auto tau = static_cast<double>(machine.clock.control_tick.value);
  for (std::size_t a = 0; a < machine.axis.size(); ++a) {
    const double scale = 1 - 0.07 * static_cast<double>(a);
    double position = 0, speed = 0;
    std::int64_t node = 0;
    for (std::int64_t k = 0; k < ticks; ++k) {
      StepBatch& batch = batches[static_cast<std::size_t>(k)];
      batch.tick = {k};
      batch.axis.resize(machine.axis.size());
      AxisPulses& pulses = batch.axis[a];
      // steps per tick at the end, reached evenly within it
      const double ramp = std::min(1.0, static_cast<double>(k + 1) / 150);
      const double end =
          peak_hz * 1e-3 * scale * ramp * (0.8 + 0.2 * std::sin(0.013 * static_cast<double>(k + 1)));
      const double next = position + (speed + end) / 2;
      for (; static_cast<double>(node) + 0.5 < next; ++node) {
        const double part = (static_cast<double>(node) + 0.5 - position) / (next - position);
        pulses.offset_ticks.push_back(static_cast<std::uint16_t>(std::min(tau - 1, part * tau)));
      }
      pulses.command = {position * 0.0015625, next * 0.0015625, speed * 1.5625, end * 1.5625};
      position = next;
      speed = end;
    }
  }
  return batches;
}

void run(benchmark::State& state, machine::MotorModel motor, machine::IntegratorKind integrator,
         bool energy = false) {
  machine::MachineModel machine;
  machine.axis = {make_axis(motor, 4, 80, 35), make_axis(motor, 6, 60, 40), make_axis(motor, 2, 100, 50)};
  machine.plant.integrator = integrator;
  const auto batches = train(machine, static_cast<double>(state.range(0)), 4000);
  std::int64_t ticks = 0, pulses = 0;
  plant::Plant plant(machine, {.energy = energy});
  const std::vector<double> home(machine.axis.size(), 0.0);
  for (auto _ : state) {
    plant.reset(home);
    for (const StepBatch& batch : batches) {
      if (!plant.advance(batch)) return state.SkipWithError("plant error");
      for (const AxisPulses& axis : batch.axis) pulses += static_cast<std::int64_t>(axis.count());
    }
    benchmark::DoNotOptimize(plant.state().data());
    ticks += static_cast<std::int64_t>(batches.size());
  }
  using benchmark::Counter;
  state.counters["machine_s_per_s"] = Counter(static_cast<double>(ticks) * 1e-3, Counter::kIsRate);
  state.counters["s_per_tick"] = Counter(static_cast<double>(ticks), Counter::kIsRate | Counter::kInvert);
  state.counters["pulses_per_s"] = Counter(static_cast<double>(pulses), Counter::kIsRate);
}

using machine::IntegratorKind;
using machine::MotorModel;

BENCHMARK_CAPTURE(run, spring_smooth, MotorModel::spring, IntegratorKind::smooth)
    ->Arg(0)
    ->Arg(1000)
    ->Arg(10000)
    ->Arg(50000)
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, spring_oracle, MotorModel::spring, IntegratorKind::oracle)
    ->Arg(50000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, spring_reference, MotorModel::spring, IntegratorKind::reference)
    ->Arg(50000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, spring_smooth_energy, MotorModel::spring, IntegratorKind::smooth, true)
    ->Arg(50000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, stepper, MotorModel::stepper, IntegratorKind::smooth)
    ->Arg(1000)
    ->Arg(10000)
    ->Arg(50000)
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, rigid, MotorModel::rigid, IntegratorKind::smooth)
    ->Arg(50000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
