#include "planner/time_law/metrics.h"

#include <algorithm>
#include <cmath>

namespace kadr::planner {

LawSolution summed(const LawProblem& p, std::vector<double> speed_u_s) {
  LawSolution out;
  out.speed_u_s = std::move(speed_u_s);
  for (std::size_t i = 1; i < p.nodes(); ++i) {
    const double v0 = out.speed_u_s[i - 1], v1 = out.speed_u_s[i];
    const double dt = 2.0 * p.ds_u(i) / (v0 + v1);
    const double a = (v1 - v0) / dt;
    out.time_s += dt;
    out.cost_s += dt + p.penalty_weight(i) * a * a;
  }
  return out;
}

LawMetrics law_metrics(const LawProblem& p, const LawSolution& solution, double speed_scale_u_s) {
  const std::vector<double>& v = solution.speed_u_s;
  LawMetrics m;
  const double scale = solution.time_s / speed_scale_u_s;
  double squares = 0;
  for (std::size_t i = 1; i + 1 < p.nodes(); ++i) {
    const double h1 = 2.0 * p.ds_u(i) / (v[i - 1] + v[i]), h2 = 2.0 * p.ds_u(i + 1) / (v[i] + v[i + 1]);
    const double u1 = (v[i] - v[i - 1]) / h1, u2 = (v[i + 1] - v[i]) / h2;
    const double first = (h2 * u1 + h1 * u2) / (h1 + h2), second = 2.0 * (u2 - u1) / (h1 + h2);
    const double dt = 0.5 * (h1 + h2);
    const auto energy = [](double d1, double d2) {
      const double w = 1.0 + d1 * d1;
      return d2 * d2 / (w * w * w);
    };
    m.curve_energy += energy(first, second) * dt;
    m.relative_energy += energy(first * scale, second * scale * solution.time_s) * dt / solution.time_s;
    squares += second * second * dt;
    m.peak_jerk_u_s3 = std::max(m.peak_jerk_u_s3, std::fabs(second));
  }
  m.rms_jerk_u_s3 = std::sqrt(squares / solution.time_s);
  return m;
}

}  // namespace kadr::planner
