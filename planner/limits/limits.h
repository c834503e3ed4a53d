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
/// Segment, with e = dx/ds, kappa = d2x/ds2, per machine axis j:
///   v <= programmed feed,   v <= max_feed_j / max|e_j|
///   a <= A_j / |e_j|,       jerk <= J_j / |e_j|
/// Limits of [path] count along the length that F measures: they are scaled by length_u / feed_length_u.
///
/// Arcs share each axis limit between turning and accelerating along the path:
///   v^2 |kappa| <= centripetal limit of the path
///   v^2 |kappa| <= 0.8 A_j,         (|e| a)^2 + (v^2 |kappa|)^2 <= A_j^2
///   v^3 |x'''|  <= 0.4 J_j,         |e| jerk + v^3 |x'''| <= 0.8 J_j,     3 v a |kappa| <= 0.6 J_j
/// so that both parts together obey the axis at every angle (0.8^2 + 0.6^2 = 1). A finite centripetal limit
/// takes its own share instead of 0.8 A_j; it is met exactly up to 0.98 A_j.
///
/// Curves (PathCurve) likewise, by bounds over the whole segment (CurveBounds: kappa, plane_j, |x'''_j|):
///   v^2 kappa <= 0.8 A_j/plane_j,   a^2 + (v^2 kappa)^2 <= (A_j/plane_j)^2,   v^3 |x'''_j| <= 0.4 J_j
///   J' = (J_j - v^3 |x'''_j|)/plane_j:   jerk <= 0.8 J',   3 v a kappa <= 0.6 J'
///
/// Joint (paper 003, section 1.2), a curvature step counting as a jump of acceleration:
///   v <= min_j min(a_inst_j tau, j_inst_j tau^2) / |delta e_j|,    v^2 |delta kappa_j| <= a_inst_j
/// and 0 at both ends of a rapid that planner.rapid_law takes care of.
///
/// With axis_limits = report the axis limits are left out wherever the path gives an acceleration limit;
/// corners keep the junction rule and rapids their axis speed.
///
/// @param feed_scale  factor on the programmed feeds: the highest override that an operator will request
tl::expected<PathLimitTable, PlanError> limit_table(const Path& path, const machine::MachineModel& machine,
                                                    double feed_scale = 1.0);

}  // namespace kadr::planner
