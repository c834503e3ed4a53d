#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "machine/base/numbers.h"
#include "machine/base/plane_spline.h"

using namespace kadr;

TEST_CASE("a quadratic spline of three points is their parabola") {
  // from (-2, 4) by (0, -4) to (2, 4): x = -2 + 4 u, y = x^2
  const PlaneSpline parabola({{-2, 4, 1}, {0, -4, 1}, {2, 4, 1}}, 3);
  REQUIRE(parabola.spans() == 1);
  for (const double u : {0.0, 0.25, 0.5, 0.8, 1.0}) {
    const SplineValue v = parabola.eval(0, u);
    const double x = -2 + 4 * u;
    CHECK(v.first == doctest::Approx(x));
    CHECK(v.second == doctest::Approx(x * x));
    CHECK(v.first_d1 == doctest::Approx(4));
    CHECK(v.second_d1 == doctest::Approx(8 * x));
    CHECK(v.first_d2 == doctest::Approx(0));
    CHECK(v.second_d2 == doctest::Approx(32));
  }
}

TEST_CASE("the length of a parabola agrees with the closed form to 1e-9") {
  // y = x^2 from -2 to 2: 2 (x sqrt(1 + 4 x^2) / 2 + ln(2 x + sqrt(1 + 4 x^2)) / 4) at x = 2
  const PlaneSpline parabola({{-2, 4, 1}, {0, -4, 1}, {2, 4, 1}}, 3);
  const double root = std::sqrt(17.0);
  const double exact = 2 * (2 * root / 2 + exact_log(4 + root) / 4);
  CHECK(std::fabs(parabola.length() - exact) < 1e-9 * exact);
}

TEST_CASE("weights 1, sqrt(1/2), 1 over a right angle are a quarter circle") {
  const PlaneSpline quarter({{10, 0, 1}, {10, 10, std::sqrt(0.5)}, {0, 10, 1}}, 3);
  for (int i = 0; i <= 20; ++i) {
    const SplineValue v = quarter.eval(0, i / 20.0);
    CHECK(std::sqrt(v.first * v.first + v.second * v.second) == doctest::Approx(10).epsilon(1e-14));
  }
  CHECK(quarter.length() == doctest::Approx(5 * kPi).epsilon(1e-10));
}

TEST_CASE("derivatives are the limits of differences, and inner knots join smoothly") {
  const PlaneSpline spline({{0, 0, 1}, {0, 1, 2}, {2, 2, 0.5}, {2, 0, 1}, {4, -1, 3}, {5, 5, 1}}, 4);
  REQUIRE(spline.spans() == 3);
  const double h = 1e-5;
  for (std::size_t span = 0; span < 3; ++span) {
    for (const double u : {0.1, 0.5, 0.9}) {
      const SplineValue v = spline.eval(span, u);
      const SplineValue less = spline.eval(span, u - h), more = spline.eval(span, u + h);
      CHECK(v.first_d1 == doctest::Approx((more.first - less.first) / (2 * h)).epsilon(1e-7));
      CHECK(v.second_d1 == doctest::Approx((more.second - less.second) / (2 * h)).epsilon(1e-7));
      CHECK(v.first_d2 == doctest::Approx((more.first_d1 - less.first_d1) / (2 * h)).epsilon(1e-7));
      CHECK(v.second_d2 == doctest::Approx((more.second_d1 - less.second_d1) / (2 * h)).epsilon(1e-7));
    }
  }
  for (std::size_t span = 0; span < 2; ++span) {
    const SplineValue end = spline.eval(span, 1), begin = spline.eval(span + 1, 0);
    CHECK(end.first == doctest::Approx(begin.first).epsilon(1e-14));
    CHECK(end.second_d1 == doctest::Approx(begin.second_d1).epsilon(1e-13));
    CHECK(end.first_d2 == doctest::Approx(begin.first_d2).epsilon(1e-12));
  }
  CHECK(spline.eval(0, 0).first == 0);
  CHECK(spline.eval(2, 1).second == 5);
}

TEST_CASE("the length of a curve with a cusp is found") {
  // (0,0) (1,1) (0,1) (1,0) has a cusp in its middle; half of it is x = ..., found by 400000 chords
  const PlaneSpline cusp({{0, 0, 1}, {1, 1, 1}, {0, 1, 1}, {1, 0, 1}}, 4);
  double chords = 0;
  SplineValue before = cusp.eval(0, 0);
  for (int i = 1; i <= 400'000; ++i) {
    const SplineValue now = cusp.eval(0, i / 400'000.0);
    const double x = now.first - before.first, y = now.second - before.second;
    chords += std::sqrt(x * x + y * y);
    before = now;
  }
  CHECK(cusp.length() == doctest::Approx(chords).epsilon(1e-9));
}
