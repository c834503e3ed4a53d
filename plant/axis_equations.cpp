#include "plant/axis_equations.h"

#include "machine/base/numbers.h"

namespace kadr::plant {

using machine::AxisKind;
using machine::MotorModel;

Matrix4 AxisEquations::system() const {
  return {{{{0, 1, 0, 0}, {-a, -B, p, q}, {0, 0, 0, 1}, {a, B, -p - p1, -q - q1}}}};
}

Vector4 AxisEquations::derivative(const Vector4& z) const {
  const double motor_accel =
      motor == MotorModel::stepper ? -G * exact_sincos(kappa * z[kLag]).sin : -a * z[kLag];
  const double base_accel = motor_accel - B * z[kBaseSpeed] + p * z[kLink] + q * z[kLinkSpeed];
  return {z[kBaseSpeed], base_accel, z[kLinkSpeed], -base_accel - p1 * z[kLink] - q1 * z[kLinkSpeed]};
}

double AxisEquations::motor_force_N(const Vector4& z) const {
  const double damping_N = model.motor_damping_Ns_per_m * z[kBaseSpeed] / tau_s;
  if (motor == MotorModel::stepper) {
    return -model.holding_force_N * exact_sincos(kappa * z[kLag]).sin - damping_N;
  }
  return -model.motor_stiffness_N_per_m * z[kLag] - damping_N;
}

double AxisEquations::rate() const {
  return std::sqrt(a) + std::sqrt(G * kappa) + std::sqrt(p + p1) + B + q + q1;
}

bool AxisEquations::usable() const {
  const double all = a + G + kappa + B + p + q + p1 + q1;
  return all > 0 && all < machine::kInfinity && model.base_mass_kg > 0 && model.link_mass_kg > 0 &&
         model.link_stiffness_N_per_m > 0 && step_m > 0 && (motor != MotorModel::spring || a > 0) &&
         (motor != MotorModel::stepper || (G > 0 && kappa > 0 && pitch_steps > 0));
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
  e.motor = model.motor;
  e.model = model;
  e.metre_per_unit = axis.kind == AxisKind::rotary ? kPi / 180 : 1e-3;
  e.tau_s = clock.tau_s();
  e.control_ticks = static_cast<double>(clock.control_tick.value);
  e.step_m = axis.step_u * e.metre_per_unit;
  const double tau2_s2 = e.tau_s * e.tau_s;
  e.p = model.link_stiffness_N_per_m * tau2_s2 / model.base_mass_kg;
  e.q = model.link_damping_Ns_per_m * e.tau_s / model.base_mass_kg;
  e.p1 = model.link_stiffness_N_per_m * tau2_s2 / model.link_mass_kg;
  e.q1 = model.link_damping_Ns_per_m * e.tau_s / model.link_mass_kg;
  e.B = model.base_friction_Ns_per_m * e.tau_s / model.base_mass_kg;
  if (model.motor != MotorModel::rigid) e.B += model.motor_damping_Ns_per_m * e.tau_s / model.base_mass_kg;
  if (model.motor == MotorModel::spring) e.a = model.motor_stiffness_N_per_m * tau2_s2 / model.base_mass_kg;
  if (model.motor == MotorModel::stepper) {
    e.G = model.holding_force_N * tau2_s2 / model.base_mass_kg;
    e.pitch_m = model.tooth_pitch_u * e.metre_per_unit;
    e.kappa = 2 * kPi / e.pitch_m;
    const double steps = model.tooth_pitch_u / axis.step_u;
    if (steps < 1e9) e.pitch_steps = static_cast<std::int64_t>(std::floor(steps + 0.5));
  }
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
