#include "planner/time_law/verify_law.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace kadr::planner {
namespace {

constexpr double kInside = 1e-7;  ///< of an interval: a hair beside its ends, where X' may jump

class Checker {
 public:
  Checker(const LawProblem& p, const LawSolution& x, const LawCheckOptions& o)
      : p_(p), v_(x.speed_u_s), options_(o) {}

  LawCheck run(const LawSolution& solution, const PathDerivatives& path) {
    if (v_.size() != p_.nodes()) {
      broken("number of speeds", 0.0, static_cast<double>(v_.size()), static_cast<double>(p_.nodes()));
      return check_;
    }
    nodes();
    ends_and_sums(solution);
    zones();
    if (path) inner_points(path);
    return check_;
  }

 private:
  void broken(const std::string& what, double s, double value, double limit) {
    for (LawViolation& b : check_.broken)
      if (b.what == what) {
        if (value * b.limit > b.value * limit) b = {what, s, value, limit};
        return;
      }
    check_.broken.push_back({what, s, value, limit});
  }

  void node_limit(const char* kind, std::size_t axis, double s, double value, double limit) {
    const double excess = value / limit - 1.0;
    check_.node_excess = std::max(check_.node_excess, excess);
    if (excess <= options_.tolerance) return;  // NaN is broken
    broken(axis < p_.axes ? fmt::format("axis {} {}", axis + 1, kind) : fmt::format("path {}", kind), s,
           value, limit);
  }

  void nodes() {
    check_.node_excess = -1.0;
    for (std::size_t i = 0; i < p_.nodes(); ++i) {
      const double s = p_.s_u[i];
      if (!std::isfinite(v_[i]) || v_[i] < 0.0) broken("speed below 0", s, v_[i], 0.0);
      node_limit("speed", p_.axes, s, v_[i], p_.path_feed_u_s);
      for (std::size_t c = 0; c < p_.axes; ++c)
        for (const double slope : {p_.slopes(i)[c], p_.slopes_behind(i)[c]})
          node_limit("speed", c, s, std::fabs(slope) * v_[i], p_.max_feed_u_s[c]);
      if (!p_.cap_u_s.empty()) given_cap(i);
      if (i > 0) interval(i);
    }
  }

  void given_cap(std::size_t i) {
    if (v_[i] > p_.cap_u_s[i] * (1.0 + options_.tolerance))
      broken("given cap", p_.s_u[i], v_[i], p_.cap_u_s[i]);
  }

  double accel(std::size_t i) const {
    return (v_[i] * v_[i] - v_[i - 1] * v_[i - 1]) / (2.0 * (p_.s_u[i] - p_.s_u[i - 1]));
  }

  void interval(std::size_t i) {
    const double a = accel(i);
    if (!(v_[i] + v_[i - 1] > 0.0)) broken("time that does not pass", p_.s_u[i], 0.0, 0.0);
    node_limit("acceleration", p_.axes, p_.s_u[i], std::fabs(a), p_.path_accel_u_s2);
    if (!p_.interval_accel_u_s2.empty())
      node_limit("acceleration", p_.axes, p_.s_u[i], std::fabs(a), p_.interval_accel_u_s2[i]);
    for (std::size_t end = 0; end < (p_.accel_test == AccelTest::both_nodes ? 2u : 1u); ++end) {
      const std::size_t node = i - end;
      const double* slope = end == 0 ? p_.slopes(node) : p_.slopes_behind(node);
      const double* curvature = end == 0 ? p_.curvatures(node) : p_.curvatures_behind(node);
      for (std::size_t c = 0; c < p_.axes; ++c)
        node_limit("acceleration", c, p_.s_u[node],
                   std::fabs(slope[c] * a + curvature[c] * v_[node] * v_[node]), p_.max_accel_u_s2[c]);
    }
  }

