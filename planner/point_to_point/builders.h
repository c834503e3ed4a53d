#pragma once
#include <array>
#include <cstddef>

#include "planner/point_to_point/law.h"
#include "planner/point_to_point/mode.h"

namespace kadr::planner {

/// Law of constant acceleration, cruise and constant deceleration with ramps of their own:
///   V = distance/(cruise + (up + down)/2),   a = V/up, 0, -V/down
/// @pre distance, up, down > 0, cruise >= 0
PointLaw ramp_law(double distance_u, double ramp_up_s, double cruise_s, double ramp_down_s);

/// The symmetric rectangular law (T) of paper 001, eq. 1-3, of ramps xi duration:
///   Amax = distance/(duration^2 xi (1 - xi)),   Vmax = distance/(duration (1 - xi))
/// @pre distance, duration > 0, 0 < xi <= 1/2
PointLaw t_law(double distance_u, double duration_s, double xi);

/// T law whose acceleration has a zero of the second order at the frequency of `period` (paper 001, eq. 14
/// with "and"): ramps of `ramp` periods, deceleration begins `shift` periods after the start.
/// @pre 1 <= ramp <= shift
PointLaw double_zero_law(double distance_u, double period_s, int ramp, int shift);

/// The shortest law within both limits: bang-bang, with a cruise if the speed limit requires one.
///   T = 2 sqrt(d/a)  if d <= v^2/a,   else d/v + v/a
PointLaw bang_bang_law(double distance_u, double speed_limit_u_s, double accel_limit_u_s2);

/// The law averaged over a window of `window` seconds: jumps of acceleration become ramps of that length, so
/// a T law becomes an S-curve. Lasts `window` longer, no peak grows; without damping every mode of whole
/// periods in the window is silent.
/// @pre law has no jerk, window > 0
PointLaw averaged(const PointLaw& law, double window_s);

/// Impulses that sum up to 1, the first at 0 s.
struct Impulse {
  double time_s = 0, share = 0;
};
/// Two impulses half a damped period apart, the second one K of the first: no residual vibration at the mode
/// (ZV).   K = exp(-zeta pi/sqrt(1 - zeta^2))
std::array<Impulse, 2> zv_impulses(const Mode& mode);
/// Three impulses in the ratio 1 : 2K : K^2: the residual vibration and its slope over frequency are zero (ZVD).
std::array<Impulse, 3> zvd_impulses(const Mode& mode);
/// Sum of copies of a law, shifted and scaled by the impulses: their convolution. Lasts as much longer as the
/// last impulse is late; no peak grows.
PointLaw zv_shaped(const PointLaw& law, const Mode& mode);
PointLaw zvd_shaped(const PointLaw& law, const Mode& mode);

}  // namespace kadr::planner
