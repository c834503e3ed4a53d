#include "planner/path/joints.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gcode/block.h"
#include "machine/machine.h"
#include "verified_plan.h"

// The joints of a direct machine: values at a place by second methods, bounds and extents by looking.
namespace kadr::test {
namespace {

using planner::DirectJoints;
using planner::JointCourse;
using planner::JointValues;
using planner::Path;
using planner::PathCurve;
using planner::PathSegment;
using planner::SegmentKind;

constexpr std::size_t kPlaces = 60;

Path path_of_curve(const std::vector<double>& control, std::size_t axes) {
  Path path(static_cast<int>(axes));
  path.curves.emplace_back(control, axes);
  PathSegment segment;
  segment.kind = SegmentKind::curve;
  segment.shape = 0;
  segment.length_u = segment.feed_length_u = path.curves[0].length_u();
  path.segments.push_back(segment);
  path.nodes_u.assign(control.begin(), control.begin() + static_cast<int>(axes));
  path.nodes_u.insert(path.nodes_u.end(), control.end() - static_cast<int>(axes), control.end());
  path.start_s_u = {0.0, segment.length_u};
  return path;
}

/// Points that run forward with small turns, so that nothing happens between two places that are looked at.
std::vector<double> forward_control(Random& random, std::size_t points, std::size_t axes) {
  std::vector<double> control;
  for (std::size_t i = 0; i < points; ++i)
    for (std::size_t k = 0; k < axes; ++k)
      control.push_back(random.between(-1, 1) + (k == 0 ? 6.0 * static_cast<double>(i) : 0.0));
  return control;
}

/// An arc or helix from angle 0 whose radius grows from `radius` to `radius + growth`.
Path spiral(double radius, double growth, double angle_rad, double climb) {
  const auto machine = plain_machine();
  ProgramWriter w(machine, xyz(radius));
  const SinCos end = exact_sincos(angle_rad);
  w.arc(gcode::Plane::xy, 0, 0, 1, xyz((radius + growth) * end.cos, (radius + growth) * end.sin, climb), 10);
  return w.take();
}

/// A line, an arc, a helix, spirals in and out, and curves, one segment each.
std::vector<Path> shapes(Random& random) {
  const auto machine = plain_machine();
  ProgramWriter w(machine);
  w.line(xyz(random.between(1, 9), random.between(-9, 9), random.between(-9, 9)), 10);
  std::vector<Path> all = {w.take()};
  for (const double growth : {0.0, 0.01, 3.0, -3.0})
    all.push_back(spiral(5, growth, random.between(0.1, 6.2), growth == 0.01 ? 0.0 : random.between(-9, 9)));
  for (std::size_t points = 3; points <= 6; ++points)
    all.push_back(path_of_curve(forward_control(random, points, 2 + points % 3), 2 + points % 3));
  return all;
}

/// Derivatives by s from a curve's powers by the chain rule: another way than PathCurve::by_length. With
/// f(t) = x(t) and w = dt/ds = 1/|f'|:  x' = w f',  w' = -w^4 (f'.f''),  x'' = w^2 f'' + w w' f'  and so on.
struct ByChainRule {
  std::array<double, kProgramAxes> d1{}, d2{}, d3{};
  ByChainRule(const PathCurve& curve, double local_s) {
    const double t = curve.t(local_s);
    std::array<double, kProgramAxes> f1{}, f2{}, f3{};
    double p11 = 0, p12 = 0, p22 = 0, p13 = 0;
    for (std::size_t k = 0; k < curve.axes(); ++k) {
      double p1 = 1, p2 = 0, p3 = 0;  // t^(n-1), t^(n-2), t^(n-3), 0 for negative powers
      for (std::size_t n = 1; n < PathCurve::kPowers; ++n) {
        const double c = curve.coefficient(k, n), m = static_cast<double>(n);
        f1[k] += c * m * p1;
        f2[k] += c * m * (m - 1) * p2;
        f3[k] += c * m * (m - 1) * (m - 2) * p3;
        p3 = p2, p2 = p1, p1 *= t;
      }
      p11 += f1[k] * f1[k], p12 += f1[k] * f2[k], p22 += f2[k] * f2[k], p13 += f1[k] * f3[k];
    }
    // derivatives of w by t, then by s: d/ds = w d/dt
    const double w = 1 / std::sqrt(p11);
    const double w_t = -w * w * w * p12;
    const double w_tt = 3 * w * w * w * w * w * p12 * p12 - w * w * w * (p22 + p13);
    for (std::size_t k = 0; k < curve.axes(); ++k) {
      d1[k] = w * f1[k];
      const double slope = w_t * f1[k] + w * f2[k];  // of x' by t
      d2[k] = w * slope;
      d3[k] = w * (w_t * slope + w * (w_tt * f1[k] + 2 * w_t * f2[k] + w * f3[k]));
    }
  }
};

double largest(const std::array<double, kProgramAxes>& values) {
  double most = 0;
  for (const double v : values) most = std::max(most, std::fabs(v));
  return most;
}

}  // namespace

TEST_CASE("the third derivative of a circle of radius R is 1/R^2, against its direction of motion") {
  // x = R cos(s/R), y = R sin(s/R):  x''' = sin(s/R)/R^2,  y''' = -cos(s/R)/R^2
  const Path path = spiral(20, 0, 1.5, 0);
  for (const double s : {0.0, 7.0, 13.0, 30.0}) {
    const JointPlace at(path, 0, s);
    const SinCos angle = exact_sincos(s / 20);
    CHECK(at.x[0] == doctest::Approx(20 * angle.cos).epsilon(1e-13));
    CHECK(at.d1[1] == doctest::Approx(angle.cos).epsilon(1e-13));
    CHECK(at.d2[0] * 20 == doctest::Approx(-angle.cos).epsilon(1e-13));
    CHECK(at.d3[0] * 400 == doctest::Approx(angle.sin).epsilon(1e-13));
    CHECK(at.d3[1] * 400 == doctest::Approx(-angle.cos).epsilon(1e-13));
    CHECK(at.d3[2] == 0.0);
  }
}

TEST_CASE("each derivative is the difference quotient of the one before, on every shape") {
  Random random(environment("KADR_SEED", 1));
  const std::uint64_t count = environment("KADR_COUNT", 20);
  for (std::uint64_t run = 0; run < count; ++run) {
    for (const Path& path : shapes(random)) {
      const double length = path.length_u(), h = 2e-4 * length;
      for (const double share : {0.01, 0.3, 0.62, 0.99}) {
        const double s = share * length;
        const JointPlace at(path, 0, s);
        const JointPlace before2(path, 0, s - 2 * h), before(path, 0, s - h);
        const JointPlace behind(path, 0, s + h), behind2(path, 0, s + 2 * h);
        const auto agree = [&](auto lower, auto upper) {
          const double scale = largest(at.*upper) + largest(at.*lower) / length;
          for (std::size_t k = 0; k < kProgramAxes; ++k) {
            // five points: exact up to h^4/30 of the fifth derivative
            const double quotient = ((before2.*lower)[k] - 8 * (before.*lower)[k] + 8 * (behind.*lower)[k] -
                                     (behind2.*lower)[k]) /
                                    (12 * h);
            CHECK(std::fabs(quotient - (at.*upper)[k]) <= 1e-6 * scale);
          }
        };
        CAPTURE(run);
        CAPTURE(share);
        CAPTURE(path.segments[0].kind);
        agree(&JointPlace::x, &JointPlace::d1);
        agree(&JointPlace::d1, &JointPlace::d2);
        agree(&JointPlace::d2, &JointPlace::d3);
      }
    }
  }
}

TEST_CASE("a curve's derivatives by its length are those of the chain rule") {
  Random random(environment("KADR_SEED", 2));
  const std::uint64_t count = environment("KADR_COUNT", 200);
  for (std::uint64_t run = 0; run < count; ++run) {
    const std::size_t axes = 2 + run % 5;
    const Path path = path_of_curve(forward_control(random, 2 + run % 5, axes), axes);
    for (const double share : {0.0, 0.21, 0.5, 0.83, 1.0}) {
      const double s = share * path.length_u();
      const JointPlace at(path, 0, s);
      const ByChainRule other(path.curve_of(0), s);
      for (std::size_t k = 0; k < axes; ++k) {
        CHECK(std::fabs(at.d1[k] - other.d1[k]) <= 1e-12);
        CHECK(std::fabs(at.d2[k] - other.d2[k]) <= 1e-11 * (largest(other.d2) + 1e-3));
        CHECK(std::fabs(at.d3[k] - other.d3[k]) <= 1e-10 * (largest(other.d3) + 1e-3));
      }
    }
  }
}

TEST_CASE("only the values that have a place are computed") {
  const Path path = spiral(20, 0, 1.5, 7);
  const DirectJoints joints(path);
  std::array<double, 3> d2{};
  joints.at(0, 4, {.d2_per_u = d2});
  const JointPlace all(path, 0, 4);
  for (std::size_t k = 0; k < 3; ++k) CHECK(d2[k] == all.d2[k]);
  joints.at(0, 4, {});
}

TEST_CASE("the bounds of every shape hold, whatever part turning and accelerating have") {
  Random random(environment("KADR_SEED", 3));
  const std::uint64_t count = environment("KADR_COUNT", 30);
  for (std::uint64_t run = 0; run < count; ++run) {
    for (const Path& path : shapes(random)) {
      const DirectJoints joints(path);
      planner::SegmentBounds bounds;
      joints.bound(0, bounds);
      const SegmentKind kind = path.segments[0].kind;
      CHECK(bounds.straight == (kind == SegmentKind::line));
      CHECK((bounds.curvature_per_u > 0) == (kind != SegmentKind::line));
      bool kept = true;
      double steepest = 0;  // of the slopes' own bounds
      for (std::size_t i = 0; i <= kPlaces; ++i) {
        const JointPlace at(path, 0, path.length_u() * static_cast<double>(i) / kPlaces);
        const double a = random.between(-1, 1), b = random.between(-9, 9), c = random.between(-60, 60);
        for (std::size_t j = 0; j < joints.size(); ++j) {
          const planner::JointBounds& most = bounds.joint[j];
          const double all = std::fabs(a * at.d1[j] + b * at.d2[j] + c * at.d3[j]);
          kept = kept && std::fabs(at.d1[j]) <= most.slope * (1 + 1e-12);
          steepest = std::max(steepest, std::fabs(at.d1[j]) / most.slope);
          const double turning = b * most.curvature_per_u, third = std::fabs(c) * most.third_per_u2;
          const double along = std::fabs(a) * most.tangent;
          double limit = 0;
          switch (most.course) {
            case JointCourse::straight:
              limit = std::fabs(a) * most.slope;
              break;
            case JointCourse::circle:
              limit = most.skew * std::hypot(along + third, turning);
              break;
            case JointCourse::curve:
              limit = most.skew * std::hypot(along, turning) + third;
              break;
          }
          kept = kept && all <= limit * (1 + 1e-12);
        }
      }
      CHECK(kept);
      CHECK(steepest > 0.6);
    }
  }
}

TEST_CASE("the extent of a joint is what it reaches") {
  Random random(environment("KADR_SEED", 4));
  for (const Path& path : shapes(random)) {
    // the radius of a programmed arc differs by rounding only: extents of wide spirals are not promised
    if (!path.arcs.empty() && std::fabs(path.arcs[0].radius_end_u - path.arcs[0].radius_begin_u) > 1)
      continue;
    const DirectJoints joints(path);
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const auto [low, high] = joints.extent_u(0, j);
      double least = kInfinity, most = -kInfinity;
      for (int i = 0; i <= 2000; ++i) {
        const double x = JointPlace(path, 0, path.length_u() * i / 2000).x[j];
        least = std::min(least, x);
        most = std::max(most, x);
      }
      CHECK(least >= low - 1e-9);
      CHECK(most <= high + 1e-9);
      CHECK(least == doctest::Approx(low).epsilon(1e-4));
      CHECK(most == doctest::Approx(high).epsilon(1e-4));
    }
  }
}

TEST_CASE("a joint moves on a full circle though it ends where it began") {
  const auto machine = plain_machine();
  ProgramWriter w(machine, xyz(5));
  w.arc(gcode::Plane::xy, 0, 0, 1, xyz(5), 10);
  const Path path = w.take();
  const DirectJoints joints(path);
  CHECK(joints.moves(0, 0));
  CHECK(joints.moves(0, 1));
  CHECK(!joints.moves(0, 2));
  CHECK(joints.turn_rad(0) == doctest::Approx(2 * kPi).epsilon(1e-14));
}

}  // namespace kadr::test
