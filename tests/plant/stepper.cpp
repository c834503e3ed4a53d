#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "plant/plant.h"
#include "tests/plant/trains.h"

using namespace kadr;
using namespace kadr::plant;
using namespace kadr::plant::testing;
using machine::IntegratorKind;
using machine::MotorModel;

namespace {

struct Comparison {
  double largest_um = 0;
  double largest_lag_um = 0;
  std::size_t slips = 0;
};

// against Runge-Kutta with steps of at most `rk_us` in 80-bit numbers
Comparison compare(machine::MachineModel model, IntegratorKind kind, const std::vector<StepBatch>& batches,
                   double rk_us) {
  model.plant.integrator = kind;
  Plant plant(model);
  const auto exact = exact_states(model.axis[0], model.clock, 0, batches, rk_us);
  Comparison c;
  std::int64_t node = 0;
  for (std::size_t k = 0; k < batches.size(); ++k) {
    REQUIRE(plant.advance(batches[k]));
    node += batches[k].axis[0].net_steps().value;
    const AxisState& s = plant.state()[0];
    const double lag_um = (s.base_u - static_cast<double>(node) * model.axis[0].step_u) * 1e3;
    c.largest_um = std::max(c.largest_um, std::fabs(lag_um - static_cast<double>(exact[k].lag_m) * 1e6));
    c.largest_um =
        std::max(c.largest_um, std::fabs(s.link_u * 1e3 - static_cast<double>(exact[k].link_m) * 1e6));
    c.largest_lag_um = std::max(c.largest_lag_um, std::fabs(lag_um));
    c.slips += plant.lost_steps().size();
  }
  return c;
}

AxisRecipe stepper(double pitch_steps = 64) {
  AxisRecipe recipe;
  recipe.motor = MotorModel::stepper;
  recipe.pitch_steps = pitch_steps;
  return recipe;
}

}  // namespace

TEST_CASE("the sine stepper stays within 2e-6 um of a fine Runge-Kutta solution from 1 to 100 kHz") {
  // at 156 mm/s the drag pulls the rotor 2 zeta v/w = 62 um back, of a quarter pitch of 100 um
  const auto model = make_machine({stepper(256)});
  for (double rate_hz : {1e3, 8e3, 30e3, 100e3}) {
    CAPTURE(rate_hz);
    const auto batches = pulse_batches(model, {ramp_train(rate_hz, 0.3, 0.12)}, 350);
    const Comparison c = compare(model, IntegratorKind::smooth, batches, 5);
    CHECK(c.slips == 0);
    CHECK(c.largest_lag_um > 0.5);
    CHECK(c.largest_um < 2e-6);
    CHECK(compare(model, IntegratorKind::reference, batches, 5).largest_um < 2e-5);
  }
}

TEST_CASE("coarse full steps, far out on the sine, stay within 2e-6 um of a fine Runge-Kutta solution") {
  // 4 steps per pitch: a step moves the equilibrium by a quarter turn of the sine
  AxisRecipe recipe = stepper(4);
  recipe.motor_ratio = 0.9;
  const auto model = make_machine({recipe});
  const auto batches = pulse_batches(model, {ramp_train(120, 0.9, 0.4)}, 1000);
  const Comparison c = compare(model, IntegratorKind::smooth, batches, 5);
  CHECK(c.slips == 0);
  CHECK(c.largest_lag_um > 1.5625);
  CHECK(c.largest_um < 2e-6);
}

