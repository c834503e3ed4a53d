#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gcode/block.h"
#include "machine/machine.h"
#include "planner/bezier/corner.h"
#include "planner/bezier/point_fit.h"
#include "verified_plan.h"

using namespace kadr;
using namespace kadr::test;
using planner::Path;
using planner::PathCurve;
using planner::SegmentKind;

namespace {

using Points = std::vector<AxisValues>;

gcode::Feed feed_line(const AxisValues& to, double tolerance_mm, double feed_u_s) {
  gcode::Feed b;
  b.end = to;
  b.feed_u_s = feed_u_s;
  b.path_mode = gcode::PathMode::continuous;
  b.path_tolerance_mm = tolerance_mm;
  return b;
}

Path smoothed(const machine::MachineModel& machine, const Points& points, double tolerance_mm,
              double feed_u_s = 100) {
  planner::PathBuilder builder(machine, points[0]);
  for (std::size_t i = 1; i < points.size(); ++i)
    builder.add({{}, feed_line(points[i], tolerance_mm, feed_u_s)});
  return builder.take();
}

/// Largest distance of a path from the programmed lines.
double distance(const Path& path, const Points& points) {
  const auto axes = static_cast<std::size_t>(path.axes());
  std::vector<double> at(axes);
  double worst = 0;
  for (std::size_t i = 0; i < path.size(); ++i)
    for (int k = 0; k <= 20; ++k) {
      planner::eval_position(path, i, path.segments[i].length_u * k / 20, at);
      double least = 1e300;
      for (std::size_t j = 0; j + 1 < points.size(); ++j) {
        double along = 0, length = 0, square = 0;
        for (std::size_t a = 0; a < axes; ++a) {
          const double chord = points[j + 1][a] - points[j][a];
          along += (at[a] - points[j][a]) * chord;
          length += chord * chord;
        }
        const double u = std::clamp(along / length, 0.0, 1.0);
        for (std::size_t a = 0; a < axes; ++a) {
          const double off = at[a] - points[j][a] - u * (points[j + 1][a] - points[j][a]);
          square += off * off;
        }
        least = std::min(least, std::sqrt(square));
      }
      worst = std::max(worst, least);
    }
  return worst;
}

/// Largest jumps of direction and curvature at the joints of a path.
struct Jumps {
  double tangent = 0, curvature = 0;
};
Jumps jumps(const Path& path) {
  const auto axes = static_cast<std::size_t>(path.axes());
  Jumps worst;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const JointPlace a(path, i - 1, path.segments[i - 1].length_u), b(path, i, 0);
    for (std::size_t k = 0; k < axes; ++k) {
      worst.tangent = std::max(worst.tangent, std::fabs(a.d1[k] - b.d1[k]));
      worst.curvature = std::max(worst.curvature, std::fabs(a.d2[k] - b.d2[k]));
    }
  }
  return worst;
}

Points corner(double turn_deg, double length_mm) {
  const SinCos turn = exact_sincos(turn_deg * kPi / 180);
  return {xyz(0), xyz(length_mm), xyz(length_mm + length_mm * turn.cos, length_mm * turn.sin)};
}

Points random_points(Random& random, std::size_t axes, int n) {
  Points points = {{}};
  AxisValues way{};
  for (int i = 0; i < n; ++i) {
    // dense stretches of like directions, and corners
    if (i == 0 || random.chance(0.3))
      for (std::size_t k = 0; k < axes; ++k) way[k] = random.between(-1, 1) * random.decades(0.1, 10);
    AxisValues to = points.back();
    for (std::size_t k = 0; k < axes; ++k) to[k] += way[k] * random.between(0.8, 1.2);
    points.push_back(to);
  }
  return points;
}

}  // namespace

