#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "planner/bezier/bezier.h"
#include "tests/support/seed.h"

using namespace kadr::planner;

namespace {

const Bezier kQuadratic(3, {{0, 0, 0}, {2, 2, 4}, {5, -0.5, 2}});
const Bezier kCubic(3, {{5, -0.5, 2}, {8, -3, 0}, {11, -1, -2}, {12, 1, -1}});

struct Row {
  int degree;
  double reduced_pct, position, feed;
};

void check_row(const ReparameterisationError& e, const Row& row) {
  CAPTURE(row.degree);
  CHECK(100 * e.reduced == doctest::Approx(row.reduced_pct).epsilon(0.02));
  CHECK(e.position_u == doctest::Approx(row.position).epsilon(0.02));
  CHECK(e.feed == doctest::Approx(row.feed).epsilon(0.02));
}

}  // namespace

TEST_CASE("bezier: Newton's polynomials of t(S) have the errors of the study") {
  const Row quadratic[] = {{3, 1.439110, 1.253e-1, 3.369e-1},
                           {5, 0.557627, 5.094e-2, 2.602e-1},
                           {6, 0.464549, 3.818e-2, 2.451e-1},
                           {7, 0.283978, 2.670e-2, 2.086e-1},
                           {8, 0.279899, 2.359e-2, 2.217e-1}};
  const Row cubic[] = {{3, 0.191069, 1.394e-2, 4.669e-2},
                       {5, 0.106335, 7.740e-3, 3.088e-2},
                       {6, 0.034038, 2.544e-3, 1.259e-2},
                       {7, 0.005547, 7.043e-4, 4.310e-3},
                       {8, 0.004671, 3.402e-4, 3.029e-3}};
  const ArcLength q(kQuadratic), c(kCubic);
  for (const Row& row : quadratic) check_row(measure_error(q, NewtonOfLength(q, row.degree)), row);
  for (const Row& row : cubic) check_row(measure_error(c, NewtonOfLength(c, row.degree)), row);
}

TEST_CASE("bezier: minimax polynomials of Newton's eighth have the errors of the study") {
  const Row quadratic[] = {{2, 3.753603, 2.655e-1, 3.826e-1}, {3, 0.817967, 7.083e-2, 2.226e-1},
                           {4, 0.604846, 4.840e-2, 1.949e-1}, {5, 0.214333, 1.626e-2, 1.089e-1},
                           {6, 0.274654, 2.545e-2, 1.543e-1}, {7, 0.189248, 1.561e-2, 1.041e-1}};
  const Row cubic[] = {{2, 0.147181, 1.275e-2, 4.096e-2}, {3, 0.116573, 1.312e-2, 3.542e-2},
                       {4, 0.078880, 9.449e-3, 2.658e-2}, {5, 0.042168, 5.171e-3, 2.148e-2},
                       {6, 0.013478, 1.714e-3, 1.056e-2}, {7, 0.002483, 2.509e-4, 1.654e-3}};
  const ArcLength q(kQuadratic), c(kCubic);
  const auto newton_q = places_of(NewtonOfLength(q, 8)), newton_c = places_of(NewtonOfLength(c, 8));
  for (const Row& row : quadratic) check_row(measure_error(q, MinimaxOfLength(newton_q, row.degree)), row);
  for (const Row& row : cubic) check_row(measure_error(c, MinimaxOfLength(newton_c, row.degree)), row);
  // of the exact t(S)
  check_row(measure_error(q, MinimaxOfLength(exact_places(q), 7)), {7, 0.057480, 5.472e-3, 5.993e-2});
  check_row(measure_error(c, MinimaxOfLength(exact_places(c), 7)), {7, 0.001500, 1.928e-4, 1.717e-3});
  // the coefficients of degree 4
  const MinimaxOfLength four(newton_q, 4);
  REQUIRE(four.coefficients().size() == 3);
}

