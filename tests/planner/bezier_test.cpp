#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "planner/bezier/bezier.h"
#include "tests/support/seed.h"

using namespace kadr::planner;

namespace {

/// The example of paper 004, Table 1.
const Bezier kPaperQuadratic(3, {{0, 0, 0}, {2, 2, 4}, {5, -0.5, 2}});
const Bezier kPaperCubic(3, {{5, -0.5, 2}, {8, -3, 0}, {11, -1, -2}, {12, 1, -1}});

void check_vector(const BezierVector& v, double x, double y, double z, double within) {
  CHECK(std::fabs(v[0] - x) <= within);
  CHECK(std::fabs(v[1] - y) <= within);
  CHECK(std::fabs(v[2] - z) <= within);
}

/// Length by many chords, with the error of the chords taken out (Richardson): shares nothing with ArcLength.
double chord_length(const Bezier& curve, double to) {
  const auto chords = [&](int n) {
    double sum = 0;
    BezierVector before = curve.position(0);
    for (int i = 1; i <= n; ++i) {
      const BezierVector at = curve.position(to * i / n);
      BezierVector d = at;
      for (std::size_t k = 0; k < 3; ++k) d[k] -= before[k];
      sum += norm(d);
      before = at;
    }
    return sum;
  };
  return (4 * chords(8000) - chords(4000)) / 3;
}

}  // namespace

TEST_CASE("bezier: the six polynomials of paper 004 are right") {
  check_vector(kPaperQuadratic.coefficient(2), 1, -4.5, -6, 0);
  check_vector(kPaperQuadratic.coefficient(1), 4, 4, 8, 0);
  check_vector(kPaperQuadratic.coefficient(0), 0, 0, 0, 0);
  check_vector(kPaperCubic.coefficient(3), -2, -4.5, 3, 0);
  check_vector(kPaperCubic.coefficient(2), 0, 13.5, 0, 0);
  check_vector(kPaperCubic.coefficient(1), 9, -7.5, -6, 0);
  check_vector(kPaperCubic.coefficient(0), 5, -0.5, 2, 0);
}

TEST_CASE("bezier: both radii of paper 004 are right, and the second lies at the very end") {
  const SmallestRadius q = smallest_radius(kPaperQuadratic), c = smallest_radius(kPaperCubic);
  CHECK(q.radius_u == doctest::Approx(1.906851).epsilon(5e-7));
  CHECK(q.t == doctest::Approx(0.54148).epsilon(1e-5));
  CHECK(c.radius_u == doctest::Approx(2.512307).epsilon(5e-7));
  CHECK(c.t == 1);
  CHECK(1 / kPaperQuadratic.curvature_per_u(0) == doctest::Approx(11.5710).epsilon(1e-5));
  CHECK(1 / kPaperCubic.curvature_per_u(0) == doctest::Approx(7.8082).epsilon(1e-5));
  // 12.74 km at 1000 m/s and 8 g needs g = 9.81; the printed 9.8 makes it 12.755
  CHECK(1e6 / 8 / 9.81 / 1000 == doctest::Approx(12.7421).epsilon(1e-5));
}

TEST_CASE("bezier: the smallest radius by formula is the smallest of many samples") {
  std::mt19937 random(static_cast<unsigned>(kadr::test::property_seed(4)));
  const auto draw = [&] { return static_cast<double>(random() % 2001) / 100 - 10; };
  for (int i = 0; i < 300; ++i) {
    const int axes = 2 + i % 3;
    std::vector<BezierVector> control(i % 4 == 0 ? 3 : 4);
    for (BezierVector& p : control)
      for (std::size_t k = 0; k < static_cast<std::size_t>(axes); ++k) p[k] = draw();
    const Bezier curve(axes, control);
    const SmallestRadius found = smallest_radius(curve);
    double least = 1e300;
    for (int j = 0; j <= 2000; ++j) least = std::min(least, 1 / curve.curvature_per_u(j / 2000.0));
    CHECK(found.radius_u <= least * (1 + 1e-9));
    CHECK(found.radius_u >= least * 0.5 - 1e-3);
    CHECK(1 / curve.curvature_per_u(found.t) == doctest::Approx(found.radius_u).epsilon(1e-9));
  }
  CHECK(std::isinf(smallest_radius(Bezier(2, {{0, 0}, {3, 4}})).radius_u));
}

TEST_CASE("bezier: zeros inside (0, 1) are found, however close") {
  // (t - 0.25)(t - 0.5)(t - 0.75)(t - 2) and (t - 0.5)(t - 0.5001)
  const std::vector<double> z = zeros_in_unit({0.1875, -1.46875, 3.6875, -3.5, 1});
  REQUIRE(z.size() == 3);
  CHECK(z[0] == doctest::Approx(0.25).epsilon(1e-12));
  CHECK(z[1] == doctest::Approx(0.5).epsilon(1e-12));
  CHECK(z[2] == doctest::Approx(0.75).epsilon(1e-12));
  CHECK(zeros_in_unit({0.5 * 0.5001, -1.0001, 1}).size() == 2);
  CHECK(zeros_in_unit({1, 0, 0}).empty());
  CHECK(zeros_in_unit({}).empty());
}

