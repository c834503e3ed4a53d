#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "literal_dp.h"
#include "planner/time_law/active_limits.h"
#include "planner/time_law/greedy.h"
#include "planner/time_law/tube.h"
#include "planner/time_law/verify_law.h"
#include "reference_law.h"

using namespace kadr;
using namespace kadr::planner;

namespace {

using Kind = ActiveLimit::Kind;

std::size_t count(const std::vector<ActiveLimit>& all, ActiveLimit wanted) {
  return static_cast<std::size_t>(std::count(all.begin(), all.end(), wanted));
}

/// The loop of the paper with the programme word by word.
std::vector<TubePass> literal_tube(const LawProblem& p, const TubeOptions& options) {
  const std::vector<NodeCap> caps = node_caps(p);
  std::vector<LevelRange> levels(p.nodes());
  const auto ends = [&] {
    levels.front() = LevelRange::single(p.begin_u_s);
    levels.back() = LevelRange::single(p.end_u_s);
  };
  for (std::size_t i = 0; i < p.nodes(); ++i)
    levels[i] = LevelRange::uniform(options.levels, 0.0, caps[i].speed_u_s);
  ends();
  LawResult law = literal_dp(p, levels);
  REQUIRE(law);
  TubeControl control(
      options, *law,
      options.relative_half_width * *std::max_element(law->speed_u_s.begin(), law->speed_u_s.end()));
  while (!control.ended()) {
    const double half = control.half_width_u_s();
    const std::vector<double> before = law->speed_u_s;
    for (std::size_t i = 1; i + 1 < p.nodes(); ++i)
      levels[i] = LevelRange::uniform(options.levels, std::max(before[i] - half, 0.0),
                                      std::min(before[i] + half, caps[i].speed_u_s));
    ends();
    law = literal_dp(p, levels);
    REQUIRE(law);
    bool touched = false;
    for (std::size_t i = 1; i + 1 < p.nodes(); ++i) {
      const double v = law->speed_u_s[i];
      touched = touched ||
                (before[i] + half < caps[i].speed_u_s && v == levels[i].speed_u_s(options.levels - 1)) ||
                (before[i] - half > 0.0 && v == levels[i].speed_u_s(0));
    }
    control.pass(law->time_s, law->cost_s, touched);
  }
  return control.passes();
}

}  // namespace

TEST_CASE("what holds the time optimum of the reference path, node by node, as measured") {
  const ReferenceLaw law = paper_law();
  const LawResult found = GreedyOptimum().solve(law.problem);
  REQUIRE(found);
  const std::vector<ActiveLimit> active = active_limits(law.problem, found->speed_u_s);
  REQUIRE(active.size() == 892);
  // 30 nodes at their highest speed: 21 by axis 1, 5 by the path, 4 by technology points
  CHECK(count(active, {Kind::speed, 0}) == 21);
  CHECK(count(active, {Kind::speed, NodeCap::kPathFeed}) == 5);
  CHECK(count(active, {Kind::speed, NodeCap::kZone}) == 4);
  // 862 by an axis's acceleration: 224 77 165 101 100 195 of axes 1 to 6. In three of them, where speeding up
  // turns into braking, no limit is quite reached; they were counted to the one that comes nearest.
  CHECK(count(active, {Kind::path_acceleration, 0}) == 0);
  CHECK(count(active, {}) == 3);
  const AccelRows rows = accel_rows(law.problem);
  std::array<std::size_t, 7> axes{};
  for (std::size_t i = 1; i < law.problem.nodes(); ++i) {
    const ActiveLimit& a = active[i - 1];
    if (a.kind == Kind::axis_acceleration) ++axes[static_cast<std::size_t>(a.of)];
    if (a.kind != Kind::none) continue;
    double most = 0.0;
    std::size_t nearest = 0;
    for (std::size_t r = 0; r < rows.per_interval; ++r) {
      const std::size_t at = i * rows.per_interval + r;
      const double v0 = found->speed_u_s[i - 1], v1 = found->speed_u_s[i];
      const double used = std::fabs(rows.before[at] * v0 * v0 + rows.after[at] * v1 * v1);
      if (used > most) most = used, nearest = r;
    }
    REQUIRE(nearest > 0);
    ++axes[nearest - 1];
  }
  CHECK(axes == std::array<std::size_t, 7>{224, 77, 165, 101, 100, 195, 0});
}

