#pragma once
#include "emulator/interpolator/lattice/lattice.h"

namespace kadr::emulator {

/// How far a node lies from a curve, in steps. Of a plane curve with two sides it has the sign of F; of
/// others none. At a crossing of a Bezier it is the distance from the point of that moment.
/// @param t  parameter at which the node was reached, of a Bezier alone
double deviation_steps(const lattice::Curve& curve, const lattice::Point& node, double t);

/// The same in the larger of |dx|, |dy|, lines and arcs in the plane alone; -1 for others.
double square_deviation_steps(const lattice::Curve& curve, const lattice::Point& node);

/// Length of the ideal curve in steps; of F(x, y) = 0 that of the chords between the crossings of the
/// half-step path's sides.
double curve_length_steps(const lattice::Curve& curve, const lattice::Trace& trace);

/// Where on the curve each slot of a half-step or crossing run lies, as a share of its length, [slots].
std::vector<double> crossing_shares(const lattice::Curve& curve, const lattice::Trace& trace);

}  // namespace kadr::emulator
