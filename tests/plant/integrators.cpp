#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "plant/plant.h"
#include "tests/plant/trains.h"

using namespace kadr;
using namespace kadr::plant;
using namespace kadr::plant::testing;
using machine::IntegratorKind;

namespace {

constexpr IntegratorKind kAll[] = {IntegratorKind::smooth, IntegratorKind::reference, IntegratorKind::oracle};

// largest distance of base and link from the exact states, um (thousandths of a degree), over ticks and axes
double largest_error_um(machine::MachineModel model, IntegratorKind kind,
                        const std::vector<StepBatch>& batches,
                        const std::vector<std::vector<ExactState>>& exact) {
  model.plant.integrator = kind;
  Plant plant(model);
  std::vector<std::int64_t> node(model.axis.size());
  double largest = 0;
  for (std::size_t k = 0; k < batches.size(); ++k) {
    const auto moved = plant.advance(batches[k]);
    if (!moved) {
      FAIL(std::string(moved.error().flag + ": " + moved.error().detail));
    }
    for (std::size_t a = 0; a < model.axis.size(); ++a) {
      const machine::AxisModel& axis = model.axis[a];
      node[a] += batches[k].axis[a].net_steps().value;
      const double milli_per_m =
          axis.kind == machine::AxisKind::rotary ? 180e3 / 3.14159265358979323846 : 1e6;
      const AxisState& state = plant.state()[a];
      const double lag_u = state.base_u - (axis.home_u + static_cast<double>(node[a]) * axis.step_u);
      const double tau_s = model.clock.tau_s();
      const double of_base = lag_u * 1e3 - static_cast<double>(exact[a][k].lag_m) * milli_per_m;
      const double of_link = state.link_u * 1e3 - static_cast<double>(exact[a][k].link_m) * milli_per_m;
      // a speed's error counts by its displacement in a tick
      const double of_speed =
          (state.base_u_s * 1e3 - static_cast<double>(exact[a][k].base_m_s) * milli_per_m) * tau_s;
      largest = std::max({largest, std::fabs(of_base), std::fabs(of_link), std::fabs(of_speed)});
    }
  }
  return largest;
}

std::vector<std::vector<ExactState>> exact_of(const machine::MachineModel& model,
                                              const std::vector<StepBatch>& batches) {
  std::vector<std::vector<ExactState>> exact;
  for (std::size_t a = 0; a < model.axis.size(); ++a) {
    exact.push_back(exact_states(model.axis[a], model.clock, static_cast<int>(a), batches));
  }
  return exact;
}

std::vector<AxisRecipe> three_axes() {
  return {{.base_kg = 4, .motor_hz = 80, .link_hz = 35, .link_ratio = 0.02},
          {.base_kg = 6, .motor_hz = 60, .link_hz = 40, .link_ratio = 0.01},
          {.base_kg = 2, .motor_hz = 100, .link_hz = 50, .link_ratio = 0.005}};
}

}  // namespace

TEST_CASE(
    "all integrators stay within 1e-6 um of the exact states at 1, 10, 50 and 100 kHz through both "
    "resonances") {
  // the pulse rate climbs from 0 through the link's 35..50 Hz and the motor's 60..100 Hz in the first ticks
  const auto model = make_machine(three_axes());
  for (double rate_hz : {1e3, 10e3, 50e3, 100e3}) {
    CAPTURE(rate_hz);
    const auto batches = pulse_batches(model,
                                       {ramp_train(rate_hz, 0.35, 0.1), ramp_train(0.93 * rate_hz, 0.35, 0.1),
                                        ramp_train(0.71 * rate_hz, 0.3, 0.1)},
                                       450);
    const auto exact = exact_of(model, batches);
    CHECK(largest_error_um(model, IntegratorKind::oracle, batches, exact) < 1e-9);
    CHECK(largest_error_um(model, IntegratorKind::smooth, batches, exact) < 1e-6);
    CHECK(largest_error_um(model, IntegratorKind::reference, batches, exact) < 1e-6);
  }
}

