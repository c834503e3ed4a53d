#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gcode/block.h"
#include "machine/machine.h"
#include "planner/path/spline_arcs.h"
#include "planner_support.h"

namespace kadr::test {
namespace {

using planner::Path;
using planner::PathSegment;
using planner::SegmentKind;

struct Point {
  double x = 0, y = 0;
};
double apart(Point a, Point b) { return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)); }

/// The curve by the definition: basis functions of Cox and de Boor, nothing of the product.
Point on_curve(const std::vector<gcode::SplinePoint>& points, int order, double u) {
  const int n = static_cast<int>(points.size());
  const auto knot = [&](int i) { return std::clamp(i - order + 1, 0, n - order + 1); };
  std::vector<double> basis(static_cast<std::size_t>(n + order - 1));
  int span = order - 1;
  while (span < n - 1 && u >= knot(span + 1)) ++span;
  basis[static_cast<std::size_t>(span)] = 1;
  for (int k = 2; k <= order; ++k) {
    for (int i = 0; i + k < n + order; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double left = knot(i + k - 1) - knot(i), right = knot(i + k) - knot(i + 1);
      const double next = at + 1 < basis.size() ? basis[at + 1] : 0.0;
      basis[at] = (left > 0 ? (u - knot(i)) / left * basis[at] : 0.0) +
                  (right > 0 ? (knot(i + k) - u) / right * next : 0.0);
    }
  }
  double w = 0, x = 0, y = 0;
  for (int i = 0; i < n; ++i) {
    const gcode::SplinePoint& p = points[static_cast<std::size_t>(i)];
    const double b = basis[static_cast<std::size_t>(i)] * p.weight;
    w += b, x += b * p.x_mm, y += b * p.y_mm;
  }
  return {x / w, y / w};
}

gcode::Spline spline_block(std::vector<gcode::SplinePoint> points, int order, double feed_u_s) {
  gcode::Spline b;
  b.order = order;
  b.end = xyz(points.back().x_mm, points.back().y_mm);
  b.feed_u_s = feed_u_s;
  b.control_points = std::move(points);
  return b;
}

Path spline_path(const machine::MachineModel& machine, const gcode::Spline& block) {
  planner::PathBuilder builder(machine, xyz(block.control_points[0].x_mm, block.control_points[0].y_mm));
  builder.add({{0, 7, 1, 4}, block});
  return builder.take();
}

std::vector<Point> samples_of(const Path& path, int per_segment) {
  std::vector<Point> points;
  std::vector<double> at(static_cast<std::size_t>(path.axes()));
  for (std::size_t i = 0; i < path.size(); ++i) {
    for (int k = 0; k < per_segment; ++k) {
      planner::eval_position(path, i, path.segments[i].length_u * k / per_segment, at);
      points.push_back({at[0], at[1]});
    }
  }
  points.push_back({path.node(path.size())[0], path.node(path.size())[1]});
  return points;
}

double distance_to_chords(Point p, const std::vector<Point>& line) {
  double least = 1e300;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Point a = line[i], b = line[i + 1];
    const double x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
    double u = square > 0 ? ((p.x - a.x) * x + (p.y - a.y) * y) / square : 0;
    u = std::clamp(u, 0.0, 1.0);
    least = std::min(least, apart(p, {a.x + u * x, a.y + u * y}));
  }
  return least;
}

/// The largest distance between curve and path, either way; chords of the curve cost at most 1e-5 mm here.
double deviation_mm(const gcode::Spline& block, const Path& path) {
  std::vector<Point> curve;
  const double end = static_cast<double>(static_cast<int>(block.control_points.size()) - block.order + 1);
  for (int i = 0; i <= 3000; ++i)
    curve.push_back(on_curve(block.control_points, block.order, end * i / 3000));
  const std::vector<Point> followed = samples_of(path, 24);
  double worst = 0;
  for (const Point& p : followed) worst = std::max(worst, distance_to_chords(p, curve));
  for (std::size_t i = 0; i < curve.size(); i += 6)
    worst = std::max(worst, distance_to_chords(curve[i], followed));
  return worst;
}

}  // namespace

