#pragma once
#include <optional>

#include "emulator/interpolator/lattice/lattice.h"
#include "planner/bezier/bezier.h"

namespace kadr::studies {

struct Place {
  double x, y;  ///< steps
};

/// Distance of a node from a curve, in steps. For a plane curve with two sides it has the sign of F; for
/// others none. At a crossing of a Bezier it is the distance from the point of that moment.
/// @param t  parameter at which the node was reached, of a Bezier alone
double deviation_steps(const interpolator::lattice::Curve& curve, const interpolator::lattice::Point& node,
                       double t);

/// The same in the larger of |dx|, |dy|, lines and arcs in the plane alone; -1 for others.
double square_deviation_steps(const interpolator::lattice::Curve& curve,
                              const interpolator::lattice::Point& node);

/// Length of the ideal curve in steps; of F(x, y) = 0 that of the chords between the crossings of the
/// half-step path's sides.
double curve_length_steps(const interpolator::lattice::Curve& curve,
                          const interpolator::lattice::Trace& trace);

/// Where on the curve each slot of a half-step or crossing run lies, as a share of its length, [slots].
std::vector<double> crossing_shares(const interpolator::lattice::Curve& curve,
                                    const interpolator::lattice::Trace& trace);

/// F(x, y) as the step tables show it; nothing for a curve in more axes or a Bezier that is no conic.
std::optional<interpolator::lattice::Polynomial> sign_polynomial(const interpolator::lattice::Curve& curve);

/// Foot of the perpendicular from a point to F = 0: Newton's method, alternating across the curve and along it.
/// @param fx, fy  derivatives of f
Place foot_of(const interpolator::lattice::Polynomial& f, const interpolator::lattice::Polynomial& fx,
              const interpolator::lattice::Polynomial& fy, Place from);

planner::Bezier real_bezier(const interpolator::lattice::BezierCurve& curve);
double arc_sweep_rad(const interpolator::lattice::ArcCurve& arc);

}  // namespace kadr::studies