TEST_CASE("rounded corners are those of the table: trim and largest curvature by the deviation") {
  struct Row {
    double turn_deg, trim, curvature;
  };
  // interpolators of paper 002 and corners of degree 5: d/e and k_max e
  for (const Row row : {Row{15, 17.5, 0.0089}, Row{45, 5.77, 0.0850}, Row{90, 2.74, 0.430},
                        Row{120, 1.95, 1.05}, Row{150, 1.41, 3.06}, Row{170, 1.13, 11.5}}) {
    CAPTURE(row.turn_deg);
    const SinCos turn = exact_sincos(row.turn_deg * kPi / 180);
    const std::vector<double> at = {0, 0}, before = {1, 0}, after = {turn.cos, turn.sin};
    const auto rounded = planner::round_corner(at, before, after, 1.0, 1e9);
    REQUIRE(rounded);
    CHECK(rounded->deviation_u == doctest::Approx(1));
    CHECK(rounded->trim_u == doctest::Approx(row.trim).epsilon(0.03));
    const PathCurve curve(rounded->control_u, 2);
    double bend = 0;
    for (int i = 0; i <= 2000; ++i) {
      const auto x = curve.by_length(i / 2000.0);
      bend = std::max(bend, std::hypot(x.d2[0], x.d2[1]));
    }
    CHECK(bend == doctest::Approx(row.curvature).epsilon(0.02));
    // e is the distance from the corner to the middle of the curve
    CHECK(std::hypot(curve.position(0, 0.5), curve.position(1, 0.5)) == doctest::Approx(1).epsilon(1e-12));
  }
}

TEST_CASE("G64 P rounds a corner within P, and the corner is passed at the limit of its curvature") {
  auto machine = trapezoid_machine();
  for (const double turn_deg : {20.0, 60.0, 90.0, 135.0, 170.0}) {
    CAPTURE(turn_deg);
    const Points points = corner(turn_deg, 50);
    const Path path = smoothed(machine, points, 0.05);
    REQUIRE(path.size() == 4);
    CHECK(path.smoothing.corners == 1);
    CHECK(path.smoothing.corner_deviation_u == doctest::Approx(0.05).epsilon(1e-9));
    CHECK(distance(path, points) <= 0.05);
    const Jumps worst = jumps(path);
    CHECK(worst.tangent < 1e-10);
    CHECK(worst.curvature < 1e-8);
    const planner::FeedPlan plan = planned(path, machine);
    // sqrt(0.8 A/kappa), the share of the axes' acceleration that turning gets
    double bend = 0;
    for (int i = 0; i <= 1000; ++i) {
      const auto x = path.curves[0].by_length(i / 1000.0);
      bend = std::max(bend, std::hypot(x.d2[0], x.d2[1]));
    }
    const double limit = std::min(std::sqrt(0.8 * 2000 / bend), 100.0);
    CHECK(plan.segments[1].end_u_s <= limit);
    CHECK(plan.segments[1].end_u_s > 0.97 * limit);
    // the sharp corner allows 2 mm/s of change, which is less
    const Path sharp = smoothed(machine, points, 0);
    CHECK(sharp.size() == 2);
    CHECK(planned(sharp, machine).segments[0].end_u_s < plan.segments[1].end_u_s);
  }
}

TEST_CASE("a corner in five axes keeps its tolerance in each, and gives each block half of it") {
  const auto machine = plain_machine("XYZAB");
  const Points points = {{0, 0, 0, 0, 0}, {20, 5, 0, 30, 0}, {20, 25, 8, 30, -40}};
  const Path path = smoothed(machine, points, 0.1, 40);
  REQUIRE(path.size() == 4);
  CHECK(path.segments[1].block == 0);
  CHECK(path.segments[2].block == 1);
  CHECK(path.segments[1].kind == SegmentKind::curve);
  CHECK(distance(path, points) <= 0.1);
  CHECK(jumps(path).tangent < 1e-10);
  planned(path, machine);
}

