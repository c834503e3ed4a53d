#pragma once
#include "machine/base/vocabulary.h"

namespace kadr::planner {

/// A lightly damped vibration of the load on its base (paper 001, eq. 5-6 divided by the load's mass):
///   x1'' + 2 zeta omega x1' + omega^2 x1 = -a
struct Mode {
  double omega_rad_s = 0;  ///< > 0
  double zeta = 0;         ///< 0 <= zeta < 1

  double damped_rad_s() const;     ///< omega sqrt(1 - zeta^2)
  double period_s() const;         ///< 2 pi/omega
  double damped_period_s() const;  ///< 2 pi/(omega sqrt(1 - zeta^2))
};

/// Drive of the base, which decides which frequency rings.
enum class Drive : unsigned char {
  position,  ///< a stiff servo or rigid mechanics: the base follows the law whatever the load does
  force,     ///< a motor's force F = (m0 + m1) a alone: base and load vibrate against each other
};
inline constexpr Vocabulary<Drive, 2> kDrives{{
    {Drive::position, "position", "the base follows the law whatever the load does"},
    {Drive::force, "force", "base and load swing against each other"},
}};
static_assert(kDrives.complete());

/// The load as a law's acceleration sees it.
struct DrivenMode {
  Mode mode;        ///< the ringing frequency, to which a law has to be tuned
  double gain = 1;  ///< the load vibrates as if the base had `gain` times the law's acceleration

  /// position:  omega, zeta, gain 1
  /// force:     omega r, zeta r, gain r^2,  r = sqrt(1 + m1/m0): a law tuned to omega misses it
  static DrivenMode of(const Mode& load, Drive drive, double base_mass_kg, double load_mass_kg);
};

}  // namespace kadr::planner
