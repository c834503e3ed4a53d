#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "tests/emulator/interpolator/lattice_support.h"
#include "tests/support/seed.h"

using namespace kadr;
using namespace kadr::test;
using lattice::ImplicitCurve;
using lattice::ParabolaCurve;
using lattice::Polynomial;

namespace {

/// Distances of a run's nodes from a curve given by many points of it: largest, plain and in the larger axis.
struct Distance {
  double euclid = 0, square = 0;
};

template <class At>
Distance distance(const Trace& t, At&& at, double from, double to, int points) {
  std::vector<std::pair<double, double>> curve;
  for (int i = 0; i <= points; ++i) curve.push_back(at(from + (to - from) * i / points));
  Distance out;
  for (const PlaneNode n : nodes(t)) {
    double euclid = 1e300, square = 1e300;
    for (const auto& [x, y] : curve) {
      const double dx = std::fabs(x - static_cast<double>(n.x)), dy = std::fabs(y - static_cast<double>(n.y));
      euclid = std::min(euclid, dx * dx + dy * dy);
      square = std::min(square, std::max(dx, dy));
    }
    out.euclid = std::max(out.euclid, std::sqrt(euclid));
    out.square = std::max(out.square, square);
  }
  return out;
}

}  // namespace

TEST_CASE("lattice: a circle by its polynomial makes the paths of the circle's own methods") {
  for (const int r : {1, 2, 5, 13, 40})
    for (const Turn turn : {Turn::ccw, Turn::cw}) {
      const ImplicitCurve f{
          Polynomial({{1, 2, 0}, {1, 0, 2}, {-r * r, 0, 0}}), {r, 0}, {r, 0}, turn == Turn::ccw ? 1 : -1};
      const ArcCurve arc{{r, 0}, {r, 0}, turn};
      CHECK(trace(f, Method::half_step).hash == trace(arc, Method::half_step).hash);
      CHECK(trace(f, Method::extra_points).hash == trace(arc, Method::extra_points).hash);
      if (r > 1) CHECK(trace(f, Method::classic).hash == trace(arc, Method::classic).hash);
    }
}

