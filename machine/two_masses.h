#pragma once
#include <cstdint>

#include "machine/base/vocabulary.h"

namespace kadr::machine {

/// How a motor pulls; the laws are in machine/motor.h.
enum class MotorModel : std::uint8_t { rigid, spring, stepper };

inline constexpr Vocabulary<MotorModel, 3> kMotorModels{{
    {MotorModel::rigid, "rigid", "the carriage follows every step at once"},
    {MotorModel::spring, "spring", "the motor pulls by a linear spring"},
    {MotorModel::stepper, "stepper", "the motor pulls by the sine of its angle, and can lose steps"},
}};
static_assert(kMotorModels.complete());

/// Two masses on one axis (paper 001, eq. 5-6). SI: kg, N/m, N s/m; for a rotary axis kg m^2, N m/rad, N m
/// s/rad. Each motor uses some of the numbers from `motor_stiffness` on (its law's kNeeds).
struct TwoMassModel {
  MotorModel motor = MotorModel::rigid;
  double base_mass_kg = 0;             ///< m0: motor and carriage, > 0
  double link_mass_kg = 0;             ///< m1: flexible part, > 0
  double link_stiffness_N_per_m = 0;   ///< k, > 0
  double link_damping_Ns_per_m = 0;    ///< c, >= 0
  double base_friction_Ns_per_m = 0;   ///< b0, viscous, >= 0
  double motor_stiffness_N_per_m = 0;  ///< Km, > 0
  double motor_damping_Ns_per_m = 0;   ///< bm, >= 0
  double holding_force_N = 0;          ///< F_hold, > 0
  double tooth_pitch_u = 0;            ///< motion per electrical period (four full steps), mm or deg, > 0
  bool operator==(const TwoMassModel&) const = default;
};

}  // namespace kadr::machine