TEST_CASE("between short lines a corner takes half of each at most") {
  const auto machine = plain_machine();
  // a staircase of 0.2 mm: 90 degrees at 1 mm would be cut by 2.74 mm
  Points points = {xyz(0)};
  for (int i = 1; i <= 10; ++i) points.push_back(xyz(0.2 * ((i + 1) / 2), 0.2 * (i / 2)));
  const Path path = smoothed(machine, points, 1.0);
  CHECK(path.smoothing.corners == 9);
  CHECK(path.smoothing.corner_deviation_u < 0.1 / 2.74 * 1.01);
  for (const auto& segment : path.segments) CHECK(segment.length_u > 0);
  CHECK(distance(path, points) <= path.smoothing.corner_deviation_u);
  planned(path, machine);
}

TEST_CASE("corners without a tolerance, of rapids and stops, and lines that turn back stay as they are") {
  const auto machine = plain_machine();
  const Points points = corner(90, 20);
  const auto built = [&](auto change) {
    planner::PathBuilder builder(machine, points[0]);
    gcode::Feed first = feed_line(points[1], 0.1, 50), second = feed_line(points[2], 0.1, 50);
    change(builder, first, second);
    return builder.take();
  };
  const auto two = [&](auto change) {
    return built([&](planner::PathBuilder& b, gcode::Feed& first, gcode::Feed& second) {
      change(first, second);
      b.add({{}, first});
      b.add({{}, second});
    });
  };
  using gcode::Feed;
  CHECK(two([](Feed&, Feed&) {}).smoothing.corners == 1);
  CHECK(two([](Feed& a, Feed&) { a.path_tolerance_mm = 0; }).size() == 2);
  CHECK(two([](Feed&, Feed& b) { b.path_tolerance_mm = 0; }).size() == 2);
  CHECK(two([](Feed& a, Feed&) { a.path_mode = gcode::PathMode::exact_path; }).size() == 2);
  CHECK(two([](Feed& a, Feed&) { a.path_mode = gcode::PathMode::exact_stop; }).size() == 2);
  CHECK(built([](planner::PathBuilder& b, Feed& first, Feed& second) {
          b.add({{}, first});
          b.add({{}, gcode::Traverse{second}});
        }).size() == 2);
  CHECK(two([&](Feed&, Feed& b) { b.end = points[0]; }).size() == 2);
  CHECK(two([](Feed&, Feed& b) { b.feed_override_enabled = false; }).size() == 2);
  CHECK(built([](planner::PathBuilder& b, Feed& first, Feed& second) {
          b.add({{}, first});
          b.stop();
          b.add({{}, second});
        }).size() == 2);
  // the smaller of the two tolerances
  CHECK(two([](Feed& a, Feed&) { a.path_tolerance_mm = 0.02; }).smoothing.corner_deviation_u ==
        doctest::Approx(0.02));
  // a turn that needs no braking: 2 mm/s at 50 mm/s allow 2.3 degrees
  const Points slight = corner(1.0, 20);
  CHECK(smoothed(machine, slight, 1e-6, 50).size() == 2);
}

TEST_CASE("a technology point at a rounded corner holds in its middle, where its block begins") {
  const auto machine = plain_machine();
  const Points points = corner(60, 30);
  planner::PathBuilder builder(machine, points[0]);
  builder.add({{}, feed_line(points[1], 0.05, 60)});
  builder.limit_speed(3);
  builder.add({{}, feed_line(points[2], 0.05, 60)});
  const Path path = builder.take();
  REQUIRE(path.size() == 4);
  CHECK(path.segments[1].begin_limit_u_s == kInfinity);
  CHECK(path.segments[2].begin_limit_u_s == 3);
  CHECK(planned(path, machine).segments[1].end_u_s <= 3);
}

