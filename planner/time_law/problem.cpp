#include "planner/time_law/problem.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace kadr::planner {
namespace {

constexpr double kReferenceIntervals = 892.0;  ///< of the paper's path, which its penalty was chosen for

bool positive(double v) { return v > 0.0; }

std::optional<LawFailure> check_shape(const LawProblem& p) {
  const std::size_t n = p.nodes();
  const auto wrong = [](std::string what) { return LawFailure{0, 0.0, std::move(what)}; };
  if (n < 3) return wrong(fmt::format("{} nodes, at least 3 are needed", n));
  if (p.axes == 0) return wrong("no axis");
  if (p.slope.size() != n * p.axes || p.curvature.size() != n * p.axes)
    return wrong(fmt::format("{} slopes and {} curvatures, {} nodes of {} axes need {}", p.slope.size(),
                             p.curvature.size(), n, p.axes, n * p.axes));
  const auto given = [](const std::vector<double>& v, std::size_t size) {
    return v.empty() || v.size() == size;
  };
  if (!given(p.slope_behind, n * p.axes) || !given(p.curvature_behind, n * p.axes) || !given(p.cap_u_s, n) ||
      !given(p.interval_accel_u_s2, n))
    return wrong(fmt::format("values behind nodes, caps or accelerations that are not of {} nodes", n));
  if (p.max_feed_u_s.size() != p.axes || p.max_accel_u_s2.size() != p.axes)
    return wrong(fmt::format("limits of {} and {} axes, {} axes", p.max_feed_u_s.size(),
                             p.max_accel_u_s2.size(), p.axes));
  return std::nullopt;
}

std::optional<LawFailure> check_values(const LawProblem& p) {
  for (std::size_t c = 0; c < p.axes; ++c) {
    if (!positive(p.max_feed_u_s[c]) || !positive(p.max_accel_u_s2[c]))
      return LawFailure{0, p.s_u[0],
                        fmt::format("axis {}: speed limit {:.6g} and acceleration limit {:.6g} (units/s, "
                                    "units/s2), both must be above 0",
                                    c + 1, p.max_feed_u_s[c], p.max_accel_u_s2[c])};
  }
  if (!positive(p.path_feed_u_s) || !positive(p.path_accel_u_s2))
    return LawFailure{0, p.s_u[0],
                      fmt::format("path limits {:.6g} mm/s and {:.6g} mm/s2, both must be above 0",
                                  p.path_feed_u_s, p.path_accel_u_s2)};
  if (!(p.begin_u_s >= 0.0) || !(p.end_u_s >= 0.0) || !(p.penalty.weight_s5_u2 >= 0.0) ||
      !std::isfinite(p.penalty.weight_s5_u2))
    return LawFailure{
        0, p.s_u[0],
        fmt::format("end speeds {:.6g} and {:.6g} mm/s, penalty {:.6g} s5/mm2, none may be below 0",
                    p.begin_u_s, p.end_u_s, p.penalty.weight_s5_u2)};
  for (const SpeedZone& z : p.zones)
    if (!positive(z.speed_u_s) || !(z.begin_u <= z.end_u))
      return LawFailure{
          0, z.begin_u,
          fmt::format(
              "zone from {:.6g} to {:.6g} mm at {:.6g} mm/s: it must not end before it begins, and its "
              "speed must be above 0",
              z.begin_u, z.end_u, z.speed_u_s)};
  return std::nullopt;
}

std::optional<LawFailure> check_nodes(const LawProblem& p) {
  for (std::size_t i = 0; i < p.nodes(); ++i) {
    if (!std::isfinite(p.s_u[i]) || (i > 0 && !(p.s_u[i] > p.s_u[i - 1])))
      return LawFailure{i, p.s_u[i], fmt::format("s is {:.6f} mm, nodes must ascend", p.s_u[i])};
    bool moves = false;
    for (std::size_t c = 0; c < p.axes; ++c) {
      const double slope = p.slopes(i)[c], curvature = p.curvatures(i)[c];
      if (!std::isfinite(slope) || !std::isfinite(curvature) || !std::isfinite(p.slopes_behind(i)[c]) ||
          !std::isfinite(p.curvatures_behind(i)[c]))
        return LawFailure{
            i, p.s_u[i],
            fmt::format("axis {}: X' {:.6g} and X'' {:.6g} units/mm and /mm2, both must be finite", c + 1,
                        slope, curvature)};
      moves = moves || slope != 0.0;
    }
    if (!p.cap_u_s.empty() && !(p.cap_u_s[i] >= 0.0))
      return LawFailure{i, p.s_u[i],
                        fmt::format("a cap of {:.6g} mm/s, it must not be below 0", p.cap_u_s[i])};
    if (!p.interval_accel_u_s2.empty() && i > 0 && !positive(p.interval_accel_u_s2[i]))
      return LawFailure{
          i, p.s_u[i],
          fmt::format("an acceleration limit of {:.6g} mm/s2, it must be above 0", p.interval_accel_u_s2[i])};
    if (!moves && !std::isfinite(p.path_feed_u_s) && p.cap_u_s.empty())
      return LawFailure{i, p.s_u[i], "no axis moves here, and the path has no feed limit"};
  }
  return std::nullopt;
}

}  // namespace

