#include <doctest/doctest.h>

#include <vector>

#include "gcode/block.h"
#include "planner_support.h"

namespace kadr::test {
namespace {

using planner::Path;
using planner::SegmentKind;

std::vector<double> position(const Path& path, std::size_t i, double s) {
  std::vector<double> p(static_cast<std::size_t>(path.axes()));
  planner::eval_position(path, i, s, p);
  return p;
}
auto tangent(const Path& path, std::size_t i, double s) { return JointPlace(path, i, s).d1; }

}  // namespace

TEST_CASE("a line of 3 4 12 mm is 13 mm long and its tangent is 3/13 4/13 12/13") {
  const auto machine = plain_machine();
  ProgramWriter w(machine);
  w.line(xyz(3, 4, 12), 10.0);
  const Path path = w.take();
  REQUIRE(path.size() == 1);
  CHECK(path.length_u() == 13.0);
  CHECK(tangent(path, 0, 5.0)[2] == doctest::Approx(12.0 / 13.0).epsilon(1e-15));
  CHECK(position(path, 0, 6.5)[1] == doctest::Approx(2.0).epsilon(1e-15));
}

TEST_CASE("a quarter circle of radius 20 is 10 pi long, passes the 45 degree point and turns its tangent") {
  const auto machine = plain_machine();
  ProgramWriter w(machine, xyz(20, 0));
  w.arc(gcode::Plane::xy, 0.0, 0.0, 1, xyz(0, 20), 10.0);
  const Path path = w.take();
  REQUIRE(path.segments[0].kind == SegmentKind::arc);
  const double length = 10.0 * kPi;
  CHECK(path.length_u() == doctest::Approx(length).epsilon(1e-15));
  CHECK(position(path, 0, 0.5 * length)[0] == doctest::Approx(20.0 * std::sqrt(0.5)).epsilon(1e-14));
  CHECK(tangent(path, 0, 0.0)[1] == doctest::Approx(1.0));
  CHECK(tangent(path, 0, length)[0] == doctest::Approx(-1.0));
  CHECK(JointPlace(path, 0, 0.0).d2[0] == doctest::Approx(-1.0 / 20.0));
}

TEST_CASE("clockwise in the ZX plane runs from +Z to -X by way of the programmed side") {
  // G18 G2: first axis Z, second X; clockwise from Z to X is the way through -X
  const auto machine = plain_machine();
  ProgramWriter w(machine, xyz(0, 0, 5));
  w.arc(gcode::Plane::zx, 0.0, 0.0, -1, xyz(-5, 0, 0), 10.0);
  const Path path = w.take();
  CHECK(path.length_u() == doctest::Approx(2.5 * kPi));
  const auto middle = position(path, 0, 0.5 * path.length_u());
  CHECK(middle[0] == doctest::Approx(-5.0 * std::sqrt(0.5)));
  CHECK(middle[2] == doctest::Approx(5.0 * std::sqrt(0.5)));
}

TEST_CASE(
    "an end equal to the start is a full circle, three turns are three circles, and a helix adds its rise") {
  const auto machine = plain_machine();
  ProgramWriter w(machine, xyz(10, 0));
  w.arc(gcode::Plane::xy, 0.0, 0.0, -1, xyz(10, 0), 10.0);
  w.arc(gcode::Plane::xy, 0.0, 0.0, 3, xyz(10, 0, 40), 10.0);
  const Path path = w.take();
  CHECK(path.segments[0].length_u == doctest::Approx(20.0 * kPi));
  CHECK(path.arcs[0].sweep_rad == doctest::Approx(-2.0 * kPi));
  const double circles = 60.0 * kPi;
  CHECK(path.segments[1].length_u == doctest::Approx(std::sqrt(circles * circles + 1600.0)));
  CHECK(position(path, 1, 0.5 * path.segments[1].length_u)[0] == doctest::Approx(-10.0));
  CHECK(position(path, 1, 0.5 * path.segments[1].length_u)[2] == doctest::Approx(20.0));
}

TEST_CASE("an end that misses the start by rounding is a full circle if the reader measured one") {
  const auto machine = plain_machine();
  // counter-clockwise: 1e-13 beyond the start may be a full turn or none, 1e-13 before it is one anyway
  for (const double miss : {1e-13, -1e-13}) {
    for (const double told : {20.0 * kPi, 1e-13}) {
      if (miss < 0.0 && told < 1.0) continue;
      planner::PathBuilder builder(machine, xyz(10, 0));
      gcode::Arc b;
      b.turns = 1;
      b.end = xyz(10, miss);
      b.length_u = told;
      b.feed_u_s = 10.0;
      builder.add({{}, b});
      CHECK(builder.path().length_u() == doctest::Approx(told).epsilon(1e-2));
    }
  }
}

TEST_CASE("evaluation at both ends gives the nodes to the bit, also on arcs rounded by the program") {
  const auto machine = plain_machine();
  ProgramWriter w(machine, xyz(7.07107, 7.07107, 1));
  w.arc(gcode::Plane::xy, 0.0, 0.0, 2, xyz(-9.99, 0.0, 2.1), 10.0);
  w.line(xyz(-9.99, 1.0 / 3.0, 2.1), 10.0);
  const Path path = w.take();
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto begin = position(path, i, 0.0);
    const auto end = position(path, i, path.segments[i].length_u);
    for (std::size_t j = 0; j < 3; ++j) {
      CHECK(begin[j] == path.node(i)[j]);
      CHECK(end[j] == path.node(i + 1)[j]);
    }
  }
  // the radius runs linearly: after half of the sweep it is the mean
  const auto& arc = path.arcs[0];
  CHECK(arc.radius_begin_u == doctest::Approx(10.0).epsilon(1e-5));
  CHECK(arc.radius_end_u == doctest::Approx(9.99));
  const auto p = position(path, 0, 0.5 * path.segments[0].length_u);
  CHECK(std::sqrt(p[0] * p[0] + p[1] * p[1]) == doctest::Approx(9.995).epsilon(1e-6));
}

