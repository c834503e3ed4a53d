#pragma once
#include "machine/axis.h"
#include "machine/base/count.h"
#include "machine/clock.h"
#include "machine/motor.h"
#include "plant/matrix.h"
#include "plant/plant.h"

namespace kadr::plant {

/// State of one axis inside the plant: m (rad for a rotary axis), and m per control tick.
/// Lag is the base relative to the motor's equilibrium, so it stays small however far the axis has gone.
enum : std::size_t { kLag, kBaseSpeed, kLink, kLinkSpeed };

/// Two masses in dimensionless time (unit: one control tick tau), divided by their masses:
///
///   lag'  = v0                     v0' = f(lag) - B v0 + p x1 + q v1
///   x1'   = v1                     v1' = -v0' - p1 x1 - q1 v1
///   f = force(lag) tau^2 / m0 by the motor's law; -a lag for a linear one
struct AxisEquations {
  machine::Motor motor;  // in N
  machine::Motor pull;   // f: the same in m per tick^2
  double a = 0;          // the motor's stiffness at rest, times tau^2 / m0
  double B = 0;          // (bm + b0) tau / m0
  double p = 0;          // k tau^2 / m0
  double q = 0;          // c tau / m0
  double p1 = 0;         // k tau^2 / m1
  double q1 = 0;         // c tau / m1

  double step_m = 0;          // one step
  double pitch_m = 0;         // one tooth; 0 if the motor has none
  Steps pitch_steps;          // of one tooth
  double metre_per_unit = 0;  // 1e-3 m per mm, pi/180 rad per degree
  double tau_s = 0;
  double control_ticks = 0;  // base ticks per control tick
  machine::TwoMassModel model;

  /// A of dz/dt = A z: exact for a linear motor, at rest for any.
  Matrix4 system() const;
  /// dz/dt for any motor.
  Vector4 derivative(const Vector4& z) const;
  /// Motor force [N, N m] at a state.
  double motor_force_N(const Vector4& z) const;
  /// Fastest rate of the equations [1/tick], an upper estimate: sqrt of the stiffnesses plus the dampings.
  double rate() const;
  /// False if a mass, stiffness or clock makes the equations meaningless.
  bool usable() const;
  double kinetic_J(const Vector4& z) const;
  double spring_J(const Vector4& z) const;
};

/// From the machine's units to those of the equations (the border inwards).
AxisEquations axis_equations(const machine::AxisModel& axis, const machine::ClockModel& clock);

/// From the equations to axis units (the border outwards). The equilibrium is the lattice node plus slipped teeth.
AxisState axis_state(const AxisEquations& equations, const Vector4& z, double equilibrium_u);

}  // namespace kadr::plant
