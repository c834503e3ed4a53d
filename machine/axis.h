#pragma once
#include "machine/choices.h"
#include "machine/infinity.h"

/// One axis: limits, lattice, and the masses on it.
/// Units: `_u` is the axis's own unit, mm for a linear and degrees for a rotary axis.
namespace kadr::machine {

/// Two masses on one axis (paper 001, eq. 5-6). SI: kg, N/m, N s/m; for a rotary axis kg m^2, N m/rad, N m s/rad.
struct TwoMassModel {
  MotorModel motor = MotorModel::rigid;
  double base_mass_kg = 0;             ///< m0: motor and carriage, > 0
  double link_mass_kg = 0;             ///< m1: flexible part, > 0
  double link_stiffness_N_per_m = 0;   ///< k, > 0
  double link_damping_Ns_per_m = 0;    ///< c, >= 0
  double base_friction_Ns_per_m = 0;   ///< b0, viscous, >= 0
  double motor_stiffness_N_per_m = 0;  ///< Km of `spring`, > 0
  double motor_damping_Ns_per_m = 0;   ///< bm, >= 0
  double holding_force_N = 0;          ///< F_hold of `stepper`, > 0
  double tooth_pitch_u = 0;  ///< `stepper`: motion per electrical period (four full steps), mm or deg, > 0
  bool operator==(const TwoMassModel&) const = default;
};

struct AxisModel {
  char letter = 'X';
  AxisKind kind = AxisKind::linear;
  double step_u = 0;  ///< one motor step, > 0
  double soft_min_u = -kInfinity;
  double soft_max_u = kInfinity;
  double home_u = 0;        ///< machine position at program start
  double max_feed_u_s = 0;  ///< also the rapid rate
  double max_accel_u_s2 = 0;
  double max_jerk_u_s3 = kInfinity;       ///< inf: trapezoidal profile
  double junction_accel_u_s2 = 0;         ///< allowed acceleration step at a corner (over one tau)
  double junction_jerk_u_s3 = kInfinity;  ///< allowed jerk at a corner (over one tau)
  bool has_plant = false;                 ///< false: not modelled, moves as `rigid` without a link
  TwoMassModel plant;
  bool operator==(const AxisModel&) const = default;
};

}  // namespace kadr::machine