TEST_CASE("slow and fast sweeps across each resonance stay within 1e-6 um of the exact states") {
  // pulses at 35 Hz are one per 29 ticks; at 80 Hz one per 12
  const auto model = make_machine({three_axes()[0]});
  for (double rate_hz : {70.0, 160.0}) {
    CAPTURE(rate_hz);
    const auto batches = pulse_batches(model, {ramp_train(rate_hz, 2, 0.9)}, 2200);
    const auto exact = exact_of(model, batches);
    for (IntegratorKind kind : kAll) CHECK(largest_error_um(model, kind, batches, exact) < 1e-6);
  }
}

TEST_CASE("a swing with reversals inside ticks stays within 1e-6 um of the exact states") {
  const auto model = make_machine(three_axes());
  const auto batches = pulse_batches(model, {swing(400, 35), swing(3, 220), swing(1200, 61)}, 300);
  bool reversed = false;
  for (const StepBatch& batch : batches) reversed = reversed || !batch.axis[0].reversals.empty();
  REQUIRE(reversed);
  const auto exact = exact_of(model, batches);
  for (IntegratorKind kind : kAll) CHECK(largest_error_um(model, kind, batches, exact) < 1e-6);
}

TEST_CASE(
    "a motion after long rests is as exact as the first one: the state rings down in closed form between") {
  const auto model = make_machine({three_axes()[2]});
  const Motion once = ramp_train(20e3, 0.05, 0.02);
  const double steps = once.steps(1);
  // three moves, at 0, 0.4 and 0.8 s; the link rings for 1/(zeta w) = 0.64 s
  const Motion thrice{
      [=](double t) {
        return t < 0.4   ? once.steps(t)
               : t < 0.8 ? steps + once.steps(t - 0.4)
                         : 2 * steps + once.steps(t - 0.8);
      },
      [=](double t) {
        return t < 0.4 ? once.steps_s(t) : t < 0.8 ? once.steps_s(t - 0.4) : once.steps_s(t - 0.8);
      }};
  const auto batches = pulse_batches(model, {thrice}, 1200);
  const auto exact = exact_of(model, batches);
  for (IntegratorKind kind : kAll) CHECK(largest_error_um(model, kind, batches, exact) < 1e-6);
}

TEST_CASE(
    "a rotary axis that turns 100 times keeps its precision: lag within 1e-6 millidegrees of the oracle") {
  AxisRecipe spindle;
  spindle.kind = machine::AxisKind::rotary;
  spindle.base_kg = 0.02;
  spindle.link_kg = 0.005;
  spindle.step_u = 0.05625;  // 6400 steps per turn
  auto model = make_machine({spindle}, 1);
  const auto batches = pulse_batches(model, {ramp_train(64e3, 10.4, 0.4)}, 10500);
  std::vector<StepBatch> ten_turns(batches.begin(), batches.begin() + 1000);
  const auto exact = exact_of(model, ten_turns);
  CHECK(largest_error_um(model, IntegratorKind::smooth, ten_turns, exact) < 1e-6);
  Plant smooth(model);
  model.plant.integrator = IntegratorKind::oracle;
  Plant oracle(model);
  double largest_mdeg = 0;
  for (const StepBatch& batch : batches) {
    REQUIRE(smooth.advance(batch));
    REQUIRE(oracle.advance(batch));
    largest_mdeg =
        std::max(largest_mdeg, std::fabs(smooth.state()[0].base_u - oracle.state()[0].base_u) * 1e3);
  }
  CHECK(oracle.state()[0].base_u > 35999);
  CHECK(largest_mdeg < 1e-6);
}

