#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "machine/base/numbers.h"
#include "machine/machine.h"
#include "machine/machine_file.h"

using namespace kadr;
using namespace kadr::machine;

namespace {

MachineModel shipped(std::string_view name) {
  SourceSet sources;
  auto file =
      read_machine(SourceText(std::string(name) + ".toml", std::string(shipped_machine(name))), sources);
  if (!file)
    for (const Diagnostic& d : file.error().list()) MESSAGE(render_human(d, sources));
  REQUIRE(file);
  return file->model;
}

}  // namespace

TEST_CASE("four machines ship with kadr, and each reads without a diagnostic under its own name") {
  const auto names = shipped_machine_names();
  REQUIRE(names.size() == 4);
  for (const auto name : names) CHECK(shipped(name).name == name);
  CHECK(shipped_machine("mill4").empty());
}

TEST_CASE("mill3 has three linear axes with 400 steps/mm and link resonances of 30 to 80 Hz") {
  const MachineModel m = shipped("mill3");
  REQUIRE(m.axis.size() == 3);
  CHECK(m.clock.base_hz == 10'000'000);
  CHECK(m.clock.tau_s() == 0.001);
  CHECK(m.path.max_accel_mm_s2 == 2000);
  CHECK(m.path.max_jerk_mm_s3 == 40000);
  CHECK(m.find_axis('Z') == 2);
  CHECK(m.find_axis('A') == -1);
  for (const AxisModel& axis : m.axis) {
    CHECK(axis.kind == AxisKind::linear);
    CHECK(axis.step_u == 0.0025);
    REQUIRE(axis.has_plant);
    CHECK(axis.plant.motor == MotorModel::spring);
    const double link_hz = std::sqrt(axis.plant.link_stiffness_N_per_m / axis.plant.link_mass_kg) / (2 * kPi);
    CHECK(link_hz > 30);
    CHECK(link_hz < 80);
    // the linear motor is the stepper for small lags: Km = 2 pi F_hold / pitch, within 1 %
    const double stiffness_N_m = 2 * kPi * axis.plant.holding_force_N / (axis.plant.tooth_pitch_u / 1000);
    CHECK(axis.plant.motor_stiffness_N_per_m == doctest::Approx(stiffness_N_m).epsilon(0.01));
  }
}

TEST_CASE("winder4 takes 13,750 deg/min of the mandrel without end and 21,100 mm/min of the carriage") {
  const MachineModel m = shipped("winder4");
  REQUIRE(m.axis.size() == 4);
  const AxisModel& carriage = m.axis[0];
  const AxisModel& mandrel = m.axis[2];
  CHECK(carriage.letter == 'X');
  CHECK(carriage.max_feed_u_s * 60 > 21'100);
  CHECK(mandrel.letter == 'A');
  CHECK(mandrel.kind == AxisKind::rotary);
  CHECK(mandrel.max_feed_u_s * 60 > 13'750);
  CHECK(mandrel.soft_max_u == kInfinity);
  CHECK(mandrel.soft_min_u == -kInfinity);
  CHECK(mandrel.step_u == doctest::Approx(0.005));
}

TEST_CASE("rig1 has the numbers of paper 001") {
  const MachineModel m = shipped("rig1");
  REQUIRE(m.axis.size() == 1);
  const AxisModel& x = m.axis[0];
  CHECK(x.soft_max_u == 3500);
  CHECK(x.max_feed_u_s == 3000);
  CHECK(x.max_accel_u_s2 == 1000);
  CHECK(x.max_jerk_u_s3 == kInfinity);
  const TwoMassModel& p = x.plant;
  CHECK(p.base_mass_kg == 4.5);
  CHECK(p.link_mass_kg == 1);
  CHECK(std::sqrt(p.link_stiffness_N_per_m / p.link_mass_kg) ==
        doctest::Approx(100 * kPi / 3).epsilon(1e-15));
  CHECK(p.link_damping_Ns_per_m / (2 * std::sqrt(p.link_stiffness_N_per_m * p.link_mass_kg)) ==
        doctest::Approx(0.005).epsilon(1e-15));
  CHECK(p.motor_stiffness_N_per_m == doctest::Approx(5.5 * (100 * kPi) * (100 * kPi)).epsilon(1e-15));
  CHECK(p.motor_damping_Ns_per_m == doctest::Approx(0.2 * 100 * kPi * 5.5).epsilon(1e-15));
  CHECK(p.base_friction_Ns_per_m == 0);
}

TEST_CASE("robot7 has the limits of paper 000: six joints in rad/s and a rail in mm/s") {
  const MachineModel m = shipped("robot7");
  REQUIRE(m.axis.size() == 7);
  const double v_rad_s[] = {1.396, 1.309, 1.222, 1.230, 1.229, 1.914};
  const double a_rad_s2[] = {1.414, 1.239, 1.239, 0.611, 0.611, 0.943};
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(m.axis[i].kind == AxisKind::rotary);
    CHECK(m.axis[i].max_feed_u_s * kPi / 180 == doctest::Approx(v_rad_s[i]).epsilon(1e-14));
    CHECK(m.axis[i].max_accel_u_s2 * kPi / 180 == doctest::Approx(a_rad_s2[i]).epsilon(1e-14));
    CHECK_FALSE(m.axis[i].has_plant);
  }
  CHECK(m.axis[6].letter == 'X');
  CHECK(m.axis[6].max_feed_u_s == 1866.667);
  CHECK(m.axis[6].max_accel_u_s2 == 1240);
  CHECK(m.path.max_feed_mm_s == 750);
}