double LawProblem::penalty_weight(std::size_t interval) const {
  const double all = static_cast<double>(axes);
  const double weight = penalty.weight_s5_u2 * all * all;
  return penalty.per_length ? weight * (ds_u(interval) * kReferenceIntervals / length_u()) : weight;
}

std::optional<LawFailure> check_problem(const LawProblem& p) {
  if (auto wrong = check_shape(p)) return wrong;
  if (auto wrong = check_values(p)) return wrong;
  if (auto wrong = check_nodes(p)) return wrong;
  const std::vector<NodeCap> caps = node_caps(p);
  const std::size_t last = p.nodes() - 1;
  for (const std::size_t end : {std::size_t{0}, last}) {
    const double speed = end == 0 ? p.begin_u_s : p.end_u_s;
    if (speed > caps[end].speed_u_s)
      return LawFailure{end, p.s_u[end],
                        fmt::format("the speed here must be {:.6g} mm/s, but at most {:.6g} mm/s is allowed",
                                    speed, caps[end].speed_u_s)};
  }
  return std::nullopt;
}

std::vector<NodeCap> node_caps(const LawProblem& p) {
  std::vector<NodeCap> caps(p.nodes());
  for (std::size_t i = 0; i < p.nodes(); ++i) {
    caps[i].speed_u_s = p.path_feed_u_s;
    if (!p.cap_u_s.empty() && p.cap_u_s[i] < caps[i].speed_u_s) caps[i] = {p.cap_u_s[i], NodeCap::kGiven};
    for (std::size_t c = 0; c < p.axes; ++c) {
      const double slope = std::max(std::fabs(p.slopes(i)[c]), std::fabs(p.slopes_behind(i)[c]));
      if (slope * caps[i].speed_u_s <= p.max_feed_u_s[c] || slope == 0.0) continue;
      caps[i] = {p.max_feed_u_s[c] / slope, static_cast<std::int32_t>(c)};
    }
  }
  for (const SpeedZone& zone : p.zones) {
    if (zone.end_u < p.s_u.front() || zone.begin_u > p.s_u.back()) continue;
    const auto behind = std::upper_bound(p.s_u.begin(), p.s_u.end(), zone.begin_u);
    const auto first = behind == p.s_u.begin() ? behind : behind - 1;
    const auto end = std::lower_bound(p.s_u.begin(), p.s_u.end(), zone.end_u);
    const auto last = end == p.s_u.end() ? end - 1 : end;
    for (auto s = first; s <= last; ++s) {
      NodeCap& cap = caps[static_cast<std::size_t>(s - p.s_u.begin())];
      if (cap.speed_u_s > zone.speed_u_s) cap = {zone.speed_u_s, NodeCap::kZone};
    }
  }
  return caps;
}

AccelRows accel_rows(const LawProblem& p) {
  AccelRows rows;
  const bool both = p.accel_test == AccelTest::both_nodes;
  rows.per_interval = 1 + p.axes * (both ? 2 : 1);
  rows.before.assign(p.nodes() * rows.per_interval, 0.0);
  rows.after = rows.before;
  for (std::size_t i = 1; i < p.nodes(); ++i) {
    const double h = 0.5 / p.ds_u(i);  // a = h (x_i - x_(i-1))
    std::size_t r = i * rows.per_interval;
    const auto row = [&](double before, double after, double limit) {
      rows.before[r] = before / limit;
      rows.after[r] = after / limit;
      ++r;
    };
    row(-h, h, p.accel_limit_u_s2(i));
    for (std::size_t c = 0; c < p.axes; ++c) {
      const double slope = p.slopes(i)[c] * h;
      row(-slope, p.curvatures(i)[c] + slope, p.max_accel_u_s2[c]);
    }
    for (std::size_t c = 0; both && c < p.axes; ++c) {
      const double slope = p.slopes_behind(i - 1)[c] * h;
      row(p.curvatures_behind(i - 1)[c] - slope, slope, p.max_accel_u_s2[c]);
    }
  }
  return rows;
}

}  // namespace kadr::planner
