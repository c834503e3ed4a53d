#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "tests/emulator/interpolator/interpolator_paths.h"
#include "tests/emulator/interpolator/lattice_support.h"
#include "tests/support/seed.h"

using namespace kadr;
using namespace kadr::test;
using lattice::BezierCurve;
using lattice::BezierEvents;

namespace {

BezierCurve random_cubic(std::mt19937_64& random, int axes, int reach) {
  BezierCurve curve{axes, 3, {}};
  for (std::size_t j = 1; j < 4; ++j)
    for (std::size_t k = 0; k < static_cast<std::size_t>(axes); ++k)
      curve.control[j][k] =
          static_cast<std::int64_t>(random() % static_cast<unsigned>(2 * reach + 1)) - reach;
  return curve;
}

/// x(t) by de Casteljau, which shares no formula with the events.
double position(const BezierCurve& curve, std::size_t axis, double t) {
  double p[4];
  const auto n = static_cast<std::size_t>(curve.degree);
  for (std::size_t i = 0; i <= n; ++i) p[i] = static_cast<double>(curve.control[i][axis]);
  for (std::size_t j = n; j > 0; --j)
    for (std::size_t i = 0; i < j; ++i) p[i] += t * (p[i + 1] - p[i]);
  return p[0];
}

}  // namespace

TEST_CASE("lattice: at every event of random cubics each axis is within half a step, and every end is met") {
  const std::uint64_t count = environment_count("KADR_COUNT", 240);
  std::mt19937_64 random(kadr::test::property_seed(1));
  double worst = 0;
  std::int64_t wrong_ends = 0, back = 0, ties = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const int axes = i % 3 == 0 ? 2 : i % 3 == 1 ? 3 : 6;
    // long ones are rarer, as in the study
    const int reach = i % 400 == 6 ? 4000 : i % 2 == 0 ? 8 : 60;
    const BezierCurve curve = random_cubic(random, axes, reach);
    BezierEvents events(curve);
    std::vector<std::int64_t> node(static_cast<std::size_t>(axes), 0);
    BezierEvents::Event event;
    double before = 0;
    std::size_t axis_before = 0;
    while (events.next(event)) {
      node[event.axis] += event.direction;
      back += event.t < before;
      if (event.t == before) {
        ++ties;
        CHECK(event.axis > axis_before);
      }
      before = event.t;
      axis_before = event.axis;
      for (std::size_t k = 0; k < node.size(); ++k)
        worst = std::max(worst, std::fabs(static_cast<double>(node[k]) - position(curve, k, event.t)));
    }
    for (std::size_t k = 0; k < node.size(); ++k) wrong_ends += node[k] != curve.control[3][k];
  }
  CHECK(worst <= 0.5 + 1e-9);
  CHECK(wrong_ends == 0);
  CHECK(back == 0);
  CHECK(ties > 0);
}

TEST_CASE("lattice: events of a straight Bezier are the half-crossings of the line") {
  const BezierCurve curve{2, 1, {{{0, 0}, {7, 4}}}};
  const Trace t = trace(curve, Method::crossing);
  CHECK(letters(t) == "XYXXYXYXXYX");
  // X at (2i + 1)/14, Y at (2i + 1)/8
  CHECK(t.slots[0].parameter == doctest::Approx(1.0 / 14).epsilon(1e-14));
  CHECK(t.slots[1].parameter == doctest::Approx(1.0 / 8).epsilon(1e-14));
  CHECK(t.slots[10].parameter == doctest::Approx(13.0 / 14).epsilon(1e-14));
}

TEST_CASE("lattice: an axis that turns back steps out and in again") {
  // x = 6 t (1 - t): up to 1.5 at t = 1/2; 0.5 is crossed at t = (1 -+ sqrt(1 - 1/3))/2, 1.5 is touched
  const BezierCurve curve{2, 2, {{{0, 0}, {3, 0}, {0, 0}}}};
  const Trace t = trace(curve, Method::crossing);
  REQUIRE(t.slots.size() == 2);
  CHECK(t.slots[0].step[0] == 1);
  CHECK(t.slots[1].step[0] == -1);
  CHECK(t.slots[0].parameter == doctest::Approx((1 - std::sqrt(2.0 / 3)) / 2).epsilon(1e-12));
  CHECK(t.slots[1].parameter == doctest::Approx((1 + std::sqrt(2.0 / 3)) / 2).epsilon(1e-12));
}

TEST_CASE("lattice: pulses and every bit of t are the same with every compiler and optimisation") {
  std::mt19937_64 random(20'26);
  std::uint64_t hash = 1469598103934665603ULL;
  const auto add = [&](std::uint64_t v) { hash = (hash ^ v) * 1099511628211ULL; };
  for (int i = 0; i < 120; ++i) {
    const BezierCurve curve = random_cubic(random, 3, i % 2 == 0 ? 30 : 300);
    BezierEvents events(curve);
    BezierEvents::Event event;
    while (events.next(event)) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &event.t, sizeof bits);
      add(event.axis * 2 + (event.direction > 0));
      add(bits);
    }
  }
  CHECK(hash == 14263434291666381482ULL);
}

TEST_CASE("lattice: Beziers by events go to 2^40 steps; of other degrees and axes they are no conics") {
  BezierCurve curve{3, 3, {}};
  curve.control[3] = {std::int64_t{1} << 40, 1, -5};
  curve.control[2] = {std::int64_t{1} << 40, 0, 0};
  CHECK(trace(curve, Method::crossing, {}, 100).slots.size() == 100);
  curve.control[1][0] = (std::int64_t{1} << 40) + 1;
  CHECK(lattice::make_stepper(curve, Method::crossing).refusal == lattice::Refusal::range);
  CHECK(lattice::make_stepper(BezierCurve{}, Method::crossing).refusal == lattice::Refusal::no_length);
  CHECK(lattice::make_stepper(curve, Method::half_step).refusal == lattice::Refusal::other_curve);
}
