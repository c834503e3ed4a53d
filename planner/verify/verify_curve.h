#pragma once
#include <array>

#include "planner/bezier/path_curve.h"

/// The part of verify() that knows about curves.
namespace kadr::planner {

/// x', x'', x''' with respect to s, one value per axis.
struct VerifiedDerivatives {
  std::array<double, kProgramAxes> d1{}, d2{}, d3{};
};

/// From the curve's powers by the chain rule; another way than PathCurve::by_length. With f(t) = x(t) and
/// w = dt/ds = 1/|f'|:  x' = w f',  w' = -w^4 (f'.f''),  x'' = w^2 f'' + w w' f'  and so on.
VerifiedDerivatives verified_curve(const PathCurve& curve, double local_s);

/// Whether the curve somewhere runs more than 90 degrees away from the direction in which it begins. The
/// planner bounds a curve by its curvature at 17 places, and misses the tip of one that turns back between
/// two of them: see VerifyOptions::curves_that_turn_back.
bool turns_back(const PathCurve& curve);

}  // namespace kadr::planner
