#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <new>

#include "plant/cvode.h"
#include "plant/plant.h"
#include "tests/plant/trains.h"

using namespace kadr;
using namespace kadr::plant;
using namespace kadr::plant::testing;
using machine::IntegratorKind;
using machine::MotorModel;

namespace {

std::int64_t allocations = 0;

StepBatch one_pulse(std::int64_t tick, std::uint16_t offset = 100) {
  StepBatch batch;
  batch.tick = {tick};
  batch.axis.resize(1);
  batch.axis[0].offset_ticks = {offset};
  return batch;
}

}  // namespace

// counts what the whole test program takes from the heap through C++
void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

TEST_CASE("the oracle refuses a stepper at the first tick, and says which axis") {
  AxisRecipe x, y;
  y.motor = MotorModel::stepper;
  auto model = make_machine({x, y});
  model.plant.integrator = IntegratorKind::oracle;
  Plant plant(model);
  StepBatch batch;
  batch.tick = {7};
  batch.axis.resize(2);
  for (int again = 0; again < 2; ++again) {
    const auto moved = plant.advance(batch);
    REQUIRE(!moved);
    CHECK(moved.error().flag == "ORACLE_NEEDS_LINEAR_MOTOR");
    CHECK(moved.error().axis == 1);
    CHECK(moved.error().tick.value == 7);
    plant.reset({0, 0});  // does not help
  }
}

TEST_CASE("masses, stiffnesses and tolerances that are zero or not finite are refused, not divided by") {
  for (int kind = 0; kind < 6; ++kind) {
    auto model = make_machine({AxisRecipe{}});
    machine::TwoMassModel& m = model.axis[0].plant;
    if (kind == 0) m.base_mass_kg = 0;
    if (kind == 1) m.link_mass_kg = 0;
    if (kind == 2) m.motor_stiffness_N_per_m = 0;
    if (kind == 3) m.link_stiffness_N_per_m = std::nan("");
    if (kind == 4) model.plant.tolerance_um = 0;
    if (kind == 5) model.clock.control_tick = {70000};
    Plant plant(model);
    const auto moved = plant.advance(one_pulse(0));
    CAPTURE(kind);
    REQUIRE(!moved);
    CHECK(moved.error().flag == "BAD_PARAMETERS");
  }
}

TEST_CASE("a rigid axis refuses a command that jumps or is not a number; a reset helps") {
  AxisRecipe recipe;
  recipe.motor = MotorModel::rigid;
  Plant plant(make_machine({recipe}));
  StepBatch batch = one_pulse(3);
  batch.axis[0].command = {1, 1, 0, 0};
  auto moved = plant.advance(batch);
  REQUIRE(!moved);
  CHECK(moved.error().flag == "COMMAND_JUMP");
  CHECK(moved.error().axis == 0);
  CHECK(!plant.advance(batch));
  plant.reset({1});
  CHECK(plant.advance(batch));
  CHECK(plant.state()[0].base_u == 1);
  batch.axis[0].command.speed_end_u_s = std::nan("");
  moved = plant.advance(batch);
  REQUIRE(!moved);
  CHECK(moved.error().flag == "NOT_FINITE");
}

TEST_CASE("a batch that breaks its promises is told, not indexed with") {
  for (IntegratorKind kind : {IntegratorKind::smooth, IntegratorKind::reference, IntegratorKind::oracle}) {
    auto model = make_machine({AxisRecipe{}});
    model.plant.integrator = kind;
    Plant plant(model);
    CHECK_THROWS(plant.advance(one_pulse(0, 10000)));
    StepBatch back = one_pulse(0);
    back.axis[0].offset_ticks = {5, 4};
    CHECK_THROWS(plant.advance(back));
    CHECK_THROWS(plant.advance(StepBatch{}));
    CHECK_THROWS(plant.reset({}));
    CHECK(plant.advance(one_pulse(0, 9999)));
  }
}

TEST_CASE("a step far too large is followed or refused, but never answered with a NaN") {
  for (MotorModel motor : {MotorModel::spring, MotorModel::stepper}) {
    for (double step_u : {1e3, 1e12, 1e300}) {
      AxisRecipe recipe;
      recipe.motor = motor;
      recipe.step_u = step_u;
      Plant plant(make_machine({recipe}));
      for (std::int64_t k = 0; k < 20; ++k) {
        const auto moved = plant.advance(one_pulse(k));
        if (!moved) {
          CHECK(!moved.error().flag.empty());
          break;
        }
        CHECK(std::isfinite(plant.state()[0].base_u));
      }
    }
  }
}

TEST_CASE("CVODE's return flag comes back by name with its message") {
  // y' = y^2 from 1 is infinite at t = 1
  const auto blow_up = [](const void*, double, const double* y, double* dydt) {
    for (int i = 0; i < 4; ++i) dydt[i] = y[i] * y[i];
  };
  Cvode cvode({1e-10, 1e-10, 1e-10, 1e-10}, blow_up, nullptr);
  double y[4] = {1, 1, 1, 1};
  REQUIRE(cvode.start(0, y));
  REQUIRE(cvode.advance(0.5, y));
  CHECK(y[0] == doctest::Approx(2).epsilon(1e-8));
  const auto failed = cvode.advance(2, y);
  REQUIRE(!failed);
  CHECK(failed.error().flag.substr(0, 3) == "CV_");
  CHECK(!failed.error().detail.empty());
}

TEST_CASE("axes without plant give states that equal the command") {
  machine::MachineModel model;
  model.axis.resize(2);
  model.axis[0].home_u = 5;
  Plant plant(model);
  CHECK(plant.state()[0].base_u == 5);
  StepBatch batch;
  batch.axis.resize(2);
  batch.axis[0].command = {5, 6, 0, 20};
  REQUIRE(plant.advance(batch));
  CHECK(plant.state()[0].base_u == 6);
  CHECK(plant.state()[0].base_u_s == 20);
  CHECK(plant.state()[0].link_u == 0);
  CHECK(plant.state()[1].base_u == 0);
}

TEST_CASE("advance takes nothing from the heap, with every integrator and motor, energy included") {
  for (MotorModel motor : {MotorModel::rigid, MotorModel::spring, MotorModel::stepper}) {
    for (IntegratorKind kind : {IntegratorKind::smooth, IntegratorKind::reference, IntegratorKind::oracle}) {
      if (motor == MotorModel::stepper && kind == IntegratorKind::oracle) continue;
      AxisRecipe recipe;
      recipe.motor = motor;
      auto model = make_machine({recipe, recipe});
      model.plant.integrator = kind;
      const auto batches = pulse_batches(model, {swing(40, 20), ramp_train(3e3, 0.05, 0.02)}, 80);
      Plant plant(model, {.energy = true});
      REQUIRE(plant.advance(batches[0]));
      const std::int64_t before = allocations;
      bool moved = true;
      for (std::size_t k = 1; k < batches.size(); ++k) moved = plant.advance(batches[k]).has_value() && moved;
      const std::int64_t taken = allocations - before;
      CHECK(moved);
      CHECK(taken == 0);
    }
  }
}
