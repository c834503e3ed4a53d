#pragma once
#include <optional>

#include "planner/bezier/bezier_curve.h"

namespace kadr::planner {

/// The joint where one Bezier ends and the next begins.
struct JointReport {
  double gap_u = 0;              ///< between the two ends
  double tangent_angle_rad = 0;  ///< 0: the joint is G1
  double speed_ratio = 1;        ///< |B2'(0)|/|B1'(1)|; 1 and no angle: C1
  double normal_angle_rad = 0;   ///< between the two curvature vectors
  double curvature_before_per_u = 0;
  double curvature_after_per_u = 0;
  /// length of the difference of the two vectors: v^2 times it is the jump of acceleration
  double curvature_jump_per_u = 0;
  double second_jump = 0;  ///< |B2''(0) - B1''(1)|; 0 with C1: C2
};
JointReport joint_report(const Bezier& before, const Bezier& after);

/// Another second and third point of a cubic that follows a curve.
struct JointRepair {
  BezierVector second{}, third{};
};
/// G2 with the second point kept: B'' gets the curvature vector before the joint; the third point may be
/// moved along the tangent. Nothing if `after` is no cubic or the joint not G1.
std::optional<JointRepair> repair_g2(const Bezier& before, const Bezier& after);
/// C2: B'(0) and B''(0) those of the curve before. Nothing if `after` is no cubic.
std::optional<JointRepair> repair_c2(const Bezier& before, const Bezier& after);

/// Highest speed on a curvature k under an acceleration a of which a_t is used along the path:
///   v = sqrt(sqrt(a^2 - a_t^2)/k)
/// @pre 0 <= tangential < acceleration
/// @return infinite where k = 0
double curvature_speed_u_s(double curvature_per_u, double acceleration_u_s2, double tangential_u_s2 = 0);

}  // namespace kadr::planner
