#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "machine/machine_file.h"
#include "machine/motor.h"
#include "machine/two_masses.h"

using namespace kadr;
using namespace kadr::machine;

namespace {

/// An axis with every number that a motor may ask for.
AxisModel axis_with(MotorModel motor, AxisKind kind = AxisKind::linear) {
  AxisModel axis;
  axis.kind = kind;
  axis.step_u = 0.01;
  axis.has_plant = true;
  axis.plant = {.motor = motor,
                .base_mass_kg = 4,
                .link_mass_kg = 1,
                .link_stiffness_N_per_m = 4e4,
                .link_damping_Ns_per_m = 3,
                .base_friction_Ns_per_m = 5,
                .motor_stiffness_N_per_m = 8e5,
                .motor_damping_Ns_per_m = 60,
                .holding_force_N = 250,
                .tooth_pitch_u = 2};
  return axis;
}

}  // namespace

TEST_CASE("every motor's stiffness is the slope of its force at rest") {
  for (const auto& word : kMotorModels) {
    for (const AxisKind kind : {AxisKind::linear, AxisKind::rotary}) {
      INFO(word.word);
      const Motor motor(axis_with(word.value, kind));
      CHECK(motor.model() == word.value);
      CHECK(motor.usable());
      CHECK(motor.force(0) == 0);
      const double lag = 1e-9;
      CHECK((motor.force(-lag) - motor.force(lag)) / (2 * lag) == doctest::Approx(motor.stiffness()));
      const Motor accel = motor.over(4, 1e-3);
      CHECK(accel.force(1e-5) == doctest::Approx(motor.force(1e-5) * 1e-6 / 4));
      CHECK(accel.stiffness() == doctest::Approx(motor.stiffness() * 1e-6 / 4));
    }
  }
}

TEST_CASE("a linear motor's force is proportional to its lag, another one's is not") {
  for (const auto& word : kMotorModels) {
    INFO(word.word);
    const Motor motor(axis_with(word.value));
    const double lag = 2e-4, bent = motor.force(lag) + motor.stiffness() * lag;
    CHECK(motor.linear() == (std::fabs(bent) <= 1e-12 * motor.stiffness() * lag));
    CHECK(motor.linear() == (motor.bend_per_m() == 0));
  }
}

TEST_CASE("a motor with teeth pulls the same from every tooth") {
  for (const auto& word : kMotorModels) {
    const AxisModel axis = axis_with(word.value);
    const Motor motor(axis);
    if (motor.tooth_u() == 0) continue;
    INFO(word.word);
    const double tooth_m = motor.tooth_u() * axis.si_per_u();
    CHECK(motor.force(1e-4 + tooth_m) == doctest::Approx(motor.force(1e-4)).epsilon(1e-9));
    CHECK(motor.force(1e-4 - 3 * tooth_m) == doctest::Approx(motor.force(1e-4)).epsilon(1e-9));
  }
}

TEST_CASE("every motor's series sums to its force along the motion") {
  constexpr std::size_t kSize = 41;
  for (const auto& word : kMotorModels) {
    INFO(word.word);
    Motor(axis_with(word.value)).with_law([&]<class Law>(const Law& law) {
      // lag = 0.1 mm + 0.05 t - 0.02 t^2 + 0.004 t^3 at t = 1, whose speed has the coefficients (n + 1) lag[n
      // + 1]
      std::array<double, kSize> lag{1e-4, 5e-5, -2e-5, 4e-6}, speed{5e-5, -4e-5, 1.2e-5};
      typename Law::template Series<kSize> series(law, {lag, speed});
      double sum = series.force(0);
      for (std::size_t n = 0; n + 1 < kSize; ++n) {
        series.advance(n, 1.0 / static_cast<double>(n + 1));
        sum += series.force(n + 1);
      }
      CHECK(sum == doctest::Approx(law.force(1e-4 + 5e-5 - 2e-5 + 4e-6)).epsilon(1e-12));
    });
  }
}

TEST_CASE("a motor without one of the numbers of its law is not usable") {
  constexpr double TwoMassModel::*kNumbers[] = {&TwoMassModel::motor_stiffness_N_per_m,
                                                &TwoMassModel::holding_force_N, &TwoMassModel::tooth_pitch_u};
  for (const auto& word : kMotorModels) {
    for (const auto number : kNumbers) {
      INFO(word.word);
      AxisModel axis = axis_with(word.value);
      axis.plant.*number = 0;
      CHECK(Motor(axis).usable() == !motor_needs(word.value, number));
    }
  }
}

TEST_CASE("a motor's damping counts only if the motor does not follow its command") {
  for (const auto& word : kMotorModels) {
    const Motor motor(axis_with(word.value));
    INFO(word.word);
    CHECK(motor.damping_Ns_per_m() == (motor.follows_command() ? 0.0 : 60.0));
    CHECK(motor_needs(word.value, &TwoMassModel::motor_damping_Ns_per_m) == !motor.follows_command());
  }
}