TEST_CASE("the extent of an arc includes the points where an axis turns round") {
  const auto machine = plain_machine();
  ProgramWriter w(machine, xyz(6, 8));
  w.arc(gcode::Plane::xy, 0.0, 0.0, 1, xyz(-6, -8, 3), 10.0);
  const Path path = w.take();
  CHECK(planner::axis_extent(path, 0, 1).second == doctest::Approx(10.0));
  CHECK(planner::axis_extent(path, 0, 1).first == doctest::Approx(-8.0));
  CHECK(planner::axis_extent(path, 0, 0).first == doctest::Approx(-10.0));
  CHECK(planner::axis_extent(path, 0, 0).second == doctest::Approx(6.0));
  CHECK(planner::axis_extent(path, 0, 2).second == doctest::Approx(3.0));
}

TEST_CASE("an axis extent holds every point of random arcs and is reached by one of them") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const auto machine = plain_machine();
    const double r = random.between(1.0, 30.0), turn = random.between(0.0, 2.0 * kPi);
    const SinCos a = exact_sincos(turn), b = exact_sincos(random.between(0.0, 2.0 * kPi));
    ProgramWriter w(machine, xyz(r * a.cos, r * a.sin));
    const double r1 = r * random.between(0.95, 1.05);
    w.arc(gcode::Plane::xy, 0.0, 0.0, random.chance(0.5) ? 2 : -1, xyz(r1 * b.cos, r1 * b.sin), 10.0);
    const Path path = w.take();
    for (int axis = 0; axis < 2; ++axis) {
      const auto [low, high] = planner::axis_extent(path, 0, axis);
      double seen_low = 1e9, seen_high = -1e9;
      for (int i = 0; i <= 2000; ++i) {
        const double x = position(path, 0, path.length_u() * i / 2000.0)[static_cast<std::size_t>(axis)];
        seen_low = std::min(seen_low, x);
        seen_high = std::max(seen_high, x);
      }
      CHECK(seen_low >= low - 1e-9);
      CHECK(seen_high <= high + 1e-9);
      CHECK(seen_low == doctest::Approx(low).epsilon(1e-4));
      CHECK(seen_high == doctest::Approx(high).epsilon(1e-4));
    }
  }
}

TEST_CASE(
    "a move of zero length adds no segment, and one too short to count still ends where the program says") {
  const auto machine = plain_machine();
  ProgramWriter w(machine);
  w.line(xyz(0, 0), 10.0);
  w.line(xyz(1000, 0), 10.0);
  w.line(xyz(1000, 1e-14), 10.0);
  w.line(xyz(1000, 1e-14), 10.0);
  const Path path = w.take();
  CHECK(path.size() == 1);
  CHECK(path.node(1)[1] == 1e-14);
}

TEST_CASE("F measures X Y Z only: 3 mm and 4 degrees at 6 mm/s is a speed of 10 along s") {
  const auto machine = plain_machine("XYZA");
  ProgramWriter w(machine);
  w.line({3, 0, 0, 4, 0, 0, 0, 0, 0}, 6.0);
  w.line({3, 0, 0, 44, 0, 0, 0, 0, 0}, 20.0);  // degrees alone: F is deg/s
  w.timed_line({3, 10, 0, 44, 0, 0, 0, 0, 0}, 4.0);
  const Path path = w.take();
  CHECK(path.segments[0].length_u == 5.0);
  CHECK(path.segments[0].feed_u_s == doctest::Approx(10.0));
  CHECK(path.segments[0].path_limits);
  CHECK(path.segments[1].feed_u_s == doctest::Approx(20.0));
  CHECK_FALSE(path.segments[1].path_limits);
  CHECK(path.segments[2].feed_u_s == doctest::Approx(2.5));
}

}  // namespace kadr::test
