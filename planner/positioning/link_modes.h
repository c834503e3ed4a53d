#pragma once
#include <vector>

#include "planner/point_to_point/mode.h"

namespace kadr::machine {
struct AxisModel;
}

namespace kadr::planner {

/// Damping ratio from which a vibration is left to itself: in five periods it falls to a fifth.
inline constexpr double kDampedEnough = 0.05;

/// The vibrations that motion along an axis excites in the driven system; none without a
/// plant.
///
/// A motor that follows its command moves the base whatever the load does, so the link swings at its own
/// omega = sqrt(k/m1). On any other motor, linearised where it stands (Km: Motor::stiffness()), base and link
/// swing against each other at the roots of (paper 001, eq. 5 with F = Km (x_step - x0) - B x0')
///   (m0 s^2 + B s + Km)(m1 s^2 + c s + k) + m1 s^2 (c s + k) = 0,   B = bm + b0
/// which are the eigenvalues of the plant's equations at rest; a law tuned to omega would miss them. The
/// link's share of the command's acceleration is the residue of
///   X1/A = -Km m1 / that polynomial.
/// Roots damped by kDampedEnough or more are left out. Ascending frequency; the one or two it can be.
std::vector<DrivenMode> link_modes(const machine::AxisModel& axis);

}  // namespace kadr::planner
