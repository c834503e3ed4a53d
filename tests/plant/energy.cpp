#include <doctest/doctest.h>

#include <cmath>

#include "plant/plant.h"
#include "tests/plant/trains.h"

using namespace kadr;
using namespace kadr::plant;
using namespace kadr::plant::testing;
using machine::IntegratorKind;
using machine::MotorModel;

namespace {

// Largest |motor work - kinetic - spring - dissipated| over ticks and axes, as a part of the largest work
// done. Work and losses are integrals of power from pulse to pulse, kinetic and spring
// energy come from the integrator's state.
double gap(machine::MachineModel model, IntegratorKind kind, const std::vector<StepBatch>& batches) {
  model.plant.integrator = kind;
  Plant plant(model, {.energy = true});
  double largest_J = 0, work_J = 0;
  for (const StepBatch& batch : batches) {
    REQUIRE(plant.advance(batch));
    for (int a = 0; a < static_cast<int>(model.axis.size()); ++a) {
      const EnergyBalance e = plant.energy(a);
      CHECK(e.kinetic_J >= 0);
      CHECK(e.spring_J >= 0);
      CHECK(e.dissipated_J >= 0);
      work_J = std::max(work_J, std::fabs(e.motor_work_J));
      largest_J = std::max(largest_J, std::fabs(e.motor_work_J - e.kinetic_J - e.spring_J - e.dissipated_J));
    }
  }
  CHECK(work_J > 1e-6);
  return largest_J / work_J;
}

std::vector<AxisRecipe> two_axes(MotorModel motor) {
  AxisRecipe x, b;
  x.motor = b.motor = motor;
  b.kind = machine::AxisKind::rotary;
  b.base_kg = 0.02;
  b.link_kg = 0.004;
  b.step_u = 0.05;
  return {x, b};
}

}  // namespace

TEST_CASE("energy closes to 1e-9 of the work done: spring motors under every integrator") {
  const auto model = make_machine(two_axes(MotorModel::spring));
  const auto batches = pulse_batches(model, {ramp_train(40e3, 0.2, 0.08), swing(500, 15)}, 250);
  CHECK(gap(model, IntegratorKind::oracle, batches) < 1e-12);
  CHECK(gap(model, IntegratorKind::smooth, batches) < 1e-9);
  CHECK(gap(model, IntegratorKind::reference, batches) < 1e-9);
}

TEST_CASE("energy closes to 1e-9 of the work done: sine steppers") {
  const auto model = make_machine(two_axes(MotorModel::stepper));
  const auto batches = pulse_batches(model, {ramp_train(40e3, 0.2, 0.08), swing(500, 15)}, 250);
  CHECK(gap(model, IntegratorKind::smooth, batches) < 1e-12);
  CHECK(gap(model, IntegratorKind::reference, batches) < 1e-9);
}

TEST_CASE("energy closes to 1e-11 of the work done: rigid axes, corners included") {
  const auto model = make_machine(two_axes(MotorModel::rigid));
  auto batches = pulse_batches(model, {ramp_train(40e3, 0.2, 0.08), swing(500, 15)}, 250);
  // the commands of pulse_batches are cubics that do not join in acceleration; a jump of speed besides
  for (std::size_t k = 100; k < 120; ++k) batches[k].axis[0].command.speed_begin_u_s += 3;
  CHECK(gap(model, IntegratorKind::smooth, batches) < 1e-11);
}

TEST_CASE("without damping a stopped axis keeps its energy: nothing dissipated, the rest constant to 5e-9") {
  AxisRecipe recipe;
  recipe.motor_ratio = 0;
  recipe.link_ratio = 0;
  auto model = make_machine({recipe});
  Plant plant(model, {.energy = true});
  StepBatch batch;
  batch.axis.resize(1);
  batch.axis[0].offset_ticks = {0, 3000, 9999};
  REQUIRE(plant.advance(batch));
  batch.axis[0].clear();
  double low_J = 1e9, high_J = 0;
  for (std::int64_t k = 1; k < 3000; ++k) {
    batch.tick = {k};
    REQUIRE(plant.advance(batch));
    const EnergyBalance e = plant.energy(0);
    CHECK(e.dissipated_J == 0);
    // what the motor's own spring holds is the motor's: it belongs to the total that is kept
    const double lag_m = (plant.state()[0].base_u - 3 * 0.0015625) * 1e-3;
    const double total_J =
        e.kinetic_J + e.spring_J + 0.5 * model.axis[0].plant.motor_stiffness_N_per_m * lag_m * lag_m;
    low_J = std::min(low_J, total_J);
    high_J = std::max(high_J, total_J);
  }
  CHECK(high_J > 1e-9);
  CHECK((high_J - low_J) / high_J < 5e-9);
}

TEST_CASE("energy that was not asked for is a broken promise, not a zero") {
  const auto model = make_machine({AxisRecipe{}});
  const Plant plant(model);
  CHECK_THROWS(plant.energy(0));
}
