#include <doctest/doctest.h>

#include <cmath>

#include "machine/machine.h"
#include "plant/matrix.h"
#include "plant/plant.h"

using namespace kadr;
using namespace kadr::plant;

// Linearised stepper of paper 001's rig: w = 100 pi/3 rad/s, zeta = 0.005, m0 = 4.5 kg, m1 = 1 kg,
// Km = 5.5 (100 pi)^2 N/m, bm = 0.2 * 100 pi * 5.5 N s/m; 10 um per step. Expected states (x0, v0, x1, v1) in
// m and m/s are exp of the 5x5 matrix [[A, b], [0, 0]], b = (0, 1/m0, 0, -1/m0), applied to (z, Km x_step),
// in 40 digits.

namespace {

constexpr double kSpringPi_ = 3.14159265358979323846;
constexpr double kSpringW = 100 * kSpringPi_ / 3;

machine::MachineModel rig() {
  machine::AxisModel axis;
  axis.step_u = 0.01;
  axis.has_plant = true;
  axis.plant = {.motor = machine::MotorModel::spring,
                .base_mass_kg = 4.5,
                .link_mass_kg = 1,
                .link_stiffness_N_per_m = kSpringW * kSpringW,
                .link_damping_Ns_per_m = 2 * 0.005 * kSpringW,
                .motor_stiffness_N_per_m = 5.5 * (100 * kSpringPi_) * (100 * kSpringPi_),
                .motor_damping_Ns_per_m = 0.2 * 100 * kSpringPi_ * 5.5};
  machine::MachineModel model;
  model.axis = {axis};
  return model;
}

// `steps` steps, the k-th at (k - 1) ms, then rest; ends after `ticks` ms
AxisState after(machine::IntegratorKind kind, std::int64_t steps, std::int64_t ticks) {
  auto model = rig();
  model.plant.integrator = kind;
  Plant plant(model);
  StepBatch batch;
  batch.axis.resize(1);
  for (std::int64_t k = 0; k < ticks; ++k) {
    batch.tick = {k};
    batch.axis[0].clear();
    if (k < steps) batch.axis[0].offset_ticks.push_back(0);
    REQUIRE(plant.advance(batch));
  }
  return plant.state()[0];
}

struct Expected {
  std::int64_t steps, ticks;
  double x0, v0, x1, v1;
};
const Expected kExpected[] = {
    {1, 1, 5.819761112359791e-7, 1.137332727872036e-3, -5.812307138540998e-7, -1.134576082568952e-3},
    {1, 10, 1.635174708150802e-5, -7.846209705487027e-4, -1.314009081196608e-5, 1.750087550713501e-3},
    {1, 100, 1.035844859414867e-5, -4.176020856591937e-5, 6.288461062885418e-6, -7.76213670009737e-4},
    {1, 1000, 1.012924275735606e-5, 2.886204652437588e-6, 5.909182413039641e-6, 9.308400165166111e-5},
    {200, 10, 1.024261514071354e-4, 1.579714248981785e-2, -9.320903677650189e-5, -1.209086608536132e-2},
    {200, 100, 1.000434277055577e-3, 1.023477046759593e-2, 7.706944240704418e-5, 5.997490901292347e-3},
    {200, 200, 1.996639309538581e-3, 9.942489060784943e-3, -8.840344209976319e-5, 2.767791299497026e-3},
    {200, 210, 1.995581498652343e-3, -5.697180499971744e-3, 6.995579831338127e-5, 2.136007100038973e-2},
    {200, 300, 1.998984060438078e-3, -5.17362595393853e-4, -4.653450776044415e-5, -1.432494838476755e-2}};

}  // namespace

