#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "literal_dp.h"
#include "planner/time_law/certified.h"
#include "planner/time_law/greedy.h"
#include "planner/time_law/interior_point.h"
#include "planner/time_law/jerk_limited.h"
#include "planner/time_law/tube.h"
#include "planner_support.h"
#include "reference_law.h"
#include "tests/support/seed.h"

using namespace kadr;
using namespace kadr::planner;
using kadr::test::environment;

namespace {

std::vector<LevelRange> all_levels(const LawProblem& p, std::int32_t count) {
  const std::vector<NodeCap> caps = node_caps(p);
  std::vector<LevelRange> levels;
  for (const NodeCap& c : caps) levels.push_back(LevelRange::uniform(count, 0.0, c.speed_u_s));
  levels.front() = LevelRange::single(p.begin_u_s);
  levels.back() = LevelRange::single(p.end_u_s);
  return levels;
}

/// Levels of a tube round a law, the kept one an irregular level.
std::vector<LevelRange> tube_levels(const LawProblem& p, const LawSolution& law, std::int32_t count,
                                    double half) {
  const std::vector<NodeCap> caps = node_caps(p);
  std::vector<LevelRange> levels = all_levels(p, count);
  for (std::size_t i = 1; i + 1 < p.nodes(); ++i) {
    const double v = law.speed_u_s[i];
    levels[i] =
        LevelRange::keeping(count, std::max(v - half, 0.0), std::min(v + 1.7 * half, caps[i].speed_u_s), v);
  }
  return levels;
}

/// Moves the nodes of a path to uneven places.
ReferenceLaw uneven(std::uint32_t seed, std::size_t nodes) {
  ReferenceLaw law = ReferenceLaw::random(seed, nodes);
  std::mt19937 draw(seed);
  const double step = law.problem.s_u[1];
  for (std::size_t i = 1; i + 1 < nodes; ++i) {
    const double s =
        law.problem.s_u[i] + 0.4 * step * (2.0 * static_cast<double>(draw()) / 4294967296.0 - 1.0);
    law.problem.s_u[i] = s;
    derivatives(law.axes, 2846.9)(s, &law.problem.slope[i * 7], &law.problem.curvature[i * 7]);
  }
  return law;
}

void check_law(const LawProblem& p, const LawSolution& law, const char* who) {
  for (const LawViolation& b : verify_law(p, law).broken)
    FAIL_CHECK(who, ": ", b.what, " at ", b.s_u, ": ", b.value, " > ", b.limit);
}

}  // namespace

TEST_CASE(
    "the fast programme finds what the literal one finds: uniform, kept and uneven levels, both ends of "
    "intervals") {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    ReferenceLaw law = seed % 2 ? ReferenceLaw::random(seed, 250) : uneven(seed, 250);
    if (seed % 3 == 0) law.problem.accel_test = AccelTest::both_nodes;
    if (seed % 4 == 0) law.problem.penalty = {3e-11, true};
    REQUIRE(!check_problem(law.problem));
    DynamicProgramme programme(law.problem);
    for (const std::int32_t count : {60, 131}) {
      const auto levels = all_levels(law.problem, count);
      const LawResult fast = programme.run(levels), literal = literal_dp(law.problem, levels);
      REQUIRE(fast.has_value() == literal.has_value());
      if (fast) CHECK(std::fabs(fast->cost_s - literal->cost_s) <= 1e-12 * literal->cost_s);
    }
    const LawResult greedy = GreedyOptimum().solve(law.problem);
    REQUIRE(greedy);
    const auto levels = tube_levels(law.problem, *greedy, 33, 25.0);
    const LawResult fast = programme.run(levels), literal = literal_dp(law.problem, levels);
    REQUIRE(fast);
    CHECK(std::fabs(fast->cost_s - literal->cost_s) <= 1e-12 * literal->cost_s);
  }
}

TEST_CASE("two and four lanes give the same levels and the same bits") {
#ifdef __x86_64__
  if (!__builtin_cpu_supports("avx2")) {
    MESSAGE("no AVX2 here");
    return;
  }
#endif
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    const ReferenceLaw law = ReferenceLaw::random(seed, 300);
    const LawResult greedy = GreedyOptimum().solve(law.problem);
    REQUIRE(greedy);
    DynamicProgramme two(law.problem, dp_step_sse2), four(law.problem, dp_step_avx2);
    for (const auto& levels : {all_levels(law.problem, 101), tube_levels(law.problem, *greedy, 22, 30.0)}) {
      const LawResult a = two.run(levels), b = four.run(levels);
      REQUIRE(a.has_value() == b.has_value());
      if (!a) continue;
      CHECK(two.level() == four.level());
      CHECK(a->speed_u_s == b->speed_u_s);
      CHECK(a->time_s == b->time_s);
      CHECK(a->cost_s == b->cost_s);
    }
    CHECK(two.transitions() == four.transitions());
  }
}

