#pragma once
#include "planner/point_to_point/law.h"

namespace kadr::planner {

/// The moved masses (paper 001, eq. 21): a load of mass m on a vertical axis, its own inertia p m and a
/// counterweight k m.
struct Load {
  double mass_kg = 1;
  double drive_ratio = 4;            ///< p: inertia of the drive, reduced to the load's mass
  double counterweight_ratio = 0.5;  ///< k
  double gravity_m_s2 = 9.81;        ///< g; 0 on a level axis

  /// q = p + 1 + k
  double inertia_ratio() const { return drive_ratio + 1 + counterweight_ratio; }
  /// c = (1 - k) g, the weight that is left, per mass of the load
  double weight_m_s2() const { return (1 - counterweight_ratio) * gravity_m_s2; }
  double base_mass_kg() const { return (drive_ratio + counterweight_ratio) * mass_kg; }
};

/// K_g of eq. 21 is g tf^2/xf. The paper puts 9.81 there, which is the gravity of a weaker planet:
///   g_eff = 9.81 xf/tf^2
double printed_gravity_m_s2(double distance_m, double duration_s);

/// Work of a law, P = m v (q a + c); its coordinate is in metres.
struct Work {
  double peak_W = 0;         ///< largest power
  double least_W = 0;        ///< smallest one; below 0 the drive brakes
  double absolute_J = 0;     ///< int |P| dt, eq. 22 as Table 2 means it: braking costs as much as driving
  double positive_J = 0;     ///< int max(P, 0) dt: braking is free
  double recuperated_J = 0;  ///< int max(-P, 0) dt: energy that braking could return
  double copper_m2_s3 = 0;   ///< int a^2 dt: heat in the windings, up to constants of the motor
};

/// Exact: every piece is split where q a + c changes its sign, and between
///   int v (q a + c) dt = q (v2^2 - v1^2)/2 + c (s2 - s1).
Work work_of(const PointLaw& law, const Load& load);

/// The same of a T law in closed form, A = Amax, V = Vmax, ta its ramp:
///   E_abs = m [ c xf + V ta max(0, q A - c) ],   E_pos = m [ c xf + V ta max(0, q A - c)/2 ]
/// @return E_abs; of |c|, since a motion up costs what its reverse does down
double t_law_energy_J(double distance_m, double duration_s, double xi, const Load& load);

}  // namespace kadr::planner
