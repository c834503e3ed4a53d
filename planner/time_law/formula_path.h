#pragma once
#include <vector>

#include "planner/time_law/problem.h"
#include "planner/time_law/verify_law.h"

namespace kadr::planner {

/// An axis given by a formula of z = s/length:
///   X = offset + slope z + sum B sin(2 pi n z + f) + sum W tanh((s - s0)/w)
struct FormulaAxis {
  struct Wave {
    double amplitude, turns, phase_rad;
  };
  struct Step {
    double height, at_u, width_u;
  };
  double offset = 0;
  double slope = 0;
  std::vector<Wave> waves;
  std::vector<Step> steps;
};

struct AxisPoint {
  double value, slope, curvature;
};
/// X, X', X'' at s, from exact elementary functions: the same bits on every machine.
AxisPoint eval(const FormulaAxis& axis, double s_u, double length_u);

/// Places a formula's axes at nodes that divide the length evenly.
/// @param out  axes, s_u, slope and curvature are set, the rest stays
void sample(const std::vector<FormulaAxis>& axes, double length_u, std::size_t nodes, LawProblem& out);
/// The same between nodes, for verify_law(). `axes` outlives it.
PathDerivatives derivatives(const std::vector<FormulaAxis>& axes, double length_u);

}  // namespace kadr::planner
