#include <doctest/doctest.h>

#include <cmath>

#include "machine/machine.h"
#include "planner/time_law/greedy.h"
#include "planner/time_law/spline_fit.h"
#include "planner_support.h"

namespace kadr::test {

using namespace kadr::planner;

namespace {

constexpr double kRadius_mm = 50.0;

/// A circle of radius 50 by n chords, from (50, 0) counter-clockwise.
Path chords(const machine::MachineModel& machine, int n, double feed_mm_s) {
  ProgramWriter program(machine, xyz(kRadius_mm));
  for (int i = 1; i <= n; ++i) {
    const SinCos at = exact_sincos(2.0 * kPi * i / n);
    program.line(xyz(kRadius_mm * at.cos, kRadius_mm * at.sin), feed_mm_s);
  }
  return program.take();
}

Run all_of(const Path& path) { return {0, path.size() - 1}; }

/// Largest |X''| of a path's ends and joints, against the circle's 1/R.
double curvature_error(const SplineFit& fit, std::size_t first_row, std::size_t last_row) {
  double worst = 0.0;
  for (std::size_t row = first_row; row <= last_row; ++row) {
    const double x = fit.path.eval(0, fit.path.row_u(row)).curvature;
    const double y = fit.path.eval(1, fit.path.row_u(row)).curvature;
    worst = std::max(worst, std::fabs(std::sqrt(x * x + y * y) * kRadius_mm - 1.0));
  }
  return worst;
}

}  // namespace

TEST_CASE("a spline through the points of a circle is the circle: distance, length, curvature") {
  // 120 chords of 3 degrees: the arc is R (1 - cos 1.5 degrees) = 0.017134 mm from the middle of its chord,
  // and longer than it by 1/sinc(1.5 degrees) - 1 = 1.1424e-4
  const machine::MachineModel machine = trapezoid_machine("XY");
  const Path path = chords(machine, 120, 100.0);
  const SplineFit fit = fit_spline(path, all_of(path), SplineEnds::not_a_knot);
  CHECK(fit.path.rows() == 121);
  CHECK(fit.deviation_u == doctest::Approx(0.0171337).epsilon(1e-3));
  CHECK(fit.most_slope == doctest::Approx(1.0 + 1.1424e-4).epsilon(1e-5));
  CHECK(fit.least_slope > 1.0);
  // a spline's X'' is off by (k ds)^2/12 of it, k ds = 3 degrees: 2.3e-4; |X'|^2 = 1 + 2.3e-4 of chord length as much
  CHECK(curvature_error(fit, 10, 110) < 1e-3);
  CHECK(curvature_error(fit, 0, 120) <
        3e-3);  // not a knot: of the same order at the ends, and some times as much
}

TEST_CASE(
    "natural ends say X'' = 0, clamped ones keep the chord's direction, and inner rows are as with neither") {
  const machine::MachineModel machine = trapezoid_machine("XY");
  const Path path = chords(machine, 120, 100.0);
  const SplineFit natural = fit_spline(path, all_of(path), SplineEnds::natural);
  for (const std::size_t axis : {0u, 1u}) {
    CHECK(natural.path.eval(axis, 0.0).curvature == 0.0);
    CHECK(natural.path.eval(axis, natural.path.end_u()).curvature == 0.0);
  }
  const SplineFit clamped = fit_spline(path, all_of(path), SplineEnds::clamped);
  for (const std::size_t axis : {0u, 1u}) {
    const double h = clamped.path.row_u(1);
    CHECK(clamped.path.eval(axis, 0.0).slope ==
          doctest::Approx((path.node(1)[axis] - path.node(0)[axis]) / h).epsilon(1e-9));
    const double last = clamped.path.end_u() - clamped.path.row_u(119);
    CHECK(clamped.path.eval(axis, clamped.path.end_u()).slope ==
          doctest::Approx((path.node(120)[axis] - path.node(119)[axis]) / last).epsilon(1e-9));
  }
  // the error of an end decays by 2 - sqrt 3 = 0.27 per row: 1e-6 of it after 10 rows
  CHECK(curvature_error(natural, 15, 105) < 1e-3);
  CHECK(curvature_error(clamped, 15, 105) < 1e-3);
  CHECK(curvature_error(natural, 0, 0) == doctest::Approx(1.0));  // the check sees it
  CHECK(curvature_error(clamped, 1, 1) > 0.1);
}

TEST_CASE("points on a straight line give that line") {
  const machine::MachineModel machine = trapezoid_machine("XYZ");
  ProgramWriter program(machine);
  for (const double x : {1.0, 1.5, 4.0, 9.0, 9.1, 20.0}) program.line(xyz(3 * x, 4 * x), 50.0);
  const Path path = program.take();
  for (const SplineEnds ends : {SplineEnds::not_a_knot, SplineEnds::natural, SplineEnds::clamped}) {
    const SplineFit fit = fit_spline(path, all_of(path), ends);
    CHECK(fit.deviation_u <= 1e-12);
    CHECK(fit.least_slope == doctest::Approx(1.0).epsilon(1e-12));
    CHECK(fit.most_slope == doctest::Approx(1.0).epsilon(1e-12));
  }
}

TEST_CASE("at a corner the distance is found where it is, as fine sampling finds it") {
  const machine::MachineModel machine = trapezoid_machine("XY");
  ProgramWriter program(machine);
  for (int i = 1; i <= 10; ++i) program.line(xyz(i), 50.0);
  for (int i = 1; i <= 10; ++i) program.line(xyz(10, i), 50.0);
  const Path path = program.take();
  const SplineFit fit = fit_spline(path, all_of(path), SplineEnds::natural);
  double worst = 0.0, at = 0.0;
  for (int i = 0; i <= 200'000; ++i) {
    const double s = 20.0 * i / 200'000;
    const double x = fit.path.eval(0, s).value, y = fit.path.eval(1, s).value;
    // from the two legs, which are longer than the curve is wide
    const double off_first = std::hypot(std::max(x - 10.0, 0.0), y);
    const double off_second = std::hypot(x - 10.0, std::min(y, 0.0));
    const double d = s <= 10.0 ? off_first : off_second;
    if (d > worst) worst = d, at = s;
  }
  CHECK(worst > 0.05);
  CHECK(fit.deviation_u == doctest::Approx(worst).epsilon(1e-8));
  // the corner is its own mirror image: either side of it will do
  CHECK(std::fabs(std::fabs(fit.deviation_s_u - 10.0) - std::fabs(at - 10.0)) < 1e-3);
  CHECK((fit.segment == 9 || fit.segment == 10));
}

TEST_CASE("a law along the spline of a circle has the time of the circle by hand") {
  // R = 50, A = 2000: an axis that turns at full speed v needs v^2/R <= 2000, v <= 316; F 100 and 110 mm/s an
  // axis hold it at 100. From 0 to 100 mm/s: with tangential a, both parts in an axis at worst sqrt(a^2 +
  // (v^2/R)^2) <= 2000, so a is between sqrt(2000^2 - 200^2) = 1990 and 2000 sqrt 2; a ramp lasts 100/2828 to
  // 100/1990 s, and costs half of it.
  const machine::MachineModel machine = trapezoid_machine("XY");
  const Path path = chords(machine, 720, 100.0);
  const SplineFit fit = fit_spline(path, all_of(path), SplineEnds::not_a_knot);
  LawProblem problem;
  std::vector<Signature> held_by;
  state_fit(fit, path, all_of(path), machine, {}, problem, held_by);
  REQUIRE(!check_problem(problem));
  REQUIRE(held_by.size() == problem.nodes());
  const LawResult law = GreedyOptimum().solve(problem);
  REQUIRE(law);
  const double cruise_s = 2.0 * kPi * kRadius_mm / 100.0;
  CHECK(law->time_s >= cruise_s + 100.0 / 2829.0);
  CHECK(law->time_s <= cruise_s + 100.0 / 1990.0);
  CHECK(held_by[300].reason == LimitedBy::program);
  // speed along the curve, not along the chords
  const double slope = std::hypot(problem.slopes(300)[0], problem.slopes(300)[1]);
  CHECK(problem.cap_u_s[300] * slope == doctest::Approx(100.0).epsilon(1e-12));

  // even nodes: the same law to what nodes matter
  LawProblem even;
  state_fit(fit, path, all_of(path), machine, std::size_t{1001}, even, held_by);
  CHECK(even.nodes() == 1001);
  const LawResult other = GreedyOptimum().solve(even);
  REQUIRE(other);
  CHECK(other->time_s == doctest::Approx(law->time_s).epsilon(1e-3));
}

TEST_CASE("the machine's path limits and technology points hold along a spline") {
  machine::MachineModel machine = trapezoid_machine("XYZ");
  machine.path.max_feed_mm_s = 80.0;
  machine.path.max_accel_mm_s2 = 300.0;
  machine.path.centripetal_accel_mm_s2 = 50.0;  // v = sqrt(50 * 50) = 50 mm/s
  const Path path = chords(machine, 360, 100.0);
  const SplineFit fit = fit_spline(path, all_of(path), SplineEnds::not_a_knot);
  LawProblem problem;
  std::vector<Signature> held_by;
  state_fit(fit, path, all_of(path), machine, {}, problem, held_by);
  CHECK(problem.cap_u_s[100] == doctest::Approx(50.0).epsilon(1e-3));
  CHECK(held_by[100].reason == LimitedBy::centripetal);
  CHECK(problem.interval_accel_u_s2[100] == 300.0);
  machine.path.centripetal_accel_mm_s2 = kInfinity;
  state_fit(fit, path, all_of(path), machine, {}, problem, held_by);
  CHECK(problem.cap_u_s[100] == doctest::Approx(80.0).epsilon(1e-3));
  CHECK(held_by[100].reason == LimitedBy::path_feed);

  ProgramWriter program(machine);
  for (int i = 1; i <= 20; ++i) program.line(xyz(i), 50.0);
  Path marked = program.take();
  marked.segments[7].begin_limit_u_s = 5.0;
  const SplineFit line = fit_spline(marked, all_of(marked), SplineEnds::not_a_knot);
  LawProblem slow;
  state_fit(line, marked, all_of(marked), machine, {}, slow, held_by);
  REQUIRE(slow.zones.size() == 1);
  CHECK(slow.zones[0].begin_u == 7.0);
  CHECK(node_caps(slow)[7].speed_u_s == 5.0);
}

}  // namespace kadr::test