TEST_CASE("a path along random splines stays within a micrometre of them and ends where they end") {
  const auto machine = plain_machine();
  Random random(environment("KADR_SEED", 1));
  const std::uint64_t count = environment("KADR_COUNT", 12);
  double worst = 0;
  for (std::uint64_t run = 0; run < count; ++run) {
    const int order = 3 + random.below(3);
    std::vector<gcode::SplinePoint> points;
    const int n = order + random.below(4);
    for (int i = 0; i < n; ++i)
      points.push_back({random.between(-10, 10), random.between(-10, 10), random.decades(0.3, 3)});
    const gcode::Spline block = spline_block(points, order, 20);
    const Path path = spline_path(machine, block);
    CAPTURE(run);
    REQUIRE(path.size() > 0);
    const double off = deviation_mm(block, path);
    worst = std::max(worst, off);
    CHECK(off < planner::kSplineDeviation_mm + 1e-5);
    CHECK(path.node(path.size())[0] == block.end[0]);
    CHECK(path.node(path.size())[1] == block.end[1]);
    // all of it is one block, at the place of the program
    for (const PathSegment& s : path.segments) {
      CHECK(s.block == 0);
      CHECK(s.span.line == 7);
      CHECK(s.feed_u_s == 20);
    }
    CHECK(path.block_end(0) == path.size());
  }
  MESSAGE("largest deviation ", worst * 1000, " um");
}

TEST_CASE("G64 with a tolerance follows a spline with fewer arcs, and stays within the tolerance") {
  const auto machine = plain_machine();
  gcode::Spline block = spline_block({{0, 0, 1}, {0, 30, 2}, {40, -30, 1}, {40, 0, 1}}, 4, 20);
  const std::size_t fine = spline_path(machine, block).size();
  block.path_tolerance_mm = 0.05;
  const Path path = spline_path(machine, block);
  CHECK(path.size() < fine);
  CHECK(deviation_mm(block, path) < 0.05 + 1e-4);
}

TEST_CASE("the arcs along a smooth spline join without a corner, and the plan keeps every limit") {
  const auto machine = plain_machine();
  const gcode::Spline block = spline_block({{0, 0, 1}, {0, 30, 2}, {40, -30, 1}, {40, 0, 1}}, 4, 100);
  const Path path = spline_path(machine, block);
  for (std::size_t i = 1; i < path.size(); ++i) {
    const auto end = JointPlace(path, i - 1, path.segments[i - 1].length_u).d1;
    const auto begin = JointPlace(path, i, 0).d1;
    CHECK(std::fabs(end[0] - begin[0]) < 1e-7);
    CHECK(std::fabs(end[1] - begin[1]) < 1e-7);
  }
  const auto plan = planner::plan(path, machine);
  REQUIRE(plan);
  CHECK(planner::verify(path, *plan, machine).empty());
}

TEST_CASE("the feed on a tight spline is bounded by its curvature") {
  // the parabola y = x^2 / 2 has radius 1 at its vertex: v <= sqrt(2000 * 1) = 44.7 mm/s there,
  // on the parts that meet there
  auto machine = plain_machine();
  machine.path.centripetal_accel_mm_s2 = 2000;
  for (auto& axis : machine.axis)
    axis.max_accel_u_s2 = 4000, axis.max_jerk_u_s3 = 1e9, axis.junction_accel_u_s2 = 1e6;
  const gcode::Spline block = spline_block({{-20, 200, 1}, {0, -200, 1}, {20, 200, 1}}, 3, 100);
  const Path path = spline_path(machine, block);
  const auto plan = planner::plan(path, machine);
  REQUIRE(plan);
  double least = 1e9;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path.node(i)[0] <= 0 && path.node(i + 1)[0] >= 0) least = std::min(least, plan->segments[i].peak_u_s);
  CHECK(least <= 1.01 * std::sqrt(2000.0));
  CHECK(least >= 0.95 * std::sqrt(2000.0));
}

