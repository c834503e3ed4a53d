#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gcode/block.h"
#include "machine/machine.h"
#include "planner/bezier/bezier.h"
#include "planner/bezier/curve_bounds.h"
#include "planner/bezier/curve_parts.h"
#include "verified_plan.h"

using namespace kadr;
using namespace kadr::test;
using planner::PathCurve;

namespace {

std::vector<double> random_control(Random& random, std::size_t points, std::size_t axes) {
  std::vector<double> control;
  for (std::size_t i = 0; i < points; ++i)
    for (std::size_t k = 0; k < axes; ++k)
      control.push_back(random.between(-3, 3) + (k == 0 ? 6.0 * static_cast<double>(i) : 0.0));
  return control;
}

/// de Casteljau: another way than the powers.
double casteljau(const std::vector<double>& control, std::size_t axes, std::size_t axis, double t) {
  std::vector<double> p;
  for (std::size_t i = axis; i < control.size(); i += axes) p.push_back(control[i]);
  for (std::size_t n = p.size() - 1; n > 0; --n)
    for (std::size_t i = 0; i < n; ++i) p[i] = (1 - t) * p[i] + t * p[i + 1];
  return p[0];
}

}  // namespace

TEST_CASE(
    "a path's curve is its Bezier curve, runs by its length, and its derivatives are those of the length") {
  Random random(environment("KADR_SEED", 1));
  const std::uint64_t count = environment("KADR_COUNT", 60);
  for (std::uint64_t run = 0; run < count; ++run) {
    CAPTURE(run);
    const std::size_t axes = 2 + run % 6, points = 2 + (run / 6) % 5;
    const std::vector<double> control = random_control(random, points, axes);
    const PathCurve curve(control, axes);
    for (const double t : {0.0, 0.21, 0.5, 0.83, 1.0})
      for (std::size_t k = 0; k < axes; ++k)
        CHECK(curve.position(k, t) == doctest::Approx(casteljau(control, axes, k, t)).epsilon(1e-12));
    // chords of 1e5 parts: within (k ds)^2/24 of the length
    if (run % 20 == 0) {
      double chords = 0;
      std::vector<double> a(axes), b(axes);
      curve.position(0, a);
      for (int i = 1; i <= 100000; ++i) {
        curve.position(i * 1e-5, b);
        double square = 0;
        for (std::size_t k = 0; k < axes; ++k) square += (b[k] - a[k]) * (b[k] - a[k]);
        chords += std::sqrt(square);
        a.swap(b);
      }
      CHECK(curve.length_u() == doctest::Approx(chords).epsilon(1e-8));
    }
    for (const double share : {0.1, 0.37, 0.5, 0.9}) {
      const double s = share * curve.length_u(), t = curve.t(s);
      CHECK(std::fabs(curve.s_u(t) - s) < 1e-13 * curve.length_u());
      const planner::LengthDerivatives x = curve.by_length(t);
      double one = 0, across = 0;
      for (std::size_t k = 0; k < axes; ++k) {
        one += x.d1[k] * x.d1[k];
        across += x.d1[k] * x.d2[k];
        // central differences over a thousandth of the length
        const double h = 1e-3 * curve.length_u();
        const auto at = [&](double ds) { return curve.position(k, curve.t(s + ds)); };
        CHECK(x.d1[k] == doctest::Approx((at(h) - at(-h)) / (2 * h)).epsilon(0.01).scale(1));
        CHECK(x.d2[k] == doctest::Approx((at(h) - 2 * at(0) + at(-h)) / (h * h)).epsilon(0.01).scale(0.1));
        const double third = (at(2 * h) - 2 * at(h) + 2 * at(-h) - at(-2 * h)) / (2 * h * h * h);
        CHECK(x.d3[k] == doctest::Approx(third).epsilon(0.02).scale(0.1));
      }
      CHECK(one == doctest::Approx(1));
      CHECK(std::fabs(across) < 1e-12);
    }
    CHECK(curve.t(0) == 0);
    CHECK(curve.t(curve.length_u()) == 1);
  }
}

