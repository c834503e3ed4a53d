#include <doctest/doctest.h>

#include <cmath>

#include "planner/time_law/certified.h"
#include "planner/time_law/greedy.h"
#include "planner/time_law/interior_point.h"
#include "planner/time_law/jerk_limited.h"
#include "planner/time_law/metrics.h"
#include "planner/time_law/tube.h"
#include "reference_law.h"

using namespace kadr;
using namespace kadr::planner;

namespace {

LawSolution solved(LawSolver& solver, const LawProblem& problem) {
  REQUIRE(!check_problem(problem));
  LawResult out = solver.solve(problem);
  if (!out) FAIL(std::string(solver.name()), " at node ", out.error().node, ": ", out.error().reason);
  const LawCheck check = verify_law(problem, *out);
  for (const LawViolation& b : check.broken)
    FAIL_CHECK(std::string(solver.name()), ": ", b.what, " at ", b.s_u, ": ", b.value, " > ", b.limit);
  return *out;
}

}  // namespace

TEST_CASE(
    "the reference path is the one that was measured: values at s = 1000, sum of caps, what holds them") {
  const ReferenceLaw law = paper_law();
  CHECK(eval(law.axes[0], 1000.0, 2846.9).value == doctest::Approx(-0.364797035).epsilon(1e-8));
  CHECK(eval(law.axes[0], 1000.0, 2846.9).slope == doctest::Approx(2.1194368e-4).epsilon(1e-7));
  CHECK(eval(law.axes[0], 1000.0, 2846.9).curvature == doctest::Approx(1.52630165e-8).epsilon(1e-7));
  CHECK(eval(law.axes[5], 1000.0, 2846.9).value == doctest::Approx(0.905684082).epsilon(1e-8));
  CHECK(eval(law.axes[5], 1000.0, 2846.9).slope == doctest::Approx(1.19942504e-3).epsilon(1e-7));
  CHECK(eval(law.axes[5], 1000.0, 2846.9).curvature == doctest::Approx(-4.62952344e-7).epsilon(1e-7));
  CHECK(eval(law.axes[6], 1000.0, 2846.9).slope == doctest::Approx(0.319022163).epsilon(1e-8));
  double sum = 0;
  std::array<int, 7> axes{};
  int zones = 0;
  for (const NodeCap& c : node_caps(law.problem)) {
    sum += c.speed_u_s;
    if (c.reason >= 0) ++axes[static_cast<std::size_t>(c.reason)];
    if (c.reason == NodeCap::kZone) ++zones;
  }
  CHECK(sum == doctest::Approx(664016.456).epsilon(1e-9));
  CHECK(axes[0] == 47);
  CHECK(axes[1] == 65);
  CHECK(axes[2] == 42);
  CHECK(zones == 4);
}

TEST_CASE("the tube as in the paper: 15 passes with the measured times, half widths and touches") {
  const ReferenceLaw law = paper_law();
  TubeDp tube;
  const LawSolution found = solved(tube, law.problem);
  const std::vector<double> times = {8.7463, 7.6564, 6.9761, 6.5257, 6.2602, 6.1334, 6.0868, 6.0604,
                                     6.0632, 5.9582, 5.9578, 5.9140, 5.8901, 5.8896, 5.8779};
  REQUIRE(tube.passes().size() == times.size());
  for (std::size_t i = 0; i < times.size(); ++i) CHECK(std::fabs(tube.passes()[i].time_s - times[i]) <= 1e-4);
  CHECK(found.time_s == doctest::Approx(5.8779).epsilon(1e-5));
  CHECK(found.cost_s == doctest::Approx(5.93560).epsilon(1e-5));
  CHECK(tube.passes().back().half_width_u_s == doctest::Approx(3.40909).epsilon(1e-5));
  CHECK(!tube.capped());
}

TEST_CASE("classical levels over the whole range") {
  const ReferenceLaw law = paper_law();
  ClassicalDp coarse(100), fine(1100);
  CHECK(std::fabs(solved(coarse, law.problem).time_s - 8.7463) <= 1e-4);
  const LawSolution found = solved(fine, law.problem);
  CHECK(std::fabs(found.time_s - 5.9828) <= 1e-4);
  CHECK(std::fabs(found.cost_s - 6.03620) <= 1e-4);
}

TEST_CASE("the time optimum: end nodes, both nodes, start nodes by reversing the path") {
  ReferenceLaw law = paper_law();
  GreedyOptimum greedy;
  CHECK(std::fabs(solved(greedy, law.problem).time_s - 5.866147) <= 1e-5);
  law.problem.accel_test = AccelTest::both_nodes;
  CHECK(std::fabs(solved(greedy, law.problem).time_s - 5.880580) <= 1e-5);
}

TEST_CASE("the optimum of the cost has a certificate to 1e-7") {
  const ReferenceLaw law = paper_law();
  InteriorPointOptimum optimum;
  const LawSolution found = solved(optimum, law.problem);
  MESSAGE("steps ", found.iterations);
  CHECK(std::fabs(found.cost_s - 5.924880) <= 1e-5);
  CHECK(std::fabs(found.lower_bound_s - 5.924880) <= 1e-5);
  CHECK(found.cost_s - found.lower_bound_s <= 1e-7 * found.cost_s);
}

TEST_CASE("the certified law is within 1e-5 of its bound") {
  const ReferenceLaw law = paper_law();
  CertifiedLaw certified;
  const LawSolution found = solved(certified, law.problem);
  CHECK(found.cost_s / found.lower_bound_s - 1.0 <= 1e-5);
}

TEST_CASE("a jerk limit of 2e4 costs one per cent of time") {
  const ReferenceLaw law = paper_law();
  JerkLimitedLaw limited(2e4);
  const LawSolution found = solved(limited, law.problem);
  MESSAGE("T ", found.time_s, " steps ", found.iterations, " tangents ", limited.tangents());
  CHECK(found.time_s <= 5.94);
  CHECK(node_jerk_u_s3(law.problem, found.speed_u_s) <= 2e4 * (1.0 + 1e-6));
}
