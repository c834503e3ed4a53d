#include "literal_dp.h"

#include <cmath>

namespace kadr::planner {
namespace {

bool admissible(const LawProblem& p, std::size_t i, double vk, double vj) {
  constexpr double kTolerance = 1.0 + 1e-9;
  const double dt = p.ds_u(i) / ((vk + vj) / 2.0), a = (vj - vk) / dt;
  if (!(std::fabs(a) <= p.path_accel_u_s2 * kTolerance)) return false;
  for (std::size_t c = 0; c < p.axes; ++c) {
    const auto keeps = [&](std::size_t node, double v) {
      const std::size_t at = node * p.axes + c;
      return std::fabs(p.curvature[at] * v * v + p.slope[at] * a) <= p.max_accel_u_s2[c] * kTolerance;
    };
    if (!keeps(i, vj)) return false;
    if (p.accel_test == AccelTest::both_nodes && !keeps(i - 1, vk)) return false;
  }
  return true;
}

}  // namespace

LawResult literal_dp(const LawProblem& p, const std::vector<LevelRange>& levels) {
  const std::size_t n = p.nodes();
  std::vector<std::vector<double>> cost(n);
  std::vector<std::vector<std::int32_t>> from(n);
  cost[0] = {0.0};
  for (std::size_t i = 1; i < n; ++i) {
    cost[i].assign(static_cast<std::size_t>(levels[i].count), machine::kInfinity);
    from[i].assign(cost[i].size(), -1);
    for (std::int32_t j = 0; j < levels[i].count; ++j)
      for (std::int32_t k = 0; k < levels[i - 1].count; ++k) {
        const double vj = levels[i].speed_u_s(j), vk = levels[i - 1].speed_u_s(k);
        const double before = cost[i - 1][static_cast<std::size_t>(k)];
        if (before == machine::kInfinity || !(vj + vk > 0.0) || !admissible(p, i, vk, vj)) continue;
        const double dt = p.ds_u(i) / ((vk + vj) / 2.0), a = (vj - vk) / dt;
        const double c = before + dt + p.penalty_weight(i) * a * a;
        if (!(c < cost[i][static_cast<std::size_t>(j)])) continue;
        cost[i][static_cast<std::size_t>(j)] = c;
        from[i][static_cast<std::size_t>(j)] = k;
      }
  }
  if (cost[n - 1][0] == machine::kInfinity)
    return tl::unexpected(LawFailure{n - 1, p.s_u[n - 1], "not reached"});
  std::vector<double> speed(n);
  std::int32_t j = 0;
  for (std::size_t i = n - 1;; --i) {
    speed[i] = levels[i].speed_u_s(j);
    if (i == 0) break;
    j = from[i][static_cast<std::size_t>(j)];
  }
  LawSolution out = summed(p, std::move(speed));
  out.cost_s = cost[n - 1][0];
  return out;
}

}  // namespace kadr::planner
