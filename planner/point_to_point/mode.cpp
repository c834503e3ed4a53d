#include "planner/point_to_point/mode.h"

#include <cmath>

#include "machine/base/numbers.h"

namespace kadr::planner {

double Mode::damped_rad_s() const { return omega_rad_s * std::sqrt((1.0 - zeta) * (1.0 + zeta)); }
double Mode::period_s() const { return 2.0 * kPi / omega_rad_s; }
double Mode::damped_period_s() const { return 2.0 * kPi / damped_rad_s(); }

DrivenMode DrivenMode::of(const Mode& load, Drive drive, double base_mass_kg, double load_mass_kg) {
  if (drive == Drive::position) return {load, 1.0};
  const double r2 = 1.0 + load_mass_kg / base_mass_kg, r = std::sqrt(r2);
  return {{load.omega_rad_s * r, load.zeta * r}, r2};
}

}  // namespace kadr::planner
