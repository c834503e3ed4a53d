#pragma once
#include <memory>

#include "emulator/interpolator/lattice/curve.h"

/// Makers of the steppers of each method; make_stepper() (lattice.h) has checked curve and range before.
namespace kadr::interpolator::lattice {

using MadeStepper = std::unique_ptr<Stepper>;

// lines, n axes; with two axes the formulas of the plane
MadeStepper classic_line(const LineCurve& line);
MadeStepper half_step_line(const LineCurve& line, bool tie_to_y);
MadeStepper diagonal_line(const LineCurve& line);
MadeStepper extra_point_line(const LineCurve& line);
MadeStepper dda_line(const LineCurve& line, bool preloaded);
/// Each axis at its own rate until it has arrived: only both ends are met.
MadeStepper point_to_point(const LineCurve& line);
/// Slope cut to a number of fraction bits, added in every slot of the longer axis: an arithmetic progression.
MadeStepper progression_line(const LineCurve& line, int fraction_bits);

// arcs
enum class ArcRule : std::uint8_t { classic, half_step, extra_points, octant_midpoint };
MadeStepper rule_arc(const ArcCurve& arc, ArcRule rule);
/// Two cross-coupled integrators; sequential: the second one adds the coordinate that the first has just changed.
MadeStepper dda_arc(const ArcCurve& arc, bool sequential);
/// Chords of sagitta `tolerance` at most, ends rounded to nodes, each by V_i.
MadeStepper chord_arc(const ArcCurve& arc, double tolerance);

// F(x, y) = 0
enum class CurveRule : std::uint8_t { classic, half_step, extra_points };
/// @param reach  no coordinate beyond it is followed: there a polynomial would leave 128 bits
MadeStepper rule_curve(const ImplicitCurve& curve, CurveRule rule, std::int64_t reach);
/// Direction in which F(x, y) = 0 continues from a node: along the tangent (-F_y, F_x) times side.
/// Where a derivative is 0 the node lies on an extreme, and the one half a step ahead decides.
struct Ahead {
  int sx, sy;
  bool x_lowers;  ///< a step of X lowers F
};
Ahead ahead_of(const Polynomial& fx, const Polynomial& fy, int side, PlaneNode node);
/// y^2 = 2px by the odd numbers: exact, and the half-step path.
MadeStepper progression_parabola(const ParabolaCurve& parabola);
/// x(y) by Newton's forward differences in fixed point.
MadeStepper newton_parabola(const ParabolaCurve& parabola, int fraction_bits);

/// v = -P(u)/c of a curve F = c v + P(u) (explicit_axis) by Newton's forward differences in fixed point.
MadeStepper newton_explicit(const ImplicitCurve& curve, int fraction_bits);

/// Half-crossing events (bezier_events.h), one pulse per slot.
MadeStepper bezier_events(const BezierCurve& curve);

// formulas of paper 002 as they are printed, to be seen failing
/// The sign of F(i, j+1) - F(i+1, j), which is a + b whatever the node: Y never steps.
MadeStepper printed_difference_line(const LineCurve& line);
/// Meant: the sign of |F(i, j+1)| - |F(i+1, j)|, the nearer of the two neighbours.
MadeStepper magnitude_line(const LineCurve& line);
/// Eq. 7, F(x + h/2, y + h/2) - F(x - h/2, y - h/2) instead of F', within the quadrant of the beginning.
MadeStepper printed_half_step_arc(const ArcCurve& arc);

/// Quadrants of a travel, half open in its direction: a node on an axis belongs to the one it enters.
int quadrant_of(PlaneNode node, Turn turn);
struct Signs {
  int x, y;
};
Signs signs_of(int quadrant, Turn turn);

}  // namespace kadr::interpolator::lattice