TEST_CASE("a slide of 2 m, past every change of origin, stays within 1e-6 um of the oracle") {
  auto model = make_machine({three_axes()[0]});
  model.axis[0].home_u = -123.4375;
  const auto batches = pulse_batches(model, {ramp_train(320e3, 4.2, 0.2)}, 4400);
  Plant smooth(model);
  model.plant.integrator = IntegratorKind::oracle;
  Plant oracle(model);
  double largest_um = 0;
  for (const StepBatch& batch : batches) {
    REQUIRE(smooth.advance(batch));
    REQUIRE(oracle.advance(batch));
    largest_um = std::max(largest_um, std::fabs(smooth.state()[0].base_u - oracle.state()[0].base_u) * 1e3);
    largest_um = std::max(largest_um, std::fabs(smooth.state()[0].link_u - oracle.state()[0].link_u) * 1e3);
  }
  CHECK(oracle.state()[0].base_u > 1800);
  CHECK(largest_um < 1e-6);
}

TEST_CASE("the command is a hint: without it, or with a false one, spring and stepper axes move the same") {
  for (machine::MotorModel motor : {machine::MotorModel::spring, machine::MotorModel::stepper}) {
    auto axes = three_axes();
    for (AxisRecipe& axis : axes) axis.motor = motor;
    const auto model = make_machine(axes);
    const auto batches =
        pulse_batches(model, {ramp_train(20e3, 0.2, 0.08), swing(300, 20), ramp_train(500, 0.2, 0.05)}, 300);
    for (int kind = 0; kind < 3; ++kind) {
      Plant told(model), untold(model);
      double largest_um = 0;
      for (const StepBatch& batch : batches) {
        StepBatch other = batch;
        for (AxisPulses& pulses : other.axis) {
          AxisCommand& c = pulses.command;
          if (kind == 0) c = {};
          if (kind == 1) c.position_end_u += 0.9 * model.axis[0].step_u * (batch.tick.value % 2 ? 1 : -1);
          if (kind == 2) c.position_end_u = std::nan("");
        }
        REQUIRE(told.advance(batch));
        REQUIRE(untold.advance(other));
        for (std::size_t a = 0; a < 3; ++a) {
          largest_um =
              std::max(largest_um, std::fabs(told.state()[a].base_u - untold.state()[a].base_u) * 1e3);
          largest_um =
              std::max(largest_um, std::fabs(told.state()[a].link_u - untold.state()[a].link_u) * 1e3);
        }
      }
      CAPTURE(kind);
      // the spring's CVODE part differs by its own tolerance, the stepper does not look at the command at all
      CHECK(largest_um <= (motor == machine::MotorModel::spring ? 5e-7 : 0.0));
    }
  }
}

TEST_CASE("an axis at rest stays exactly at rest, however long") {
  for (machine::MotorModel motor : {machine::MotorModel::spring, machine::MotorModel::stepper}) {
    AxisRecipe recipe;
    recipe.motor = motor;
    auto model = make_machine({recipe});
    model.axis[0].home_u = 7.3;
    Plant plant(model);
    StepBatch batch;
    batch.axis.resize(1);
    batch.axis[0].command = {7.3, 7.3, 0, 0};
    for (std::int64_t k = 0; k < 20000; ++k) {
      batch.tick = {k};
      REQUIRE(plant.advance(batch));
    }
    const AxisState& s = plant.state()[0];
    CHECK(s.base_u == 7.3);
    CHECK(s.base_u_s == 0);
    CHECK(s.link_u == 0);
    CHECK(s.motor_force_N == 0);
  }
}

TEST_CASE("a reset forgets everything: the same pulses give the same bits again") {
  auto model = make_machine(three_axes());
  const auto batches =
      pulse_batches(model, {ramp_train(30e3, 0.1, 0.04), swing(300, 20), ramp_train(500, 0.1, 0.05)}, 130);
  for (IntegratorKind kind : kAll) {
    model.plant.integrator = kind;
    Plant plant(model);
    std::vector<AxisState> first;
    for (int run = 0; run < 2; ++run) {
      plant.reset({0, 0, 0});
      for (const StepBatch& batch : batches) REQUIRE(plant.advance(batch));
      if (run == 0) first = plant.state();
    }
    for (std::size_t a = 0; a < 3; ++a) {
      CHECK(plant.state()[a].base_u == first[a].base_u);
      CHECK(plant.state()[a].link_u == first[a].link_u);
      CHECK(plant.state()[a].link_u_s == first[a].link_u_s);
    }
  }
}