TEST_CASE("a law below its limits is held by none, and each kind of limit is seen where it is reached") {
  // X = s, 100 mm in 101 nodes: 200 mm/s2 of the axis, 100 of the path, 50 mm/s, a zone
  LawProblem p;
  p.axes = 1;
  for (int i = 0; i <= 100; ++i) p.s_u.push_back(i);
  p.slope.assign(101, 1.0);
  p.curvature.assign(101, 0.0);
  p.max_feed_u_s = {300.0};
  p.max_accel_u_s2 = {200.0};
  p.path_feed_u_s = 50.0;
  p.path_accel_u_s2 = 100.0;
  p.zones = {{60.0, 60.0, 20.0}};
  REQUIRE(!check_problem(p));
  const LawResult law = GreedyOptimum().solve(p);
  REQUIRE(law);
  const std::vector<ActiveLimit> active = active_limits(p, law->speed_u_s);
  CHECK(active[0] == ActiveLimit{Kind::path_acceleration, 0});
  // 50^2/200 = 12.5 mm of ramp
  CHECK(active[30] == ActiveLimit{Kind::speed, NodeCap::kPathFeed});
  CHECK(active[59] == ActiveLimit{Kind::speed, NodeCap::kZone});
  CHECK(active[99] == ActiveLimit{Kind::path_acceleration, 0});
  std::vector<double> slow = law->speed_u_s;
  for (double& v : slow) v *= 0.9;
  const std::vector<ActiveLimit> none = active_limits(p, slow);
  CHECK(count(none, {}) == none.size());
}

TEST_CASE("the loop with the literal programme has the same passes: times, costs, touches, half widths") {
  for (const std::uint32_t seed : {3u, 8u}) {
    CAPTURE(seed);
    const ReferenceLaw law = ReferenceLaw::random(seed, 160);
    TubeOptions options;
    options.levels = 40;
    options.most_passes = 30;
    TubeDp tube(options);
    REQUIRE(tube.solve(law.problem));
    const std::vector<TubePass> literal = literal_tube(law.problem, options);
    REQUIRE(tube.passes().size() == literal.size());
    CHECK(literal.size() > 3);
    for (std::size_t i = 0; i < literal.size(); ++i) {
      CHECK(std::fabs(tube.passes()[i].cost_s - literal[i].cost_s) <= 1e-12 * literal[i].cost_s);
      CHECK(tube.passes()[i].touched == literal[i].touched);
      CHECK(tube.passes()[i].half_width_u_s == literal[i].half_width_u_s);
    }
  }
}

TEST_CASE("at the exact technology points, between nodes, no law is faster than they allow") {
  const ReferenceLaw law = paper_law();
  TubeDp tube;
  const LawResult found = tube.solve(law.problem);
  REQUIRE(found);
  for (const SpeedZone& zone : law.problem.zones) {
    std::size_t i = 1;
    while (law.problem.s_u[i] < zone.begin_u) ++i;
    // v^2 is linear between nodes
    const double part = (zone.begin_u - law.problem.s_u[i - 1]) / law.problem.ds_u(i);
    const double v0 = found->speed_u_s[i - 1], v1 = found->speed_u_s[i];
    const double v = std::sqrt(v0 * v0 * (1.0 - part) + v1 * v1 * part);
    CHECK(v <= zone.speed_u_s);
    CHECK(v >= 0.98 * zone.speed_u_s);
  }
  CHECK(found->speed_u_s.front() == 0.0);
  CHECK(found->speed_u_s.back() == 0.0);
}

TEST_CASE("methods tell how far they are, in order, and find the same law as when nobody listens") {
  const ReferenceLaw law = paper_law(300);
  std::vector<std::string> stages;
  double last = -1.0;
  bool ascends = true;
  TubeDp tube, silent;
  tube.on_progress([&](std::string_view stage, double done) {
    if (stages.empty() || stages.back() != stage) {
      stages.emplace_back(stage);
      last = -1.0;
    }
    ascends = ascends && done > last && done < 1.0;
    last = done;
  });
  const LawResult told = tube.solve(law.problem), quiet = silent.solve(law.problem);
  REQUIRE(told);
  REQUIRE(quiet);
  CHECK(told->speed_u_s == quiet->speed_u_s);
  CHECK(ascends);
  REQUIRE(stages.size() == tube.passes().size());
  for (std::size_t i = 0; i < stages.size(); ++i) CHECK(stages[i] == "pass " + std::to_string(i + 1));
}