TEST_CASE("length and radius of the curves of paper 004") {
  const std::vector<double> quadratic = {0, 0, 0, 2, 2, 4, 5, -0.5, 2};
  const std::vector<double> cubic = {5, -0.5, 2, 8, -3, 0, 11, -1, -2, 12, 1, -1};
  CHECK(PathCurve(quadratic, 3).length_u() == doctest::Approx(6.8403037598).epsilon(1e-10));
  CHECK(PathCurve(cubic, 3).length_u() == doctest::Approx(9.1706593282).epsilon(1e-10));
  // the bound lies above the largest curvature, and not far
  const double least = 1 / 1.906851;
  const double bound = planner::curve_bounds(PathCurve(quadratic, 3)).curvature_per_u;
  CHECK(bound >= least);
  CHECK(bound < 1.05 * least);
}

TEST_CASE("the bounds of a curve hold at places that they did not look at") {
  Random random(environment("KADR_SEED", 2));
  const std::uint64_t count = environment("KADR_COUNT", 150);
  double loosest = 0;
  for (std::uint64_t run = 0; run < count; ++run) {
    const std::size_t axes = 2 + run % 4;
    const std::vector<double> control = random_control(random, 4 + run % 3, axes);
    const auto parts = planner::parts_of_like_curvature(control, axes, 0.01);
    if (!parts) continue;
    for (const std::vector<double>& part : *parts) {
      const PathCurve curve(part, axes);
      const planner::CurveBounds b = planner::curve_bounds(curve);
      double bend = 0;
      bool kept = true;
      for (int i = 0; i <= 200; ++i) {
        const planner::LengthDerivatives x = curve.by_length(i / 200.0);
        double square = 0;
        for (std::size_t k = 0; k < axes; ++k) square += x.d2[k] * x.d2[k];
        bend = std::max(bend, std::sqrt(square));
        for (std::size_t k = 0; k < axes; ++k) {
          kept = kept && std::fabs(x.d1[k]) <= b.tangent[k] && std::fabs(x.d3[k]) <= b.third_u2[k];
          // any acceleration along and across: sqrt(a^2 + (b K)^2) with a = cos, b K = sin
          for (const double angle : {0.3, 0.8, 1.2, 2.1, 2.7}) {
            const SinCos at = exact_sincos(angle);
            const double both = at.cos * x.d1[k] + at.sin / b.curvature_per_u * x.d2[k];
            kept = kept && std::fabs(both) <= b.plane[k] * (1 + 1e-12);
          }
        }
      }
      CHECK(kept);
      CHECK(bend <= b.curvature_per_u);
      loosest = std::max(loosest, b.curvature_per_u / bend);
    }
  }
  MESSAGE("bound over largest curvature, at most ", loosest);
  CHECK(loosest < 1.5);
}

TEST_CASE("parts of a curve are its parts, and a cusp has none") {
  const std::vector<double> control = {0, 0, 0, 30, 40, -30, 40, 0};
  const auto parts = planner::parts_of_like_curvature(control, 2, 0.005);
  REQUIRE(parts);
  CHECK(parts->size() > 4);
  double length = 0;
  for (std::size_t i = 0; i < parts->size(); ++i) {
    const PathCurve part((*parts)[i], 2);
    length += part.length_u();
    if (i == 0) continue;
    const planner::LengthDerivatives a = PathCurve((*parts)[i - 1], 2).by_length(1), b = part.by_length(0);
    for (std::size_t k = 0; k < 2; ++k) {
      CHECK(std::fabs(a.d1[k] - b.d1[k]) < 1e-12);
      CHECK(std::fabs(a.d2[k] - b.d2[k]) < 1e-10);
    }
  }
  CHECK(length == doctest::Approx(PathCurve(control, 2).length_u()).epsilon(1e-12));
  // x = t^2 (3 - 2 t) turns back on itself; a control point on the end
  CHECK_FALSE(planner::parts_of_like_curvature(std::vector<double>{0, 0, 10, 10, 0, 10, 10, 0}, 2, 0.01));
  CHECK_FALSE(planner::parts_of_like_curvature(std::vector<double>{0, 0, 0, 0, 5, 5, 10, 0}, 2, 0.01));
}

