#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "machine/machine.h"
#include "machine/step_batch.h"

/// Step trains and machines for the plant's tests, and solutions by independent means.
namespace kadr::plant::testing {

/// A motion in steps as a function of time in s, and its speed in steps per s.
struct Motion {
  std::function<double(double)> steps;
  std::function<double(double)> steps_s;
};

/// Raised-cosine ramp to `rate_hz`, constant rate, ramp back, then rest. Length `total_s`, each ramp `ramp_s`.
Motion ramp_train(double rate_hz, double total_s, double ramp_s);
/// There and back again: amplitude * (1 - cos(2 pi f t)) / 2.
Motion swing(double amplitude_steps, double frequency_hz);

/// Pulses at the half crossings of the motion, tick by tick, for `ticks` control ticks.
/// @param motion  [axes]
std::vector<StepBatch> pulse_batches(const machine::MachineModel& machine, const std::vector<Motion>& motion,
                                     std::int64_t ticks);

/// Parameters of an axis by what one can imagine: masses in kg, undamped frequencies in Hz of the whole on
/// the motor's spring and of the link alone, damping ratios of both.
struct AxisRecipe {
  double base_kg = 4, link_kg = 1;
  double motor_hz = 80, motor_ratio = 0.1;
  double link_hz = 35, link_ratio = 0.02;
  double step_u = 0.0015625;
  machine::MotorModel motor = machine::MotorModel::spring;
  machine::AxisKind kind = machine::AxisKind::linear;
  double pitch_steps = 64;
};
machine::AxisModel make_axis(const AxisRecipe& recipe);
machine::MachineModel make_machine(const std::vector<AxisRecipe>& axes, double tau_ms = 1,
                                   std::int64_t base_hz = 10'000'000);

/// Solution from pulse to pulse in 80-bit arithmetic: Taylor's series of e^{At} for the spring motor,
/// classical Runge-Kutta with steps of at most `rk_us` for the stepper. State in SI at every tick end: base
/// relative to the node, base speed, link, link speed.
struct ExactState {
  long double lag_m, base_m_s, link_m, link_m_s;
};
std::vector<ExactState> exact_states(const machine::AxisModel& axis, const machine::ClockModel& clock,
                                     int index, const std::vector<StepBatch>& batches, double rk_us = 2);

/// Seed and number of cases of a property test: KADR_SEED, KADR_COUNT.
std::uint64_t property_seed();
int property_count(int normal);

/// Numbers in [0, 1) from splitmix64; the same everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double next();
  double between(double low, double high) { return low + (high - low) * next(); }
  /// Even on a logarithmic scale.
  double log_between(double low, double high);

 private:
  std::uint64_t state_;
};

}  // namespace kadr::plant::testing
