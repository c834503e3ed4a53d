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

// 1 to 4 axes: base 0.1..100 kg, link 0.1 % to 200 % of it, motor 8..300 Hz, link 5..500 Hz, damping ratios
// from none to heavy, steps of 0.1..20 um; control ticks of 0.25..4 ms
machine::MachineModel random_machine(Random& random, MotorModel motor) {
  std::vector<AxisRecipe> axes(static_cast<std::size_t>(1 + 4 * random.next()));
  for (AxisRecipe& axis : axes) {
    axis.motor = motor;
    axis.base_kg = random.log_between(0.1, 100);
    axis.link_kg = axis.base_kg * random.log_between(1e-3, 2);
    axis.motor_hz = random.log_between(8, 300);
    axis.link_hz = random.log_between(5, 500);
    axis.motor_ratio = random.log_between(0.003, 1.5);
    axis.link_ratio = random.next() < 0.2 ? 0 : random.log_between(1e-4, 1);
    axis.step_u = random.log_between(1e-4, 2e-2);
    axis.pitch_steps = 4 * std::floor(random.log_between(1, 64));
    if (random.next() < 0.3) axis.kind = machine::AxisKind::rotary;
  }
  const double taus_ms[] = {0.25, 0.5, 1, 2, 4};
  return make_machine(axes, taus_ms[static_cast<int>(5 * random.next())]);
}

std::vector<StepBatch> random_train(Random& random, const machine::MachineModel& model, std::int64_t ticks) {
  std::vector<Motion> motion;
  const double total_s = model.clock.tau_s() * static_cast<double>(ticks);
  for (std::size_t a = 0; a < model.axis.size(); ++a) {
    const double rate_hz = random.log_between(20, 100e3);
    if (random.next() < 0.3) {
      const double frequency_hz = random.log_between(1, 40);
      motion.push_back(swing(rate_hz / (3.15 * frequency_hz), frequency_hz));
    } else {
      motion.push_back(
          ramp_train(rate_hz, total_s * random.between(0.3, 0.9), total_s * random.between(0.05, 0.14)));
    }
  }
  return pulse_batches(model, motion, ticks);
}

}  // namespace

TEST_CASE("random spring machines: smooth within 1e-5 um of the oracle, the oracle within 1e-11 of 80 bits") {
  const int count = property_count(40);
  for (int i = 0; i < count; ++i) {
    Random random(property_seed() * 1000003 + static_cast<std::uint64_t>(i));
    auto model = random_machine(random, MotorModel::spring);
    const std::int64_t ticks = 400;
    const auto batches = random_train(random, model, ticks);
    Plant smooth(model);
    model.plant.integrator = IntegratorKind::oracle;
    Plant oracle(model);
    std::vector<std::vector<ExactState>> exact;
    for (std::size_t a = 0; a < model.axis.size(); ++a) {
      exact.push_back(exact_states(model.axis[a], model.clock, static_cast<int>(a), batches));
    }
    double smooth_um = 0, oracle_um = 0, lag_um = 0;
    std::vector<std::int64_t> node(model.axis.size());
    for (std::size_t k = 0; k < batches.size(); ++k) {
      REQUIRE(smooth.advance(batches[k]));
      REQUIRE(oracle.advance(batches[k]));
      for (std::size_t a = 0; a < model.axis.size(); ++a) {
        node[a] += batches[k].axis[a].net_steps().value;
        const AxisState &s = smooth.state()[a], &o = oracle.state()[a];
        const bool rotary = model.axis[a].kind == machine::AxisKind::rotary;
        const double milli = rotary ? 180e3 / 3.14159265358979323846 : 1e6;
        const double exact_um = static_cast<double>(exact[a][k].lag_m) * milli;
        const double lag = (o.base_u - static_cast<double>(node[a]) * model.axis[a].step_u) * 1e3;
        smooth_um =
            std::max({smooth_um, std::fabs(s.base_u - o.base_u) * 1e3, std::fabs(s.link_u - o.link_u) * 1e3});
        oracle_um = std::max({oracle_um, std::fabs(lag - exact_um),
                              std::fabs(o.link_u * 1e3 - static_cast<double>(exact[a][k].link_m) * milli)});
        lag_um = std::max({lag_um, std::fabs(exact_um), std::fabs(o.link_u * 1e3)});
      }
    }
    CAPTURE(i);
    CAPTURE(lag_um);
    CHECK(oracle_um < 1e-9 + 1e-11 * lag_um);
    CHECK(smooth_um < 1e-5);
  }
}