  void ends_and_sums(const LawSolution& solution) {
    if (v_.front() != p_.begin_u_s)
      broken("speed at the beginning", p_.s_u.front(), v_.front(), p_.begin_u_s);
    if (v_.back() != p_.end_u_s) broken("speed at the end", p_.s_u.back(), v_.back(), p_.end_u_s);
    double time = 0, cost = 0;
    for (std::size_t i = 1; i < p_.nodes(); ++i) {
      const double dt = (p_.s_u[i] - p_.s_u[i - 1]) / (0.5 * (v_[i] + v_[i - 1])), a = accel(i);
      time += dt;
      cost += dt + p_.penalty_weight(i) * a * a;
    }
    if (!(std::fabs(time - solution.time_s) <= 1e-9 * time)) broken("time", 0.0, solution.time_s, time);
    if (!(std::fabs(cost - solution.cost_s) <= 1e-9 * cost)) broken("cost", 0.0, solution.cost_s, cost);
    if (solution.lower_bound_s > cost * (1.0 + options_.tolerance))
      broken("lower bound", 0.0, solution.lower_bound_s, cost);
  }

  double speed_at(double s) const {
    const auto behind = std::upper_bound(p_.s_u.begin(), p_.s_u.end(), s);
    const std::size_t i =
        std::clamp<std::size_t>(static_cast<std::size_t>(behind - p_.s_u.begin()), 1, p_.nodes() - 1);
    const double x0 = v_[i - 1] * v_[i - 1], x1 = v_[i] * v_[i];
    return std::sqrt(x0 + (x1 - x0) * (s - p_.s_u[i - 1]) / (p_.s_u[i] - p_.s_u[i - 1]));
  }

  void zones() {
    for (const SpeedZone& z : p_.zones) {
      if (z.end_u < p_.s_u.front() || z.begin_u > p_.s_u.back()) continue;
      const auto look = [&](double s, double v) {
        if (v > z.speed_u_s * (1.0 + options_.tolerance)) broken("zone", s, v, z.speed_u_s);
      };
      for (const double s : {std::max(z.begin_u, p_.s_u.front()), std::min(z.end_u, p_.s_u.back())})
        look(s, speed_at(s));
      for (std::size_t i = 0; i < p_.nodes(); ++i)
        if (p_.s_u[i] >= z.begin_u && p_.s_u[i] <= z.end_u) look(p_.s_u[i], v_[i]);
    }
  }

  void inner_points(const PathDerivatives& path) {
    check_.dense_excess = -1.0;
    std::vector<double> slope(p_.axes), curvature(p_.axes);
    for (std::size_t i = 1; i < p_.nodes(); ++i) {
      const double a = accel(i);
      for (std::uint32_t q = 0; q <= options_.inner_points; ++q) {
        const double part =
            std::clamp(static_cast<double>(q) / options_.inner_points, kInside, 1.0 - kInside);
        const double s = p_.s_u[i - 1] + part * (p_.s_u[i] - p_.s_u[i - 1]);
        const double x = v_[i - 1] * v_[i - 1] * (1.0 - part) + v_[i] * v_[i] * part;
        path(s, slope.data(), curvature.data());
        for (std::size_t c = 0; c < p_.axes; ++c) {
          const double speed = std::fabs(slope[c]) * std::sqrt(x) / p_.max_feed_u_s[c];
          const double force = std::fabs(slope[c] * a + curvature[c] * x) / p_.max_accel_u_s2[c];
          check_.dense_excess = std::max(check_.dense_excess, std::max(speed, force) - 1.0);
        }
      }
    }
  }

  const LawProblem& p_;
  const std::vector<double>& v_;
  LawCheckOptions options_;
  LawCheck check_;
};

}  // namespace

LawCheck verify_law(const LawProblem& problem, const LawSolution& solution, const PathDerivatives& path,
                    const LawCheckOptions& options) {
  return Checker(problem, solution, options).run(solution, path);
}

}  // namespace kadr::planner
