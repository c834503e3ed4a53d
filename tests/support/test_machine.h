#pragma once
#include "machine/machine.h"

namespace kadr::test {

/// A machine made in code: n linear axes X Y Z ..., 2 um steps, 110 mm/s, 2000 mm/s2, 40000 mm/s3, corners at
/// 2 mm/s (2000 mm/s2 over 1 ms), two masses of 4.5 kg and 1 kg per axis on a linear motor
/// (link at 16.7 Hz, zeta 0.005).
inline machine::MachineModel test_machine(int axes = 3) {
  machine::MachineModel m;
  m.name = "test";
  m.units = machine::StartUnits::mm;  // programs of tests need not say G21
  for (int i = 0; i < axes; ++i) {
    machine::AxisModel a;
    a.letter = kAxisLetters[static_cast<std::size_t>(i)];
    a.step_u = 0.002;
    a.max_feed_u_s = 110;
    a.max_accel_u_s2 = 2000;
    a.max_jerk_u_s3 = 40000;
    a.junction_accel_u_s2 = 2000;
    a.has_plant = true;
    a.plant.motor = machine::MotorModel::spring;
    a.plant.base_mass_kg = 4.5;
    a.plant.link_mass_kg = 1.0;
    a.plant.link_stiffness_N_per_m = 10966.227112321508;  // (100 pi/3)^2
    a.plant.link_damping_Ns_per_m = 1.0471975511965976;   // 2 * 0.005 * (100 pi/3)
    a.plant.motor_stiffness_N_per_m = 542828.2420599128;  // 5.5 * (100 pi)^2
    a.plant.motor_damping_Ns_per_m = 345.5751918948772;   // 5.5 * 0.2 * 100 pi
    a.plant.holding_force_N = 500;
    a.plant.tooth_pitch_u = 0.4;
    m.axis.push_back(a);
  }
  m.path.max_accel_mm_s2 = 2000;
  m.path.max_jerk_mm_s3 = 40000;
  m.path.centripetal_accel_mm_s2 = 2000;
  return m;
}

}  // namespace kadr::test