TEST_CASE(
    "the spring motor's answer to 10 um steps matches nine states in closed form: oracle to 1e-9 of each") {
  for (const Expected& e : kExpected) {
    CAPTURE(e.steps);
    CAPTURE(e.ticks);
    const AxisState s = after(machine::IntegratorKind::oracle, e.steps, e.ticks);
    CHECK(s.base_u * 1e-3 == doctest::Approx(e.x0).epsilon(1e-9).scale(0));
    CHECK(s.base_u_s * 1e-3 == doctest::Approx(e.v0).epsilon(1e-9).scale(0));
    CHECK(s.link_u * 1e-3 == doctest::Approx(e.x1).epsilon(1e-9).scale(0));
    CHECK(s.link_u_s * 1e-3 == doctest::Approx(e.v1).epsilon(1e-9).scale(0));
    const double lag_m = static_cast<double>(std::min(e.steps, e.ticks)) * 1e-5 - e.x0;
    const double force_N =
        5.5 * (100 * kSpringPi_) * (100 * kSpringPi_) * lag_m - 0.2 * 100 * kSpringPi_ * 5.5 * e.v0;
    CHECK(s.motor_force_N == doctest::Approx(force_N).epsilon(1e-8));
  }
}

TEST_CASE("the same states by CVODE: smooth and reference within 1e-6 um and 1e-6 um per ms") {
  for (machine::IntegratorKind kind : {machine::IntegratorKind::smooth, machine::IntegratorKind::reference}) {
    for (const Expected& e : kExpected) {
      CAPTURE(e.steps);
      CAPTURE(e.ticks);
      const AxisState s = after(kind, e.steps, e.ticks);
      CHECK(std::fabs(s.base_u * 1e-3 - e.x0) < 1e-12);
      CHECK(std::fabs(s.base_u_s * 1e-3 - e.v0) < 1e-9);
      CHECK(std::fabs(s.link_u * 1e-3 - e.x1) < 1e-12);
      CHECK(std::fabs(s.link_u_s * 1e-3 - e.v1) < 1e-9);
    }
  }
}

TEST_CASE(
    "a force-driven pair of masses matches the closed form: centre of mass and ringing at w sqrt(1 + "
    "m1/m0)") {
  // F = (m0 + m1) A for 0.36 tf, 0 for 0.28 tf, -F for 0.36 tf; A = 3.5/(16 * 0.36 * 0.64), tf = 4 s; w = 100
  // pi/3. x0 = R - m1 x1/M with R'' = F/M; x1 as a base-driven link of frequency w sqrt(1 + 1/4.5), forced by -F/m0.
  const double m0 = 4.5, m1 = 1, k = kSpringW * kSpringW, force_N = 5.5 * 3.5 / (16 * 0.36 * 0.64);
  for (double zeta : {0.0, 0.005}) {
    const double c = 2 * zeta * kSpringW;
    const Matrix<5> system{{{{0, 1, 0, 0, 0},
                             {0, 0, k / m0, c / m0, 1 / m0},
                             {0, 0, 0, 1, 0},
                             {0, 0, -k * (1 / m0 + 1 / m1), -c * (1 / m0 + 1 / m1), -1 / m0},
                             {0, 0, 0, 0, 0}}}};
    Vector<5> z{};
    const auto push = [&](double seconds, double newton) {
      z[4] = newton;
      z = exponential(system * seconds) * z;
    };
    push(1.44, force_N);
    push(1.12, 0);
    push(1.44, -force_N);
    const double expected[2][4] = {
        {3.499981060000982, -2.963384990525871e-3, 1.041699945980123e-4, 1.629861744789229e-2},
        {3.499979993474921, -2.962916527376655e-4, 1.100358879335827e-4, 1.629604090057160e-3}};
    const double* e = expected[zeta > 0];
    CHECK(std::fabs(z[0] - e[0]) < 1e-10);
    CHECK(std::fabs(z[1] - e[1]) < 1e-9);
    CHECK(std::fabs(z[2] - e[2]) < 1e-12);
    CHECK(std::fabs(z[3] - e[3]) < 1e-10);
  }
}

TEST_CASE("the exponential of a matrix: a rotation by 50 rad, and a nilpotent chain") {
  const Matrix<2> turn = exponential(Matrix<2>{{{{0, 50}, {-50, 0}}}});
  // cos 50 = 0.96496602849211333, sin 50 = -0.26237485370392877
  CHECK(turn.at[0][0] == doctest::Approx(0.96496602849211333).epsilon(1e-13));
  CHECK(turn.at[0][1] == doctest::Approx(-0.26237485370392877).epsilon(1e-13));
  const Matrix<3> chain = exponential(Matrix<3>{{{{0, 2, 0}, {0, 0, 2}, {0, 0, 0}}}});
  CHECK(chain.at[0][2] == doctest::Approx(2.0).epsilon(1e-15));
}
