#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>

#include "machine/machine.h"
#include "planner/positioning/link_modes.h"
#include "planner_support.h"
#include "plant/axis_equations.h"

using namespace kadr;
using namespace kadr::planner;

namespace {

machine::AxisModel random_axis(machine::MotorModel motor, test::Random& draw) {
  machine::AxisModel axis = test::plain_machine().axis[0];
  machine::TwoMassModel& p = axis.plant;
  axis.has_plant = true;
  p.motor = motor;
  p.base_mass_kg = draw.between(1, 30);
  p.link_mass_kg = draw.between(0.5, 10);
  p.link_stiffness_N_per_m = p.link_mass_kg * draw.between(1e3, 4e5);
  p.link_damping_Ns_per_m = 2 * draw.between(0, 0.05) * std::sqrt(p.link_stiffness_N_per_m * p.link_mass_kg);
  p.motor_stiffness_N_per_m = p.base_mass_kg * draw.between(3e4, 4e6);
  p.motor_damping_Ns_per_m = 2 * draw.between(0, 0.4) * std::sqrt(p.motor_stiffness_N_per_m * p.base_mass_kg);
  p.base_friction_Ns_per_m = draw.between(0, 20);
  p.holding_force_N = draw.between(50, 500);
  p.tooth_pitch_u = draw.between(1, 4);
  return axis;
}

/// Eigenvalues of the plant's equations at rest, per second, that oscillate with little damping.
std::vector<std::complex<double>> plant_modes(const plant::AxisEquations& equations) {
  const std::size_t states = equations.motor.follows_command() ? 2 : 4, first = 4 - states;
  const plant::Matrix4 system = equations.system();
  Eigen::MatrixXd a(states, states);
  for (std::size_t i = 0; i < states; ++i)
    for (std::size_t j = 0; j < states; ++j)
      a(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = system.at[first + i][first + j];
  // the link alone: its base does not give way
  if (states == 2) {
    a(1, 0) = -equations.p1;
    a(1, 1) = -equations.q1;
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(a);
  std::vector<std::complex<double>> modes;
  for (const std::complex<double>& s : solver.eigenvalues())
    if (s.imag() > 0 && -s.real() / std::abs(s) < kDampedEnough) modes.push_back(s / equations.tau_s);
  std::sort(modes.begin(), modes.end(),
            [](const auto& x, const auto& y) { return std::abs(x) < std::abs(y); });
  return modes;
}

}  // namespace

TEST_CASE("the vibrations that rapids avoid are those of the plant's equations, with every motor") {
  test::Random draw(11);
  for (const auto& motor : machine::kMotorModels) {
    for (int i = 0; i < 100; ++i) {
      const machine::AxisModel axis = random_axis(motor.value, draw);
      const auto wanted = plant_modes(plant::axis_equations(axis, machine::ClockModel{}));
      const std::vector<DrivenMode> found = link_modes(axis);
      INFO(motor.word << ", case " << i);
      REQUIRE(found.size() == wanted.size());
      for (std::size_t j = 0; j < found.size(); ++j) {
        const double omega = std::abs(wanted[j]);
        CHECK(found[j].mode.omega_rad_s == doctest::Approx(omega).epsilon(1e-9));
        CHECK(found[j].mode.zeta == doctest::Approx(-wanted[j].real() / omega).epsilon(1e-7));
      }
    }
  }
}