TEST_CASE("a small swing of the stepper is the spring motor's: they differ by the third power of the angle") {
  // lag of one step of 1/6400 pitch: sin differs by (2 pi/6400)^2/6 = 1.6e-7 of it
  AxisRecipe recipe = stepper(6400);
  const auto sine = make_machine({recipe});
  recipe.motor = MotorModel::spring;
  const auto line = make_machine({recipe});
  StepBatch batch;
  batch.axis.resize(1);
  Plant a(sine), b(line);
  double largest_u = 0, size_u = 0;
  for (std::int64_t k = 0; k < 200; ++k) {
    batch.tick = {k};
    batch.axis[0].clear();
    if (k == 0) batch.axis[0].offset_ticks.push_back(17);
    REQUIRE(a.advance(batch));
    REQUIRE(b.advance(batch));
    largest_u = std::max(largest_u, std::fabs(a.state()[0].base_u - b.state()[0].base_u));
    size_u = std::max(size_u, std::fabs(b.state()[0].base_u));
  }
  CHECK(size_u > 1e-3);
  CHECK(largest_u < 1e-6 * size_u);
  CHECK(largest_u > 0);
}

TEST_CASE(
    "a train that starts at full speed loses steps: whole teeth are told, and the axis stays behind by "
    "them") {
  // 100 kHz at once on 1.5625 um steps: the rotor would have to jump to 156 mm/s and lets go
  for (int sign : {1, -1}) {
    for (IntegratorKind kind : {IntegratorKind::smooth, IntegratorKind::reference}) {
      auto model = make_machine({stepper()});
      model.plant.integrator = kind;
      Plant plant(model);
      StepBatch batch;
      batch.axis.resize(1);
      std::int64_t lost = 0, node = 0;
      const std::int64_t ticks = kind == IntegratorKind::smooth ? 4000 : 400;
      for (std::int64_t k = 0; k < ticks; ++k) {
        batch.tick = {k};
        batch.axis[0].clear();
        batch.axis[0].first_sign = static_cast<std::int8_t>(sign);
        for (int i = 0; k < 20 && i < 100; ++i)
          batch.axis[0].offset_ticks.push_back(static_cast<std::uint16_t>(100 * i));
        REQUIRE(plant.advance(batch));
        node += batch.axis[0].net_steps().value;
        for (const LostSteps& slip : plant.lost_steps()) {
          CHECK(slip.axis == 0);
          CHECK(slip.tick.value == k);
          CHECK(slip.steps.value % 64 == 0);
          CHECK(slip.steps.value != 0);
          lost += slip.steps.value;
        }
      }
      CAPTURE(lost);
      CHECK(lost * sign < 0);
      CHECK(std::llabs(lost) <= 2000);
      if (kind == IntegratorKind::smooth) {
        // after 4 s it rests in the tooth where it settled
        CHECK(plant.state()[0].base_u ==
              doctest::Approx(static_cast<double>(node + lost) * 0.0015625).epsilon(1e-9));
        CHECK(std::fabs(plant.state()[0].motor_force_N) < 1e-6);
      }
    }
  }
}

TEST_CASE("nothing is lost while the lag stays below half a tooth, and a lag just above it is") {
  // a load-free axis pushed off by steps within one base tick: 31 of 64 steps is 174 degrees, 33 is 186
  // degrees. Its motor pulls forward below 180 degrees and back above.
  for (int steps : {31, 33}) {
    auto model = make_machine({stepper()});
    model.axis[0].plant.motor_damping_Ns_per_m =
        40 * model.axis[0].plant.motor_damping_Ns_per_m;  // no overshoot past the next tooth
    Plant plant(model);
    StepBatch batch;
    batch.axis.resize(1);
    std::int64_t lost = 0;
    for (std::int64_t k = 0; k < 30000; ++k) {
      batch.tick = {k};
      batch.axis[0].clear();
      if (k == 0) batch.axis[0].offset_ticks.assign(static_cast<std::size_t>(steps), 5);
      REQUIRE(plant.advance(batch));
      for (const LostSteps& slip : plant.lost_steps()) lost += slip.steps.value;
    }
    CHECK(lost == (steps == 31 ? 0 : -64));
    CHECK(plant.state()[0].base_u == doctest::Approx((steps == 31 ? 31 : -31) * 0.0015625).epsilon(1e-6));
  }
}