TEST_CASE("the start-node time optimum is that of the path reversed") {
  const ReferenceLaw law = paper_law();
  LawProblem reversed = law.problem;
  const std::size_t n = reversed.nodes(), axes = reversed.axes;
  for (std::size_t i = 0; i < n; ++i) {
    reversed.s_u[i] = law.problem.s_u[n - 1] - law.problem.s_u[n - 1 - i];
    for (std::size_t c = 0; c < axes; ++c) {
      reversed.slope[i * axes + c] = -law.problem.slope[(n - 1 - i) * axes + c];
      reversed.curvature[i * axes + c] = law.problem.curvature[(n - 1 - i) * axes + c];
    }
  }
  for (SpeedZone& z : reversed.zones) {
    const double at = law.problem.length_u() - z.begin_u;
    z.begin_u = z.end_u = at;
  }
  const LawResult found = GreedyOptimum().solve(reversed);
  REQUIRE(found);
  CHECK(std::fabs(found->time_s - 5.872704) <= 1e-5);
}

TEST_CASE("between nodes: limits at end nodes are exceeded by 2.5 %, at both nodes by less than 0.1 %") {
  ReferenceLaw law = paper_law();
  TubeDp tube;
  const LawResult paper = tube.solve(law.problem);
  REQUIRE(paper);
  const double printed = verify_law(law.problem, *paper, derivatives(law.axes, 2846.9)).dense_excess;
  CHECK(printed > 0.01);  // the check sees what the printed test lets through
  CHECK(printed < 0.026);
  law.problem.accel_test = AccelTest::both_nodes;
  const LawResult strict = tube.solve(law.problem);
  REQUIRE(strict);
  CHECK(verify_law(law.problem, *strict, derivatives(law.axes, 2846.9)).dense_excess < 1e-3);
}

TEST_CASE("with the law before kept as a level the cost never rises") {
  const ReferenceLaw law = paper_law();
  TubeOptions options;
  options.grid = TubeGrid::nominal_kept;
  TubeDp tube(options);
  const LawResult found = tube.solve(law.problem);
  REQUIRE(found);
  InteriorPointOptimum optimum;
  const LawResult best = optimum.solve(law.problem);
  REQUIRE(best);
  CHECK(found->cost_s / best->lower_bound_s - 1.0 <= 1e-3);
  for (std::size_t i = 1; i < tube.passes().size(); ++i)
    CHECK(tube.passes()[i].cost_s <= tube.passes()[i - 1].cost_s * (1.0 + 1e-12));
}

TEST_CASE("100 random paths: the certified law is within 0.005 % of its bound, no method is below it") {
  const int count = static_cast<int>(environment("KADR_COUNT", 100));
  double worst = 0, sum = 0;
  for (int seed = 1; seed <= count; ++seed) {
    CAPTURE(seed);
    const ReferenceLaw law = ReferenceLaw::random(static_cast<std::uint32_t>(seed));
    REQUIRE(!check_problem(law.problem));
    CertifiedLaw certified;
    const LawResult found = certified.solve(law.problem), greedy = GreedyOptimum().solve(law.problem);
    REQUIRE(greedy);
    REQUIRE(found);
    check_law(law.problem, *found, "certified");
    check_law(law.problem, *greedy, "greedy");
    const double gap = found->cost_s / found->lower_bound_s - 1.0;
    CHECK(gap <= 5e-5);
    CHECK(gap >= -1e-9);
    CHECK(found->cost_s <= greedy->cost_s * (1.0 + 1e-12));
    worst = std::max(worst, gap);
    sum += gap;
    TubeDp tube;
    const LawResult t = tube.solve(law.problem);
    REQUIRE(t);
    check_law(law.problem, *t, "tube");
    CHECK(t->cost_s >= found->lower_bound_s * (1.0 - 1e-9));
  }
  MESSAGE("gap: mean ", sum / count, ", worst ", worst);
}

