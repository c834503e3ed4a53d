#pragma once
#include <optional>

#include "planner/point_to_point/mode.h"

namespace kadr::planner {

/// A law of constant acceleration, cruise and deceleration that a damped vibration survives in silence.
struct DampedZero {
  double ramp_s = 0;   ///< of the acceleration
  double shift_s = 0;  ///< between the beginnings of acceleration and deceleration
};

/// The vibration of the acceleration has decayed to that of the deceleration, and they cancel. With
/// S = zeta omega + i omega_d:
///   F(ramp) = e^(S shift) F(down),   F(x) = (e^(S x) - 1)/x
/// The acceleration is up to half a period longer than the deceleration. Fixed scan and bisections.
/// @param down_s  duration of the deceleration; whole damped periods, which leaves least
/// @param from_s  the shift is at least that, and less than a period more
/// @return none if the vibration decays too fast
std::optional<DampedZero> damped_zero(const Mode& mode, double down_s, double from_s);

}  // namespace kadr::planner