TEST_CASE("splines that degenerate to a line, a point or a cusp make path") {
  const auto machine = plain_machine();
  // all points on a line, there and back over the end
  const Path line = spline_path(machine, spline_block({{0, 0, 1}, {15, 0, 1}, {10, 0, 1}}, 3, 20));
  CHECK(line.length_u() == doctest::Approx(11.25 + 1.25).epsilon(1e-4));  // x = 30 u - 20 u^2: 11.25 at 3/4
  const Path point = spline_path(machine, spline_block({{5, 5, 1}, {5, 5, 1}, {5, 5, 1}}, 3, 20));
  CHECK(point.size() == 0);
  const gcode::Spline cusp = spline_block({{0, 0, 1}, {10, 10, 1}, {0, 10, 1}, {10, 0, 1}}, 4, 20);
  const Path tip = spline_path(machine, cusp);
  CHECK(deviation_mm(cusp, tip) < planner::kSplineDeviation_mm + 1e-5);
  CHECK(tip.size() < 2000);
  // control points on the ends: no velocity there
  const gcode::Spline rest = spline_block({{0, 0, 1}, {0, 0, 1}, {10, 5, 1}, {10, 5, 1}}, 4, 20);
  CHECK(spline_path(machine, rest).size() <= 2);
}

TEST_CASE("a spline under G93 takes its time whatever its arcs add up to") {
  const auto machine = plain_machine();
  gcode::Spline block = spline_block({{0, 0, 1}, {0, 3, 1}, {4, -3, 1}, {4, 0, 1}}, 4, 0);
  block.duration_s = 8;
  const Path path = spline_path(machine, block);
  CHECK(path.length_u() / path.segments[0].feed_u_s == doctest::Approx(8));
}

TEST_CASE("a probing move ends at rest at its contact, and the next move starts there") {
  const auto machine = plain_machine();
  planner::PathBuilder builder(machine, {});
  gcode::Probe probe;
  probe.end = xyz(0, 0, -20);
  probe.contact = xyz(0, 0, -7.5);
  probe.length_u = 7.5;
  probe.feed_u_s = 5;
  builder.add({{}, probe});
  gcode::Traverse up;
  up.end = xyz(0, 0, 2.5);
  builder.add({{}, up});
  const Path path = builder.take();
  REQUIRE(path.size() == 2);
  CHECK(path.segments[0].length_u == 7.5);
  CHECK(path.segments[0].feed_u_s == 5);
  CHECK(path.segments[0].stop_at_end);
  CHECK(path.segments[1].length_u == 10);
  CHECK(planner::motion_name(path.segments[0]) == "probe");
}

TEST_CASE("a tap goes to its end and back, at rest between, as one block") {
  const auto machine = plain_machine();
  planner::PathBuilder builder(machine, xyz(1, 2, 5));
  gcode::RigidTap tap;
  tap.end = xyz(1, 2, -15);
  tap.length_u = 20;
  tap.pitch_u_rev = 1.25;
  tap.feed_u_s = 10;
  builder.add({{}, tap});
  const Path path = builder.take();
  REQUIRE(path.size() == 2);
  CHECK(path.node(1)[2] == -15);
  CHECK(path.node(2)[2] == 5);
  CHECK(path.segments[0].stop_at_end);
  CHECK(path.segments[1].stop_at_end);
  CHECK(path.segments[0].block == path.segments[1].block);
  const auto plan = planner::plan(path, machine);
  REQUIRE(plan);
  CHECK(plan->segments[0].end_u_s == 0);
}

TEST_CASE("the times of parts of a program add up to that of the whole, to the tick") {
  auto machine = plain_machine();
  machine.planner.whole_ticks = true;
  Random random(environment("KADR_SEED", 1) + 7);
  AxisValues end{};
  for (int run = 0; run < 20; ++run) {
    Path path = random_path(random, machine, end);
    if (path.size() < 4) continue;
    const std::size_t cut = path.size() / 2;
    path.segments[cut - 1].stop_at_end = true;
    const auto plan = planner::plan(path, machine);
    REQUIRE(plan);
    const auto rest = planner::motion_time_s(path, machine, cut);
    REQUIRE(rest);
    const double tau = machine.clock.tau_s();
    CHECK(std::lround(plan->segments[cut - 1].end_time_s / tau) + std::lround(*rest / tau) ==
          std::lround(plan->law.duration_s / tau));
  }
}

}  // namespace kadr::test
