#include "planner/time_law/formula_path.h"

#include "machine/base/numbers.h"

namespace kadr::planner {
namespace {

constexpr double kSaturated = 20.0;  ///< from here on tanh is 1 to the last bit

double exact_tanh(double x) {
  if (x > kSaturated) return 1.0;
  if (x < -kSaturated) return -1.0;
  const double e = exact_exp(2.0 * x);
  return (e - 1.0) / (e + 1.0);
}

}  // namespace

AxisPoint eval(const FormulaAxis& axis, double s, double length) {
  AxisPoint p{axis.offset + axis.slope * s / length, axis.slope / length, 0.0};
  for (const FormulaAxis::Wave& wave : axis.waves) {
    const double k = 2.0 * kPi * wave.turns / length;
    const SinCos at = exact_sincos(k * s + wave.phase_rad);
    p.value += wave.amplitude * at.sin;
    p.slope += wave.amplitude * k * at.cos;
    p.curvature -= wave.amplitude * k * k * at.sin;
  }
  for (const FormulaAxis::Step& step : axis.steps) {
    const double h = exact_tanh((s - step.at_u) / step.width_u), falls = 1.0 - h * h;
    p.value += step.height * h;
    p.slope += step.height / step.width_u * falls;
    p.curvature -= 2.0 * step.height / (step.width_u * step.width_u) * h * falls;
  }
  return p;
}

void sample(const std::vector<FormulaAxis>& axes, double length, std::size_t nodes, LawProblem& out) {
  out.axes = axes.size();
  out.s_u.resize(nodes);
  out.slope.resize(nodes * axes.size());
  out.curvature.resize(nodes * axes.size());
  for (std::size_t i = 0; i < nodes; ++i) {
    out.s_u[i] = length * static_cast<double>(i) / static_cast<double>(nodes - 1);
    for (std::size_t c = 0; c < axes.size(); ++c) {
      const AxisPoint p = eval(axes[c], out.s_u[i], length);
      out.slope[i * axes.size() + c] = p.slope;
      out.curvature[i * axes.size() + c] = p.curvature;
    }
  }
}

PathDerivatives derivatives(const std::vector<FormulaAxis>& axes, double length) {
  return [&axes, length](double s, double* slope, double* curvature) {
    for (std::size_t c = 0; c < axes.size(); ++c) {
      const AxisPoint p = eval(axes[c], s, length);
      slope[c] = p.slope;
      curvature[c] = p.curvature;
    }
  };
}

}  // namespace kadr::planner
