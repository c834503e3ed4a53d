#pragma once
#include <cstdint>
#include <vector>

#include <tl/expected.hpp>

#include "planner/feed_plan.h"
#include "planner/path.h"
#include "planner/planner.h"

/// What geometry and machine allow on each place of a path, before any ramp is thought of.
namespace kadr::planner {

/// Why a cap is what it is: the signature of one place.
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
  std::vector<double> jerk_u_s3;     ///< [segments], of s; > 0, may be inf
};

/// Computes all caps.
///
/// Segment, with e = dx/ds, kappa = d2x/ds2, per machine axis j:
///   v <= programmed feed, v <= max_feed_j / max|e_j|;  path limits are scaled by length / (length that F
///   measures) arcs: v^2 |kappa| <= path centripetal limit;  v^2 |kappa| <= 0.8 A_j and v^3 |x'''| <= 0.4 J_j
///   leave room for accelerating on the arc: (|e_j| a)^2 + (v^2 |kappa|)^2 <= A_j^2, |e_j| jerk + v^3 |x'''|
///   <= 0.8 J_j, 3 v a |kappa| <= 0.6 J_j, so that normal and tangential parts together obey the axis (0.8^2
///   + 0.6^2 = 1). A centripetal limit between 0.8 and 0.98 A_j is met exactly: the share 0.8 grows up to it.
/// Joint (paper 003, section 1.2):
///   v <= min_j min(a_inst_j tau, j_inst_j tau^2) / |delta e_j|,   v^2 |delta kappa_j| <= a_inst_j
/// With axis_limits = report the axis limits are left out wherever the path gives an acceleration limit;
/// corners keep the junction rule and rapids their axis speed.
tl::expected<PathLimitTable, PlanError> limit_table(const Path& path, const machine::MachineModel& machine);

}  // namespace kadr::planner