TEST_CASE(
    "lattice: ellipses close within 0.5 in each axis, as long as the tips are not sharper than a cell") {
  // steps and Euclid of the study, section 3.3
  const struct {
    int a, b;
    std::size_t slots;
    double euclid;
  } rows[] = {{60, 40, 400, .690}, {60, 25, 340, .707}, {60, 10, 280, .607}, {60, 5, 260, .579}};
  for (const auto& row : rows) {
    const Trace t = trace(lattice::ellipse(row.a, row.b), Method::half_step);
    CHECK(t.end_reached);
    CHECK(t.slots.size() == row.slots);
    const Distance d = distance(
        t, [&](double u) { return std::pair(row.a * std::cos(u), row.b * std::sin(u)); }, 0, 2 * M_PI,
        20'000);
    CHECK(d.euclid == doctest::Approx(row.euclid).epsilon(2e-3));
    CHECK(d.square <= 0.5 + 2e-3);  // of the sampling
    std::vector<PlaneNode> mirrored =
        nodes(trace(lattice::ellipse(row.a, row.b, Turn::cw), Method::half_step));
    for (PlaneNode& n : mirrored) n.y = -n.y;
    CHECK(mirrored == nodes(t));
  }
  // a tip of radius 0.15 folds inside a cell: the sign rule never closes
  const Trace sharp = trace(lattice::ellipse(60, 3), Method::half_step, {}, 5'000);
  CHECK_FALSE(sharp.end_reached);
}

TEST_CASE("lattice: parabolas by half-step and by odd numbers are one path, within half a step") {
  const struct {
    std::int64_t p;
    double euclid;
  } rows[] = {{1, 0}, {5, 0}, {20, .703}, {100, .706}};
  for (const auto& row : rows) {
    for (const std::int64_t p : {row.p, -row.p})
      for (const bool down : {true, false}) {
        const ParabolaCurve parabola{p, down ? 120 : -120, down ? -120 : 120};
        const Trace half = trace(parabola, Method::half_step, {}, 40'000);
        const Trace odd = trace(parabola, Method::progression, {}, 40'000);
        CHECK(half.end_reached);
        CHECK(half.complete);
        CHECK(odd.end_reached);
        CHECK(half.hash == odd.hash);
        if (p < 20 || !down) continue;
        const Distance d = distance(
            half, [&](double y) { return std::pair(y * y / (2.0 * static_cast<double>(p)), y); }, -123, 123,
            20'000);
        CHECK(d.euclid == doctest::Approx(row.euclid).epsilon(5e-3));
        CHECK(d.square <= 0.5 + 1e-2);
      }
  }
}

TEST_CASE("lattice: a parabola marched by differences meets the nearest node of every y") {
  lattice::MethodOptions options;
  options.fraction_bits = 40;
  const ParabolaCurve parabola{7, -50, 50};
  const Trace t = trace(parabola, Method::newton, options);
  CHECK(t.end_reached);
  const std::vector<PlaneNode> at = nodes(t);
  // before each Y step, and at the end, X is the node nearest to y^2/14
  for (std::size_t i = 0; i + 1 < at.size(); ++i)
    if (at[i + 1].y != at[i].y) CHECK(2 * std::abs(14 * at[i].x - at[i].y * at[i].y) <= 14);
  // with one fraction bit the sum of 100 points has drifted away: N^2/2 2^-2 = 1250 at most
  options.fraction_bits = 1;
  CHECK_FALSE(trace(parabola, Method::newton, options).end_reached);
}

TEST_CASE(
    "lattice: y = p(x)/c marched by differences meets the nearest node of every x, either way and turned") {
  // 6400 y = x^3 - 30 x^2 + 7, cubic: third differences are constant
  const lattice::Polynomial f({{6400, 0, 1}, {-1, 3, 0}, {30, 2, 0}, {-7, 0, 0}});
  const lattice::Polynomial turned({{6400, 1, 0}, {-1, 0, 3}, {30, 0, 2}, {-7, 0, 0}});
  CHECK(lattice::explicit_axis(f) == 1);
  CHECK(lattice::explicit_axis(turned) == 0);
  CHECK(lattice::explicit_axis(lattice::ellipse(5, 3).f) == -1);
  CHECK(lattice::explicit_axis(lattice::Polynomial({{2, 0, 1}, {-2, 0, 1}, {1, 2, 0}})) == -1);  // 2 y - 2 y
  CHECK(lattice::explicit_axis(lattice::Polynomial({{1, 0, 1}, {1, 1, 1}, {1, 2, 0}})) == -1);   // y + x y
  const auto p = [](std::int64_t u) { return u * u * u - 30 * u * u + 7; };
  // nearest to p/6400, from a half upwards
  const auto nearest = [&](std::int64_t u) {
    return static_cast<std::int64_t>(std::floor(static_cast<double>(p(u)) / 6400 + 0.5));
  };
  lattice::MethodOptions options;
  options.fraction_bits = 44;
  for (const bool y_of_x : {true, false})
    for (const std::int64_t way : {1, -1}) {
      const std::int64_t from = -130 * way, to = 130 * way;
      const PlaneNode begin = y_of_x ? PlaneNode{from, nearest(from)} : PlaneNode{nearest(from), from},
                      end = y_of_x ? PlaneNode{to, nearest(to)} : PlaneNode{nearest(to), to};
      const Trace t =
          trace(lattice::ImplicitCurve{y_of_x ? f : turned, begin, end, 1}, Method::newton, options);
      CHECK(t.end_reached);
      const std::vector<PlaneNode> at = nodes(t);
      int met = 0;
      for (std::size_t i = 0; i + 1 < at.size(); ++i) {
        const std::int64_t u = y_of_x ? at[i].x : at[i].y, v = y_of_x ? at[i].y : at[i].x;
        if (u == (y_of_x ? at[i + 1].x : at[i + 1].y)) continue;
        CHECK(v == nearest(u));
        ++met;
      }
      CHECK(met == 260);
      // with few bits the sum drifts, N^3/3! 2^-(B + 1) at most, and the end is missed
      options.fraction_bits = 4;
      CHECK_FALSE(trace(lattice::ImplicitCurve{y_of_x ? f : turned, begin, end, 1}, Method::newton, options)
                      .end_reached);
      options.fraction_bits = 44;
    }
  // values beyond 128 bits are refused: y = x^6 at x = 20000 is 6.4e25
  const lattice::Polynomial steep({{1, 0, 1}, {-1, 6, 0}});
  CHECK(lattice::make_stepper(lattice::ImplicitCurve{steep, {20'000, 0}, {20'005, 0}, 1}, Method::newton)
            .refusal == lattice::Refusal::range);
  CHECK(lattice::make_stepper(lattice::ellipse(5, 3), Method::newton).refusal ==
        lattice::Refusal::other_curve);
}

TEST_CASE("lattice: cubic, rotated ellipse and Cassini oval stay within half a step") {
  // 6400 y = x^3 from (-120, -270)
  const ImplicitCurve cubic{Polynomial({{6400, 0, 1}, {-1, 3, 0}}), {-120, -270}, {120, 270}, -1};
  const Trace c = trace(cubic, Method::half_step);
  CHECK(c.end_reached);
  CHECK(distance(
            c, [](double x) { return std::pair(x, x * x * x / 6400); }, -123, 123, 30'000)
            .square <= 0.505);
  // 5x^2 - 6xy + 5y^2 = 7200: axes 60 and 30 at 45 degrees; once around from the node next to the tip
  const ImplicitCurve turned{
      Polynomial({{5, 2, 0}, {-6, 1, 1}, {5, 0, 2}, {-7200, 0, 0}}), {42, 42}, {42, 42}, 1};
  const Trace e = trace(turned, Method::half_step, {}, 1'000);
  const auto at = [](double u) {
    const double p = 60 * std::cos(u), q = 30 * std::sin(u), r = std::sqrt(0.5);
    return std::pair((p - q) * r, (p + q) * r);
  };
  CHECK(distance(e, at, 0, 2 * M_PI, 20'000).square <= 0.5 + 1e-2);
  // (x^2 + y^2)^2 - 5000 (x^2 - y^2) = 54^4 - 50^4, waisted, from (74, 0)
  const std::int64_t k = 54LL * 54 * 54 * 54 - 50LL * 50 * 50 * 50;
  const ImplicitCurve oval{
      Polynomial({{1, 4, 0}, {2, 2, 2}, {1, 0, 4}, {-5000, 2, 0}, {5000, 0, 2}, {-k, 0, 0}}),
      {74, 0},
      {74, 0},
      1};
  const Trace o = trace(oval, Method::half_step, {}, 5'000);
  CHECK(o.end_reached);
  CHECK(o.slots.size() == 448);
}

TEST_CASE("lattice: quadratic Beziers as integer conics meet their ends") {
  std::mt19937 random(static_cast<unsigned>(kadr::test::property_seed(11)));
  const auto draw = [&](int reach) {
    return static_cast<int>(random() % static_cast<unsigned>(2 * reach + 1)) - reach;
  };
  int curves = 0;
  for (int i = 0; i < (full_sweep() ? 3'000 : 200); ++i) {
    lattice::BezierCurve q{2, 2, {}};
    q.control[1] = {draw(80), draw(80)};
    q.control[2] = {draw(80), draw(80)};
    // the sign rule needs the whole parabola not to fold inside a cell, beyond the Bezier's ends too: its
    // vertex has the radius D^2/(2 |a|^3)
    const auto p = [&](std::size_t j, std::size_t k) { return static_cast<double>(q.control[j][k]); };
    const double a1 = p(2, 0) - 2 * p(1, 0), a2 = p(2, 1) - 2 * p(1, 1);
    const double d = 2 * (a2 * p(1, 0) - a1 * p(1, 1));
    if (!(d * d >= 2 * std::pow(std::hypot(a1, a2), 3))) continue;
    const Trace t = trace(q, Method::half_step, {}, 3'000);
    if (lattice::make_stepper(q, Method::half_step).refusal == lattice::Refusal::in_line) continue;
    ++curves;
    CHECK(t.end_reached);
    // the events of the same curve are within the same half step, found by another method
    const Trace events = trace(q, Method::crossing);
    CHECK(events.end_reached);
    const auto at = [&](double u) {
      const auto x = [&](std::size_t k) {
        return 2 * u * (1 - u) * static_cast<double>(q.control[1][k]) +
               u * u * static_cast<double>(q.control[2][k]);
      };
      return std::pair(x(0), x(1));
    };
    if (curves % 20 == 0) CHECK(distance(t, at, 0, 1, 4'000).euclid <= std::sqrt(0.5) + 1e-2);
  }
  CHECK(curves > 50);
}

TEST_CASE("lattice: a conic of 2^29 steps keeps to 128 bits; in line it is no conic") {
  const std::int64_t m = std::int64_t{1} << 29;
  lattice::BezierCurve q{2, 2, {}};
  q.control[1] = {m, -m};
  q.control[2] = {-m, -m};
  const Trace t = trace(q, Method::half_step, {}, 100'000);
  CHECK(t.slots.size() == 100'000);
  // near its beginning the parabola is its tangent (1, -1): x + y = x^2 (2 P1 - P2 ...)/... is below a step
  CHECK(std::abs(t.end[0] + t.end[1]) <= 3);
  q.control[1] = {m + 1, 0};
  CHECK(lattice::make_stepper(q, Method::half_step).refusal == lattice::Refusal::range);
  q.control[1] = {10, 10};
  q.control[2] = {30, 30};
  CHECK(lattice::make_stepper(q, Method::half_step).refusal == lattice::Refusal::in_line);
  CHECK(lattice::make_stepper(q, Method::crossing).refusal == lattice::Refusal::none);
  CHECK(lattice::make_stepper(lattice::ellipse(1 << 20, 1 << 20), Method::half_step).refusal ==
        lattice::Refusal::none);
  CHECK(lattice::make_stepper(ParabolaCurve{0, 1, 2}, Method::half_step).refusal ==
        lattice::Refusal::no_length);
  CHECK(lattice::make_stepper(ParabolaCurve{1, 1 << 20, 2}, Method::half_step).refusal ==
        lattice::Refusal::range);
}

TEST_CASE("lattice: Newton's polynomial has the errors of the study, and diverges on Runge's function") {
  const struct {
    const char* name;
    double (*f)(double);
    double to;
    std::vector<std::pair<std::size_t, double>> worst;
  } rows[] = {{"octant",
               [](double x) { return std::sqrt(1e6 - x * x); },
               707.1,
               {{2, 6.582}, {3, 1.539}, {4, .3548}, {6, .02925}, {8, .002965}}},
              {"to 0.9 R",
               [](double x) { return std::sqrt(1e6 - x * x); },
               900,
               {{2, 34.3}, {3, 13.15}, {4, 5.629}, {6, 1.364}, {8, .3958}, {12, .04388}}},
              {"half wave",
               [](double x) { return 500 * std::sin(x / 1000 * M_PI); },
               1000,
               {{2, 28}, {3, 21.81}, {4, .9061}, {6, .01693}, {8, 2.087e-4}}},
              {"Runge",
               [](double x) { return 1000 / (1 + 25 * (x / 500 - 1) * (x / 500 - 1)); },
               1000,
               {{2, 646.2}, {3, 707}, {4, 438.4}, {6, 616.8}, {8, 1045}, {12, 3658}}}};
  for (const auto& row : rows)
    for (const auto& [degree, expected] : row.worst) {
      const auto n = static_cast<double>(degree);
      std::vector<double> values;
      for (std::size_t i = 0; i <= degree; ++i) values.push_back(row.f(row.to / n * static_cast<double>(i)));
      const lattice::ForwardDifferences p(values);
      double worst = 0;
      for (int q = 0; q <= 400; ++q)
        worst = std::max(worst, std::fabs(p.value(q / 400.0 * n) - row.f(row.to * q / 400)));
      CAPTURE(row.name);
      const std::size_t order = degree;
      CAPTURE(order);
      CHECK(worst == doctest::Approx(expected).epsilon(2e-3));
    }
}

TEST_CASE("lattice: marching a cubic in fixed point drifts within N^3/3! 2^-(B+1)") {
  const double expected[2][2] = {{0.0112, 1.03}, {1.22e-7, 1.85e-5}};  // 32, 48 bits; 1024, 4096 points
  for (const int b : {0, 1})
    for (const int m : {0, 1}) {
      const double n = m == 0 ? 1024 : 4096;
      const int bits = b == 0 ? 32 : 48;
      const double c3 = 300 / std::exp(1.0) / (n * n * n), c2 = -200 / M_PI / (n * n),
                   c1 = 100 / std::sqrt(2.0) / n;
      const auto f = [&](double i) { return c3 * i * i * i + c2 * i * i + c1 * i; };
      lattice::FixedMarch march(lattice::ForwardDifferences({f(0), f(1), f(2), f(3)}), bits);
      for (int i = 0; i < n; ++i) march.next();
      const double drift = std::fabs(march.value() - f(n));
      CHECK(drift == doctest::Approx(expected[b][m]).epsilon(0.02));
      CHECK(drift <= n * n * n / 6 * std::ldexp(1.0, -(bits + 1)));
    }
  // B >= log2(N^n/n!) + 9 for 0.001
  CHECK(lattice::march_bits(3, 4096, 0.001) == 43);
}
