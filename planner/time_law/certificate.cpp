#include "planner/time_law/certificate.h"

#include <algorithm>
#include <cmath>

namespace kadr::planner {

double lower_bound_s(const LawProblem& p, const Certificate& c) {
  const std::size_t n = p.nodes();
  const std::vector<NodeCap> caps = node_caps(p);
  const bool both = p.accel_test == AccelTest::both_nodes;
  const std::size_t rows = 1 + p.axes * (both ? 2 : 1);
  std::vector<double> r(n, 0.0);  // gradient by the squared speeds
  double bound = 0;
  for (std::size_t i = 1; i < n; ++i) {
    const double v0 = c.speed_u_s[i - 1], v1 = c.speed_u_s[i], x0 = v0 * v0, x1 = v1 * v1;
    const double ds = p.s_u[i] - p.s_u[i - 1], a = (x1 - x0) / (2.0 * ds), w = p.penalty_weight(i);
    bound += 2.0 * ds / (v0 + v1) + w * a * a;
    const double slope = ds / ((v0 + v1) * (v0 + v1));  // -d(dt)/dv
    if (v0 > 0.0) r[i - 1] -= slope / v0;
    if (v1 > 0.0) r[i] -= slope / v1;
    r[i - 1] -= w * a / ds;
    r[i] += w * a / ds;
    // a limited quantity q = q0 x0 + q1 x1, |q| <= most
    std::size_t row = i * rows;
    const auto limited = [&](double q0, double q1, double most) {
      const double up = std::max(c.upper[row], 0.0), down = std::max(c.lower[row], 0.0);
      ++row;
      bound += (up - down) * (q0 * x0 + q1 * x1) / most - (up + down);
      r[i - 1] += (up - down) * q0 / most;
      r[i] += (up - down) * q1 / most;
    };
    const double h = 1.0 / (2.0 * ds);
    limited(-h, h, p.accel_limit_u_s2(i));
    for (std::size_t k = 0; k < p.axes; ++k) {
      const double x_1 = p.slopes(i)[k], x_2 = p.curvatures(i)[k];
      limited(-x_1 * h, x_1 * h + x_2, p.max_accel_u_s2[k]);
    }
    for (std::size_t k = 0; both && k < p.axes; ++k) {
      const double x_1 = p.slopes_behind(i - 1)[k], x_2 = p.curvatures_behind(i - 1)[k];
      limited(x_2 - x_1 * h, x_1 * h, p.max_accel_u_s2[k]);
    }
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double x = c.speed_u_s[i] * c.speed_u_s[i];
    bound += std::min(-r[i] * x, r[i] * (caps[i].speed_u_s * caps[i].speed_u_s - x));
  }
  return bound;
}

}  // namespace kadr::planner
