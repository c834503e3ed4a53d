#pragma once
#include "machine/base/numbers.h"
#include "machine/choices.h"
#include "machine/infinity.h"
#include "machine/two_masses.h"

/// One axis: limits, lattice, and the masses on it.
/// Units: `_u` is the axis's own unit, mm for a linear and degrees for a rotary axis.
namespace kadr::machine {

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
  /// Metres (radians) per unit: the plant computes in SI.
  double si_per_u() const { return kind == AxisKind::rotary ? kPi / 180 : 1e-3; }
  bool operator==(const AxisModel&) const = default;
};

}  // namespace kadr::machine