TEST_CASE(
    "given end speeds, uneven nodes, both ends of every interval: all methods keep the limits and the "
    "bound") {
  const int count = static_cast<int>(environment("KADR_COUNT", 60));
  for (int seed = 1; seed <= count; ++seed) {
    CAPTURE(seed);
    ReferenceLaw law = uneven(static_cast<std::uint32_t>(seed), 300);
    law.problem.accel_test = seed % 2 ? AccelTest::both_nodes : AccelTest::end_node;
    law.problem.penalty.per_length = seed % 3 == 0;
    const std::vector<NodeCap> caps = node_caps(law.problem);
    // a law in the middle of its range at both ends, as one between two stretches has
    law.problem.begin_u_s = 0.3 * caps.front().speed_u_s;
    law.problem.end_u_s = 0.2 * caps.back().speed_u_s;
    REQUIRE(!check_problem(law.problem));
    const LawResult greedy = GreedyOptimum().solve(law.problem);
    REQUIRE(greedy);
    check_law(law.problem, *greedy, "greedy");
    CertifiedLaw certified;
    const LawResult found = certified.solve(law.problem);
    if (!found) FAIL(found.error().reason);
    check_law(law.problem, *found, "certified");
    CHECK(found->cost_s / found->lower_bound_s - 1.0 <= 5e-5);
    InteriorPointOptimum optimum;
    const LawResult best = optimum.solve(law.problem);
    REQUIRE(best);
    check_law(law.problem, *best, "optimum");
    CHECK(best->cost_s - best->lower_bound_s <= 1e-7 * best->cost_s);
  }
}

TEST_CASE("a bound by any multipliers is a bound, and that of the optimum is the highest") {
  const ReferenceLaw law = ReferenceLaw::random(5, 200);
  InteriorPointOptimum optimum;
  const LawResult best = optimum.solve(law.problem);
  REQUIRE(best);
  Certificate c = optimum.certificate();
  std::mt19937 draw(static_cast<unsigned>(kadr::test::property_seed(1)));
  for (int round = 0; round < 50; ++round) {
    Certificate changed = c;
    for (auto* side : {&changed.upper, &changed.lower})
      for (double& l : *side) l *= 0.5 + static_cast<double>(draw()) / 4294967296.0;
    for (std::size_t i = 1; i + 1 < law.problem.nodes(); ++i)
      changed.speed_u_s[i] *= 0.9 + 0.2 * static_cast<double>(draw()) / 4294967296.0;
    CHECK(lower_bound_s(law.problem, changed) < best->lower_bound_s);
  }
}

TEST_CASE("the verifier sees a broken limit of every kind") {
  const ReferenceLaw law = paper_law();
  const LawResult greedy = GreedyOptimum().solve(law.problem);
  REQUIRE(greedy);
  REQUIRE(verify_law(law.problem, *greedy).broken.empty());
  const auto kinds = [&](const LawProblem& p, const std::vector<double>& v) {
    std::string text;
    for (const LawViolation& b : verify_law(p, summed(p, v)).broken) text += b.what + ";";
    return text;
  };
  std::vector<double> faster = greedy->speed_u_s;
  for (double& v : faster) v *= 1.01;
  const std::string found = kinds(law.problem, faster);
  for (const char* kind : {"axis 1 speed", "axis 4 acceleration", "path speed", "zone"})
    CHECK_MESSAGE(found.find(kind) != std::string::npos, std::string(kind));
  std::vector<double> moving = greedy->speed_u_s;
  moving.front() = 1.0;
  CHECK(kinds(law.problem, moving).find("speed at the beginning") != std::string::npos);
  LawSolution wrong = *greedy;
  wrong.time_s += 1e-6;
  CHECK(verify_law(law.problem, wrong).broken.front().what == "time");
  wrong = *greedy;
  wrong.lower_bound_s = greedy->cost_s * 1.001;
  CHECK(verify_law(law.problem, wrong).broken.front().what == "lower bound");
  // 2 x 10 % too wide a tube: a law by limits that are doubled
  LawProblem doubled = law.problem;
  for (double& a : doubled.max_accel_u_s2) a *= 2.0;
  const LawResult too_fast = GreedyOptimum().solve(doubled);
  REQUIRE(too_fast);
  CHECK(verify_law(law.problem, *too_fast).node_excess == doctest::Approx(1.0).epsilon(1e-6));
}

