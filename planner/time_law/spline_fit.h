#pragma once
#include <optional>

#include "planner/limits/limits.h"
#include "planner/limits/ramp.h"
#include "planner/time_law/table_path.h"

namespace kadr::planner {

/// A program of many short lines taken as points of a smooth path: a C2 cubic spline through the joints of a
/// stretch, by chord length.
struct SplineFit {
  TablePath path;            ///< rows: the joints; s is the length along the lines, 0 at the first
  double deviation_u = 0;    ///< largest distance of curve and lines, either way, mm and deg counted alike
  double deviation_s_u = 0;  ///< where
  std::size_t segment = 0;   ///< on which line
  double least_slope = 1;    ///< of |dX/ds|, which is 1 where s is the length of the curve
  double most_slope = 1;
};

/// Lays the spline and measures it. A point of the curve is compared with its own chord: 16 places of each,
/// then the highest of those that come near the largest to 1e-9 by sections. Every point of a chord is the
/// foot of one of the curve, so lines are no farther from the curve.
/// @pre   at least 3 segments, lines all of them
SplineFit fit_spline(const Path& path, const Run& run, SplineEnds ends);

/// The spline as a problem: nodes at the joints, or evenly. The cap of a node is what the program says there,
/// as speed along the curve:
///   v |X'| <= feed of the lines that meet, and of the machine's path,   v^2 |X''| <= its centripetal limit
/// corners are none any more. Technology points become zones.
/// @param held_by  of every node, what its cap is
void state_fit(const SplineFit& fit, const Path& path, const Run& run, const machine::MachineModel& machine,
               std::optional<std::size_t> nodes, LawProblem& out, std::vector<Signature>& held_by);

}  // namespace kadr::planner
