#include "plant/axis_equations.h"

#include <cmath>

namespace kadr::plant {

Matrix4 AxisEquations::system() const {
  return {{{{0, 1, 0, 0}, {-a, -B, p, q}, {0, 0, 0, 1}, {a, B, -p - p1, -q - q1}}}};
}

Vector4 AxisEquations::derivative(const Vector4& z) const {
  const double base_accel = pull.force(z[kLag]) - B * z[kBaseSpeed] + p * z[kLink] + q * z[kLinkSpeed];
  return {z[kBaseSpeed], base_accel, z[kLinkSpeed], -base_accel - p1 * z[kLink] - q1 * z[kLinkSpeed]};
}

double AxisEquations::motor_force_N(const Vector4& z) const {
  return motor.force(z[kLag]) - motor.damping_Ns_per_m() * z[kBaseSpeed] / tau_s;
}

double AxisEquations::rate() const { return std::sqrt(a) + std::sqrt(p + p1) + B + q + q1; }

bool AxisEquations::usable() const {
  const double all = B + p + q + p1 + q1;
  const bool whole_teeth = motor.tooth_u() == 0 || pitch_steps > Steps{};
  return all > 0 && all < machine::kInfinity && model.base_mass_kg > 0 && model.link_mass_kg > 0 &&
         model.link_stiffness_N_per_m > 0 && step_m > 0 && pull.usable() && whole_teeth;
}

double AxisEquations::kinetic_J(const Vector4& z) const {
  const double base_m_s = z[kBaseSpeed] / tau_s;
  const double tool_m_s = (z[kBaseSpeed] + z[kLinkSpeed]) / tau_s;
  return 0.5 * model.base_mass_kg * base_m_s * base_m_s + 0.5 * model.link_mass_kg * tool_m_s * tool_m_s;
}

double AxisEquations::spring_J(const Vector4& z) const {
  return 0.5 * model.link_stiffness_N_per_m * z[kLink] * z[kLink];
}

AxisEquations axis_equations(const machine::AxisModel& axis, const machine::ClockModel& clock) {
  const machine::TwoMassModel& model = axis.plant;
  AxisEquations e;
  e.motor = machine::Motor(axis);
  e.model = model;
  e.metre_per_unit = axis.si_per_u();
  e.tau_s = clock.tau_s();
  e.control_ticks = static_cast<double>(clock.control_tick.value);
  e.step_m = axis.step_u * e.metre_per_unit;
  const double tau2_s2 = e.tau_s * e.tau_s;
  e.p = model.link_stiffness_N_per_m * tau2_s2 / model.base_mass_kg;
  e.q = model.link_damping_Ns_per_m * e.tau_s / model.base_mass_kg;
  e.p1 = model.link_stiffness_N_per_m * tau2_s2 / model.link_mass_kg;
  e.q1 = model.link_damping_Ns_per_m * e.tau_s / model.link_mass_kg;
  e.B = model.base_friction_Ns_per_m * e.tau_s / model.base_mass_kg;
  e.B += e.motor.damping_Ns_per_m() * e.tau_s / model.base_mass_kg;
  e.pull = e.motor.over(model.base_mass_kg, e.tau_s);
  e.a = e.pull.stiffness();
  e.pitch_m = e.motor.tooth_u() * e.metre_per_unit;
  const double steps = e.motor.tooth_u() / axis.step_u;
  if (steps < 1e9) e.pitch_steps = Steps{static_cast<std::int64_t>(std::floor(steps + 0.5))};
  return e;
}

AxisState axis_state(const AxisEquations& e, const Vector4& z, double equilibrium_u) {
  const double unit_per_m = 1 / e.metre_per_unit;
  const double unit_s_per_m = unit_per_m / e.tau_s;
  return {.base_u = equilibrium_u + z[kLag] * unit_per_m,
          .base_u_s = z[kBaseSpeed] * unit_s_per_m,
          .link_u = z[kLink] * unit_per_m,
          .link_u_s = z[kLinkSpeed] * unit_s_per_m,
          .motor_force_N = e.motor_force_N(z)};
}

}  // namespace kadr::plant