TEST_CASE("a path on which axis 7 and the path's own acceleration hold the law") {
  ReferenceLaw law = paper_law();
  for (std::size_t c = 0; c < 6; ++c) {
    law.problem.max_feed_u_s[c] *= 4.0;
    law.problem.max_accel_u_s2[c] *= 16.0;
  }
  law.problem.max_accel_u_s2[6] = 600.0;
  law.problem.path_accel_u_s2 = 1100.0;
  const LawResult found = GreedyOptimum().solve(law.problem);
  REQUIRE(found);
  check_law(law.problem, *found, "greedy");
  int axis_7 = 0, path = 0;
  for (std::size_t i = 1; i < law.problem.nodes(); ++i) {
    const double v0 = found->speed_u_s[i - 1], v1 = found->speed_u_s[i];
    const double a = (v1 * v1 - v0 * v0) / (2.0 * law.problem.ds_u(i));
    path += std::fabs(a) > 0.999 * 1100.0;
    axis_7 += std::fabs(law.problem.slope[i * 7 + 6] * a + law.problem.curvature[i * 7 + 6] * v1 * v1) >
              0.999 * 600.0;
  }
  CHECK(axis_7 > 50);
  CHECK(path > 50);
  CertifiedLaw certified;
  const LawResult polished = certified.solve(law.problem);
  REQUIRE(polished);
  check_law(law.problem, *polished, "certified");
  CHECK(polished->cost_s / polished->lower_bound_s - 1.0 <= 5e-5);
}

TEST_CASE("what can't be solved is told with the node") {
  ReferenceLaw law = paper_law();
  SUBCASE("too fast at the beginning for what follows") {
    law.problem.begin_u_s = 300.0;
    law.problem.zones.push_back({5.0, 5.0, 10.0});
    REQUIRE(!check_problem(law.problem));
    const LawResult found = GreedyOptimum().solve(law.problem);
    REQUIRE(!found);
    CHECK(found.error().node == 0);
    CHECK(found.error().reason.find("300") != std::string::npos);
    CHECK(!CertifiedLaw().solve(law.problem));
    CHECK(!ClassicalDp(100).solve(law.problem));
  }
  SUBCASE("above the cap") {
    law.problem.end_u_s = 900.0;
    REQUIRE(check_problem(law.problem));
    CHECK(check_problem(law.problem)->node == 892);
  }
  SUBCASE("levels too coarse") {
    const LawResult found = ClassicalDp(3).solve(law.problem);
    REQUIRE(!found);
    CHECK(found.error().node > 0);
  }
  SUBCASE("nodes that do not ascend") {
    law.problem.s_u[400] = law.problem.s_u[399];
    REQUIRE(check_problem(law.problem));
    CHECK(check_problem(law.problem)->node == 400);
  }
  SUBCASE("not a number") {
    law.problem.curvature[7 * 10 + 3] = std::nan("");
    CHECK(check_problem(law.problem)->node == 10);
    law.problem.curvature[7 * 10 + 3] = 0;
    law.problem.max_accel_u_s2[2] = std::nan("");
    CHECK(check_problem(law.problem));
  }
  SUBCASE("the jerk-limited law with a speed at an end") {
    law.problem.begin_u_s = 10.0;
    CHECK(!JerkLimitedLaw(2e4).solve(law.problem));
  }
}

TEST_CASE("a jerk limit: times by limit, kept at every node, never faster than without") {
  const ReferenceLaw law = paper_law();
  const std::vector<std::pair<double, double>> cases = {{1e5, 5.8668}, {5e4, 5.8725}, {2e4, 5.9276},
                                                        {1e4, 6.0533}, {5e3, 6.2610}, {2e3, 6.8950}};
  for (const auto& [jerk, time] : cases) {
    const LawResult found = JerkLimitedLaw(jerk).solve(law.problem);
    REQUIRE(found);
    check_law(law.problem, *found, "jerk-limited");
    CHECK(node_jerk_u_s3(law.problem, found->speed_u_s) <= jerk * (1.0 + 1e-6));
    CHECK(found->time_s <= time * 1.001);
    CHECK(found->cost_s >= 5.92487);
  }
  const LawResult free = GreedyOptimum().solve(law.problem);
  REQUIRE(free);
  CHECK(node_jerk_u_s3(law.problem, free->speed_u_s) > 1e5);  // the limit is seen to be broken without it
}
