#pragma once
#include "planner/point_to_point/law.h"
#include "planner/point_to_point/mode.h"

namespace kadr::planner {

/// The load relative to its base.
struct LinkState {
  double link_u = 0;    ///< x1
  double link_u_s = 0;  ///< x1'
};

/// Moves a mode exactly through `time_s` of base acceleration accel + jerk t. About the equilibrium
///   xe(t) = -(accel + jerk t)/w^2 + 2 zeta jerk/w^3
/// it is a free vibration: y(t) = e^{-zeta w t} [ y cos wd t + (y' + zeta w y)/wd sin wd t ].
LinkState advance_link(const LinkState& state, const Mode& mode, double accel_u_s2, double jerk_u_s3,
                       double time_s);
/// The load at a moment of a law that began with it at rest.
LinkState link_at(const PointLaw& law, const DrivenMode& driven, double time_s);

/// Amplitude of the free vibration from a state on, at that moment (paper 001, eq. 20, corrected):
///   X = sqrt(x1^2 + ((x1' + zeta w x1)/wd)^2)
double envelope_u(const LinkState& state, const Mode& mode);

/// The same at the end of a law, from its jumps alone: with S = zeta w + i wd
///   X = gain/wd |int a e^{S (t - T)} dt| = gain/wd |sum (da_i/S - dj_i/S^2) e^{S (t_i - T)}|
/// Exact for every law up to rounding: some 1e-13 of the largest jump over w^2.
double residual_amplitude_u(const PointLaw& law, const DrivenMode& driven);

/// The same of a T law in closed form (eq. 20), D = T - ta:
///   X = A/(wd w) |(1 - e^{-S ta})(1 - e^{-S D})|,   without damping 4 A/w^2 |sin(w ta/2) sin(w D/2)|
double t_law_amplitude_u(double distance_u, double duration_s, double xi, const Mode& mode);

/// Largest values of the free vibration after a law.
struct ResidualPeaks {
  double link_u = 0;    ///< largest |x1|
  double link_u_s = 0;  ///< largest |x1'|
};
ResidualPeaks residual_peaks(const LinkState& end, const Mode& mode);

/// Largest residual amplitude if the frequency is off by up to `band` of itself either way (0.1: 10 %).
/// Looks at `samples` frequencies to each side and refines at the largest by golden section.
/// @pre 0 <= band < 1, samples >= 2
double worst_amplitude_u(const PointLaw& law, const DrivenMode& driven, double band, int samples = 400);

}  // namespace kadr::planner