TEST_CASE("a curve that is cut is the same curve, and so is a path of curves") {
  Random random(environment("KADR_SEED", 3));
  for (int run = 0; run < 20; ++run) {
    const std::vector<double> control = random_control(random, 6, 3);
    const PathCurve whole(control, 3);
    const double t = random.between(0.1, 0.9);
    const PathCurve first = whole.part(0, t), second = whole.part(t, 1);
    CHECK(first.length_u() + second.length_u() == doctest::Approx(whole.length_u()).epsilon(1e-12));
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(first.position(k, 0.5) == doctest::Approx(whole.position(k, 0.5 * t)).epsilon(1e-12));
      CHECK(second.position(k, 0.5) == doctest::Approx(whole.position(k, 0.5 + 0.5 * t)).epsilon(1e-12));
    }
    planner::Path path(3);
    path.curves.push_back(whole);
    planner::PathSegment segment;
    segment.kind = planner::SegmentKind::curve;
    segment.shape = 0;
    segment.length_u = segment.feed_length_u = whole.length_u();
    segment.feed_u_s = 30;
    path.segments.push_back(segment);
    path.start_s_u = {0.0, segment.length_u};
    path.nodes_u.assign(control.begin(), control.begin() + 3);
    path.nodes_u.insert(path.nodes_u.end(), control.end() - 3, control.end());
    CHECK(planner::cut_path(path, 0.3 * segment.length_u) == 1);
    CHECK(planner::cut_path(path, 0.7 * segment.length_u) == 2);
    planned(path, plain_machine());
  }
}

TEST_CASE("a spline of one span is followed exactly, at any tolerance, without a corner") {
  const auto machine = plain_machine();
  gcode::Spline block;
  block.order = 4;
  block.control_points = {{0, 0, 1}, {0, 30, 1}, {40, -30, 1}, {40, 0, 1}};
  block.end = xyz(40, 0, 0);
  block.feed_u_s = 60;
  std::size_t segments = 0;
  for (const double tolerance_mm : {0.0, 0.05}) {
    block.path_tolerance_mm = tolerance_mm;
    planner::PathBuilder builder(machine, {});
    CHECK(builder.add({{}, block}));
    const planner::Path path = builder.take();
    CHECK((segments == 0 || segments == path.size()));
    segments = path.size();
    // every place is on the curve: its t by x(t) = 120 t^2 - 80 t^3, a cubic that only rises
    std::vector<double> at(3);
    double worst = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      CHECK(path.segments[i].kind == planner::SegmentKind::curve);
      CHECK(path.segments[i].block == 0);
      for (int k = 0; k < 8; ++k) {
        planner::eval_position(path, i, path.segments[i].length_u * k / 8, at);
        double low = 0, high = 1;
        for (int n = 0; n < 60; ++n) {
          const double t = 0.5 * (low + high);
          (t * t * (120 - 80 * t) < at[0] ? low : high) = t;
        }
        // y(t) = 90 t (1 - t)^2 - 90 t^2 (1 - t)
        const double y = 90 * low * (1 - low) * (1 - 2 * low);
        worst = std::max(worst, std::fabs(at[1] - y));
      }
    }
    CHECK(worst < 1e-9);
    const planner::FeedPlan plan = planned(path, machine);
    // nothing brakes it but its own curvature
    for (std::size_t i = 0; i + 1 < path.size(); ++i) CHECK(plan.segments[i].end_u_s > 10);
  }
}

TEST_CASE("a curve's limits are seen to be broken by a law that is too fast") {
  auto machine = plain_machine();
  gcode::Spline block;
  block.order = 3;
  block.control_points = {{0, 0, 1}, {10, 0, 1}, {10, 10, 1}};
  block.end = xyz(10, 10, 0);
  block.feed_u_s = 100;
  planner::PathBuilder builder(machine, {});
  builder.add({{}, block});
  const planner::Path path = builder.take();
  const planner::FeedPlan plan = planned(path, machine);
  // the same law on a machine of half the acceleration, and of a centripetal limit
  machine.axis[0].max_accel_u_s2 = 700;
  CHECK(finds(path, plan, machine, "axis acceleration"));
  machine = plain_machine();
  machine.path.centripetal_accel_mm_s2 = 300;
  CHECK(finds(path, plan, machine, "centripetal acceleration"));
  machine = plain_machine();
  for (auto& axis : machine.axis) axis.max_jerk_u_s3 = 10000;
  CHECK(finds(path, plan, machine, "axis jerk"));
  // a path whose curve is not where its nodes are, or not as long
  planner::Path wrong = path;
  wrong.nodes_u[3] += 1e-6;
  CHECK(finds(wrong, plan, plain_machine(), "ends of a curve"));
  wrong = path;
  wrong.segments[0].length_u *= 1.001;
  CHECK(finds(wrong, plan, plain_machine(), "length of a curve"));
}
