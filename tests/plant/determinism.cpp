#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "machine/base/hash.h"
#include "plant/deterministic_pow.h"
#include "plant/plant.h"
#include "tests/plant/trains.h"

using namespace kadr;
using namespace kadr::plant;
using namespace kadr::plant::testing;
using machine::IntegratorKind;
using machine::MotorModel;

namespace {

// A train of whole numbers alone, so that libm has no part in it: every axis accelerates, runs, reverses and rests.
std::vector<StepBatch> whole_number_train(const machine::MachineModel& model, std::int64_t ticks) {
  std::vector<StepBatch> batches(static_cast<std::size_t>(ticks));
  for (std::size_t a = 0; a < model.axis.size(); ++a) {
    std::int64_t rate = 0, node = 0;  // steps per 1000 ticks
    const auto top = static_cast<std::int64_t>(40000 - 9000 * a);
    for (std::int64_t k = 0; k < ticks; ++k) {
      StepBatch& batch = batches[static_cast<std::size_t>(k)];
      batch.tick = {k};
      batch.axis.resize(model.axis.size());
      const std::int64_t phase = k % 600;
      if (phase < 100) rate += top / 100;
      if (phase >= 200 && phase < 400) rate -= top / 100;
      if (phase >= 450 && phase < 550) rate += top / 100;
      const std::int64_t count = std::llabs(rate) / 1000;
      AxisPulses& pulses = batch.axis[a];
      pulses.first_sign = rate < 0 ? -1 : 1;
      for (std::int64_t i = 0; i < count; ++i) {
        pulses.offset_ticks.push_back(static_cast<std::uint16_t>((2 * i + 1) * 10000 / (2 * count)));
      }
      const double step_u = model.axis[a].step_u;
      pulses.command.position_begin_u = static_cast<double>(node) * step_u;
      node += pulses.net_steps().value;
      pulses.command.position_end_u = static_cast<double>(node) * step_u;
      pulses.command.speed_begin_u_s = pulses.command.speed_end_u_s =
          static_cast<double>(pulses.net_steps().value) * step_u * 1000;
    }
  }
  return batches;
}

std::string states_hash(MotorModel motor, IntegratorKind kind) {
  std::vector<AxisRecipe> axes(3);
  for (AxisRecipe& axis : axes) axis.motor = motor;
  axes[1].link_hz = 52;
  axes[2].kind = machine::AxisKind::rotary;
  for (AxisRecipe& axis : axes) axis.pitch_steps = 1024;
  auto model = make_machine(axes);
  model.plant.integrator = kind;
  const auto batches = whole_number_train(model, kind == IntegratorKind::reference ? 150 : 1500);
  Plant plant(model);
  Hash64 hash;
  for (const StepBatch& batch : batches) {
    const auto moved = plant.advance(batch);
    if (!moved) FAIL(std::string(moved.error().flag + " " + moved.error().detail));
    for (const AxisState& s : plant.state()) {
      const double values[] = {s.base_u, s.base_u_s, s.link_u, s.link_u_s, s.motor_force_N};
      hash.bytes(values, sizeof values);
    }
  }
  return hash_text(hash.digest());
}

std::string all_hashes() {
  std::string text =
      "# made by tests/plant/determinism.cpp with KADR_REGENERATE=1: hashes of raw plant states\n";
  text += "spring smooth " + states_hash(MotorModel::spring, IntegratorKind::smooth) + "\n";
  text += "spring reference " + states_hash(MotorModel::spring, IntegratorKind::reference) + "\n";
  text += "spring oracle " + states_hash(MotorModel::spring, IntegratorKind::oracle) + "\n";
  text += "stepper smooth " + states_hash(MotorModel::stepper, IntegratorKind::smooth) + "\n";
  text += "stepper reference " + states_hash(MotorModel::stepper, IntegratorKind::reference) + "\n";
  text += "rigid smooth " + states_hash(MotorModel::rigid, IntegratorKind::smooth) + "\n";
  return text;
}

}  // namespace

TEST_CASE(
    "raw states are the same bits in every build: g++ and clang++, any optimisation, with and without FMA") {
  const std::string path = std::string(KADR_SOURCE_DIR) + "/tests/golden/plant_states.txt";
  const std::string now = all_hashes();
  if (std::getenv("KADR_REGENERATE")) {
    std::ofstream(path) << now;
    return;
  }
  std::ifstream file(path);
  REQUIRE(file);
  const std::string golden((std::istreambuf_iterator<char>(file)), {});
  CHECK(now == golden);
}

TEST_CASE("the same pulses give the same bits twice") {
  CHECK(states_hash(MotorModel::spring, IntegratorKind::smooth) ==
        states_hash(MotorModel::spring, IntegratorKind::smooth));
}

TEST_CASE("CVODE's step sizes come from the program's own pow, not from libm's") {
  const std::int64_t before = pow_calls();
  states_hash(MotorModel::spring, IntegratorKind::smooth);
  // 1500 ticks of some steps each; every change of step size takes up to three powers
  CHECK(pow_calls() - before > 1000);
}

extern "C" double pow(double base, double exponent) noexcept;

TEST_CASE("the program's own pow: roots, powers, signs and limits") {
  // volatile, so that the compiler does not work them out itself
  const auto power = [](double base, double exponent) {
    const volatile double b = base, e = exponent;
    return pow(b, e);
  };
  CHECK(power(2, 10) == doctest::Approx(1024).epsilon(4e-16));
  CHECK(power(2, 0.5) == doctest::Approx(1.4142135623730951).epsilon(4e-16));
  CHECK(power(1e-12, 0.125) == doctest::Approx(0.031622776601683794).epsilon(1e-15));
  CHECK(power(1e-300, 1.0 / 13) == doctest::Approx(8.4834289824407239e-24).epsilon(1e-15));
  CHECK(power(10, 300) == doctest::Approx(1e300).epsilon(1e-15));
  CHECK(power(-2, 3) == doctest::Approx(-8).epsilon(4e-16));
  CHECK(power(-2, 4) == doctest::Approx(16).epsilon(4e-16));
  CHECK(power(7, 0) == 1);
  CHECK(power(0, 2) == 0);
  const double undefined = power(-2, 0.5);
  CHECK(undefined != undefined);
  CHECK(power(10, 400) > 1e308);
  CHECK(power(10, -400) == 0);
  // x^(1/q) raised to q again, for the exponents CVODE uses
  for (int q = 2; q <= 13; ++q) {
    for (double x = 1e-9; x < 1e4; x *= 7.3) {
      const double root = power(x, 1.0 / q);
      double back = 1;
      for (int i = 0; i < q; ++i) back *= root;
      CHECK(back == doctest::Approx(x).epsilon(1e-14));
    }
  }
}
