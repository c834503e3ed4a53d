#pragma once
#include <cstdint>
#include <vector>

#include <tl/expected.hpp>

#include "planner/laws/feed_plan.h"
#include "planner/limits/plan_error.h"
#include "planner/path/path.h"

namespace kadr::machine {
struct MachineModel;
}

/// Limits that geometry and machine set at each place of a path, before any ramp.
namespace kadr::planner {

class Joints;
class Path;

/// The reason of a cap: the signature of one place.
struct Signature {
  LimitedBy reason = LimitedBy::program;
  std::int8_t axis = -1;
  bool operator==(const Signature&) const = default;
};

/// Caps along a path. "Places" number joints and segments alike, in path order: place 2 i is joint i, place 2
/// i + 1 is segment i. A joint's cap is never above those of its two segments.
struct PathLimitTable {
  std::vector<double> cap_u_s;       ///< [2 segments + 1], >= 0; 0 at a stop
  std::vector<Signature> signature;  ///< [2 segments + 1]
  std::vector<double> accel_u_s2;    ///< [segments], of s; > 0, finite
  std::vector<double> jerk_u_s3;     ///< [segments], of s; > 0, inf only with jerk_limited ramps
  machine::RampLaw law = machine::RampLaw::jerk_limited;
};

/// Computes all caps.
///
/// Segment, per joint j of the machine, whose limits are those of axis j (Joints), with e = dx/ds:
///   v <= programmed feed,   v <= max_feed_j / max|e_j|
///   a <= A_j / |e_j|,       jerk <= J_j / |e_j|
/// Limits of [path] count along the length that F measures: they are scaled by length_u / feed_length_u. The
/// centripetal limit counts by the curvature of the path itself: v^2 kappa <= centripetal limit.
///
/// Where a joint turns, each of its limits is shared between turning and accelerating along the path, by
/// bounds over the whole segment (JointBounds: T = tangent, K = curvature, W = third). On circles, with
/// A = A_j / skew and J = J_j / skew:
///   v^2 K <= 0.8 A,    (T a)^2 + (v^2 K)^2 <= A^2
///   v^3 W <= 0.4 J,    T jerk + v^3 W <= 0.8 J,    3 v a K <= 0.6 J
/// so that both parts together obey the joint at every angle (0.8^2 + 0.6^2 = 1). A finite centripetal limit
/// takes its own share instead of 0.8 A; it is met exactly up to 0.98 A. On curves likewise, but
///   v^3 W <= 0.4 J_j,  J' = (J_j - v^3 W)/skew:    T jerk <= 0.8 J',    3 v a K <= 0.6 J'
///
/// Place where two segments meet (paper 003, section 1.2), a curvature step counting as a jump of
/// acceleration, with kappa_j = d2x_j/ds2:
///   v <= min_j min(a_inst_j tau, j_inst_j tau^2) / |delta e_j|,    v^2 |delta kappa_j| <= a_inst_j
/// and 0 at both ends of a rapid that planner.rapid_law takes care of.
///
/// With axis_limits = report the axis limits are left out wherever the path gives an acceleration limit;
/// corners keep the junction rule and rapids their axis speed.
///
/// @param feed_scale  factor on the programmed feeds: the highest override that an operator will request
tl::expected<PathLimitTable, PlanError> limit_table(const Joints& joints,
                                                    const machine::MachineModel& machine,
                                                    double feed_scale = 1.0);
/// Of the machine's own joints (machine_joints).
tl::expected<PathLimitTable, PlanError> limit_table(const Path& path, const machine::MachineModel& machine,
                                                    double feed_scale = 1.0);

}  // namespace kadr::planner