TEST_CASE("bezier: arc lengths of paper 004's curves, by another way too") {
  CHECK(ArcLength(kPaperQuadratic).length_u() == doctest::Approx(6.8403037598).epsilon(1e-10));
  CHECK(ArcLength(kPaperCubic).length_u() == doctest::Approx(9.1706593282).epsilon(1e-10));
  for (const Bezier* curve : {&kPaperQuadratic, &kPaperCubic})
    for (const double t : {0.1, 0.5, 1.0})
      CHECK(ArcLength(*curve).s_u(t) == doctest::Approx(chord_length(*curve, t)).epsilon(1e-9));
  // straight and even: S = 5 t
  CHECK(ArcLength(Bezier(2, {{1, 1}, {4, 5}})).t(2.5) == doctest::Approx(0.5).epsilon(1e-15));
}

TEST_CASE(
    "bezier: the joint of paper 004 is G1, not C1, and its curvature vector jumps by 38 % of the largest") {
  const JointReport joint = joint_report(kPaperQuadratic, kPaperCubic);
  CHECK(joint.gap_u == 0);
  CHECK(joint.tangent_angle_rad <= 1e-12);
  CHECK(joint.speed_ratio == doctest::Approx(1.5).epsilon(1e-14));
  CHECK(joint.curvature_before_per_u == doctest::Approx(0.120309).epsilon(5e-6));
  CHECK(joint.curvature_after_per_u == doctest::Approx(0.128070).epsilon(5e-6));
  CHECK(joint.normal_angle_rad * 180 / M_PI == doctest::Approx(106.65).epsilon(5e-5));
  CHECK(joint.curvature_jump_per_u == doctest::Approx(0.199269).epsilon(5e-6));
  CHECK(joint.curvature_jump_per_u * smallest_radius(kPaperQuadratic).radius_u ==
        doctest::Approx(0.38).epsilon(5e-3));
  // B1''(1) = (2, -9, -12), B2''(0) = (0, 27, 0)
  CHECK(joint.second_jump == doctest::Approx(std::sqrt(4 + 36 * 36 + 144)).epsilon(1e-14));
}

TEST_CASE("bezier: repairs of the joint make it G2 and C2") {
  const auto g2 = repair_g2(kPaperQuadratic, kPaperCubic);
  REQUIRE(g2);
  check_vector(g2->third, 8.681818, -6.318182, -4.454545, 1e-6);
  const auto with = [](const JointRepair& r) {
    return Bezier(3, {kPaperCubic.control()[0], r.second, r.third, kPaperCubic.control()[3]});
  };
  CHECK(joint_report(kPaperQuadratic, with(*g2)).curvature_jump_per_u <= 1e-14);
  // moved along the tangent (3, -2.5, -2) it is G2 still
  JointRepair moved = *g2;
  for (std::size_t k = 0; k < 3; ++k) moved.third[k] += 0.7 * std::array{3.0, -2.5, -2.0}[k];
  CHECK(joint_report(kPaperQuadratic, with(moved)).curvature_jump_per_u <= 1e-14);
  const auto c2 = repair_c2(kPaperQuadratic, kPaperCubic);
  REQUIRE(c2);
  check_vector(c2->second, 7, -2.1667, 0.6667, 5e-5);
  check_vector(c2->third, 9.3333, -5.3333, -2.6667, 5e-5);
  const JointReport repaired = joint_report(kPaperQuadratic, with(*c2));
  CHECK(repaired.speed_ratio == doctest::Approx(1).epsilon(1e-14));
  CHECK(repaired.second_jump <= 1e-12);
  CHECK_FALSE(repair_g2(kPaperCubic, kPaperQuadratic));
  CHECK_FALSE(
      repair_g2(kPaperQuadratic, Bezier(3, {kPaperCubic.control()[0], {1, 1, 1}, {2, 2, 2}, {3, 0, 0}})));
}

TEST_CASE("bezier: speeds that curvature and acceleration allow") {
  // R = 2 at 8 mm/s2: 4 mm/s; with 0.6 of it along the path 0.8 is left: 4 sqrt(0.8)
  CHECK(curvature_speed_u_s(0.5, 8) == 4);
  CHECK(curvature_speed_u_s(0.5, 8, 4.8) == doctest::Approx(4 * std::sqrt(0.8)).epsilon(1e-14));
  CHECK(std::isinf(curvature_speed_u_s(0, 8)));
}