TEST_CASE("dense lines become a curve through their points, of continuous curvature, within P") {
  const auto machine = plain_machine();
  // a circle of 30 mm by 120 points: chords 0.041 mm off, turns of 3 degrees
  Points points;
  for (int i = 0; i <= 120; ++i) {
    const SinCos at = exact_sincos(2 * kPi * i / 120);
    points.push_back(xyz(30 * at.cos, 30 * at.sin));
  }
  const Path path = smoothed(machine, points, 0.1, 60);
  CHECK(path.smoothing.curves == 120);
  CHECK(path.size() == 122);  // half a line at both ends
  CHECK(path.smoothing.curve_deviation_u <= 0.1);
  const double off = distance(path, points);
  CHECK(off <= path.smoothing.curve_deviation_u);
  CHECK(off == doctest::Approx(0.0103).epsilon(0.05));  // the arc's sagitta R (1 - cos 1.5 deg)
  const Jumps worst = jumps(path);
  CHECK(worst.tangent < 1e-9);
  CHECK(worst.curvature < 1e-7);
  // the points are the joints of the blocks
  for (std::size_t i = 1; i < path.size() - 1; ++i)
    if (path.segments[i].block != path.segments[i - 1].block) {
      const std::size_t block = path.segments[i].block;
      CHECK(path.node(i)[0] == points[block][0]);
      CHECK(path.node(i)[1] == points[block][1]);
    }
  // away from its ends it is the circle to a micrometre, curvature 1/30
  std::vector<double> at(3);
  for (std::size_t i = 10; i < path.size() - 10; ++i) {
    planner::eval_position(path, i, 0.5 * path.segments[i].length_u, at);
    CHECK(std::hypot(at[0], at[1]) == doctest::Approx(30).epsilon(1e-6));
    const auto bend = JointPlace(path, i, 0.5 * path.segments[i].length_u).d2;
    CHECK(std::hypot(bend[0], bend[1]) == doctest::Approx(1 / 30.0).epsilon(1e-3));
  }
  // as lines every joint jumps by 60 mm/s * 3 degrees = 3.1 mm/s, which the axes do not take
  const double curve_s = planned(path, machine).law.duration_s;
  CHECK(curve_s < planned(smoothed(machine, points, 0, 60), machine).law.duration_s);
  CHECK(curve_s == doctest::Approx(2 * kPi * 30 / 60).epsilon(0.05));
}

TEST_CASE("dense lines whose curve would leave the tolerance stay apart there") {
  const auto machine = plain_machine();
  Points points;
  for (int i = 0; i <= 60; ++i) points.push_back(xyz(i, 0.02 * (i % 2)));
  const Path path = smoothed(machine, points, 0.02, 30);
  CHECK(distance(path, points) <= 0.02 + 1e-12);
  planned(path, machine);
}

TEST_CASE("random programs under G64 P stay within it and keep every limit, however they are planned") {
  Random random(environment("KADR_SEED", 5));
  const std::uint64_t count = environment("KADR_COUNT", 24);
  std::size_t corners = 0, curves = 0;
  for (std::uint64_t run = 0; run < count; ++run) {
    CAPTURE(run);
    machine::MachineModel machine = plain_machine(run % 3 == 0 ? "XYZA" : "XYZ");
    machine.planner.method = run % 4 == 1   ? machine::PlanMethod::certified
                             : run % 4 == 2 ? machine::PlanMethod::jerk_limited
                                            : machine::PlanMethod::scheduler;
    if (run % 4 == 1)
      for (auto& axis : machine.axis) axis.max_jerk_u_s3 = kInfinity;
    const Points points = random_points(random, machine.axis.size(), 12);
    const double tolerance = random.decades(0.002, 0.5);
    const Path path = smoothed(machine, points, tolerance, random.decades(5, 100));
    corners += path.smoothing.corners;
    curves += path.smoothing.curves;
    CHECK(distance(path, points) <= tolerance * (1 + 1e-9));
    CHECK(distance(path, points) <=
          std::max(path.smoothing.corner_deviation_u, path.smoothing.curve_deviation_u) + 1e-9);
    CHECK(path.segments.back().block == 11);
    for (std::size_t k = 0; k < machine.axis.size(); ++k)
      CHECK(path.node(path.size())[k] == points.back()[k]);
    planned(path, machine);
  }
  CHECK(corners > count);
  CHECK(curves > count);
}

TEST_CASE("a path that is cut further than P is seen to be") {
  const Points points = corner(90, 50);
  const Path path = smoothed(plain_machine(), points, 0.2);
  CHECK(distance(path, points) > 0.1);
}