TEST_CASE(
    "bezier: a minimax polynomial has one error more than unknowns of equal size and alternating sign") {
  const ArcLength q(kQuadratic);
  const auto target = exact_places(q);
  for (const int degree : {2, 4, 7, 12}) {
    const MinimaxOfLength f(target, degree);
    int alternations = 0, sign = 0;
    for (int i = 0; i < kErrorPlaces; ++i) {
      const double e = f(error_place(i)) - target[static_cast<std::size_t>(i)];
      CHECK(std::fabs(e) <= f.error() * (1 + 1e-8));
      if (std::fabs(e) < f.error() * (1 - 1e-6)) continue;
      const int now = e > 0 ? 1 : -1;
      alternations += now != sign;
      sign = now;
    }
    CHECK(alternations >= degree);
    CHECK(f(0) == 0);
    CHECK(f(1) == 1);
  }
}

TEST_CASE("bezier: the quintic table keeps the feed to 1e-6 and the place to 1e-9 of the length") {
  const struct {
    int parts;
    double reduced_pct_q, reduced_pct_c;
  } rows[] = {{16, 5e-6, 2e-6}, {32, 9e-8, 4e-8}, {64, 1.4e-9, 6e-10}};
  for (const Bezier* curve : {&kQuadratic, &kCubic}) {
    const ArcLength arc(*curve);
    for (const auto& row : rows) {
      const ArcTable table(arc, row.parts);
      const auto e = measure_error(arc, [&](double u) { return table.t(u * arc.length_u()); });
      const double asked = curve == &kQuadratic ? row.reduced_pct_q : row.reduced_pct_c;
      CHECK(100 * e.reduced <= asked * 1.1);
      CHECK(100 * e.reduced >= asked * 0.5);
      CHECK(e.feed <= 3e-6);
    }
    const ArcTable table = ArcTable::fitted(arc);
    CHECK(table.parts() <= 64);
    CHECK(table.t(0) == 0);
    CHECK(table.t(arc.length_u()) == 1);
    double before = -1, worst_feed = 0, worst_place = 0, worst_round = 0;
    for (int i = 0; i <= 20'000; ++i) {
      const double s = arc.length_u() * i / 20'000, t = table.t(s);
      CHECK(t > before);
      before = t;
      worst_feed = std::max(worst_feed, std::fabs(table.dt_ds(s) * curve->speed(t) - 1));
      worst_place = std::max(worst_place, std::fabs(arc.s_u(t) - s));
      worst_round = std::max(worst_round, std::fabs(arc.s_u(polished(arc, t, s)) - s));
    }
    CHECK(worst_feed < 1e-6);
    CHECK(worst_place < 1e-9 * arc.length_u());
    CHECK(worst_round < 1e-12);
  }
}

TEST_CASE("bezier: t(S) of random curves keeps the feed as well, unless they come near a cusp") {
  std::mt19937 random(static_cast<unsigned>(kadr::test::property_seed(6)));
  const auto draw = [&] { return static_cast<double>(random() % 2001) / 100 - 10; };
  for (int i = 0; i < 60; ++i) {
    std::vector<BezierVector> control(i % 3 == 0 ? 3 : 4);
    for (BezierVector& p : control)
      for (std::size_t k = 0; k < 3; ++k) p[k] = draw();
    const Bezier curve(3, control);
    const ArcLength arc(curve);
    const ArcTable table = ArcTable::fitted(arc);
    if (table.parts() == 4096) continue;
    for (int j = 0; j <= 300; ++j) {
      const double s = arc.length_u() * j / 300, t = table.t(s);
      CHECK(std::fabs(table.dt_ds(s) * curve.speed(t) - 1) < 2e-6);
      CHECK(std::fabs(arc.s_u(arc.t(s)) - s) < 1e-12 * arc.length_u() + 1e-13);
    }
  }
}

TEST_CASE("bezier: a chord of ds is shorter than its arc by k^2 ds^2/24") {
  const ArcLength arc(kQuadratic);
  for (const int n : {100, 1000}) {
    const double ds = arc.length_u() / n;
    double deficit = 0;
    for (int i = 0; i < n; ++i) {
      const BezierVector a = kQuadratic.position(arc.t(ds * i));
      BezierVector b = kQuadratic.position(arc.t(ds * (i + 1)));
      for (std::size_t k = 0; k < 3; ++k) b[k] -= a[k];
      deficit = std::max(deficit, 1 - norm(b) / ds);
    }
    const double k = 1 / smallest_radius(kQuadratic).radius_u;
    CHECK(deficit == doctest::Approx(k * k * ds * ds / 24).epsilon(0.01));
  }
}
