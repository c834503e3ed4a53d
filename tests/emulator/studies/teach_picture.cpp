#include <doctest/doctest.h>

#include <cmath>

#include "emulator/studies/studies.h"
#include "emulator/studies/teach/picture.h"
#include "emulator/studies/teach/sweep.h"
#include "tests/emulator/interpolator/lattice_support.h"

using namespace kadr::interpolator;
using namespace kadr::studies;
using kadr::test::Curve;
using kadr::test::Method;

namespace {

constexpr std::uint32_t kCases = 4000;

/// 2^degree F at a tested point.
lattice::Wide at(const lattice::Polynomial& f, TestedPlace p) { return f.doubled(p.x2, p.y2); }

TeachCase one(Curve curve) {
  TeachCase out;
  out.begin = lattice::begin_of(curve);
  out.axes = lattice::axes_of(curve);
  out.legs = {std::move(curve)};
  return out;
}

StepTable followed(const Curve& curve, Method method) { return follow(one(curve), method, {}).table; }

/// 2^degree F at the tested points, from the slot itself: the numbers of the step table.
bool agrees(const Curve& curve, Method method, const lattice::Polynomial& f,
            const std::vector<TestedPlace>& places, const lattice::Slot& slot) {
  const bool arc = std::holds_alternative<lattice::ArcCurve>(curve);
  switch (method) {
    case Method::classic:  // F itself, at the node
      return at(f, places[0]) == lattice::Wide{slot.tested} * (lattice::Wide{1} << f.degree());
    case Method::half_step:
    case Method::crossing:  // a circle's N is F' - 1/2, so 4 F' = 4 N + 2
      return at(f, places[0]) == (arc ? 4 * lattice::Wide{slot.tested} + 2 : lattice::Wide{slot.tested});
    case Method::diagonal: {  // next to the neighbour along the longer axis: V = -2 F where that is X, 2 F
                              // where Y
      const auto& d = std::get<lattice::LineCurve>(curve).delta;
      const bool x_leads = lattice::magnitude(d[0]) >= lattice::magnitude(d[1]);
      return at(f, places[0]) == (x_leads ? -1 : 1) * lattice::Wide{slot.tested};
    }
    case Method::extra_points:
    case Method::octant_midpoint:
      return at(f, places[0]) == slot.tested && at(f, places[1]) == slot.tested_y;
    case Method::magnitudes: {  // |F(i, j+1)| - |F(i+1, j)|
      const lattice::Wide x = at(f, places[0]) / 2, y = at(f, places[1]) / 2;
      return (y < 0 ? -y : y) - (x < 0 ? -x : x) == slot.tested;
    }
    case Method::printed_difference:
      return at(f, places[1]) / 2 - at(f, places[0]) / 2 == slot.tested;
    case Method::progression:  // of a parabola, N = F' - 1/4
      return at(f, places[0]) == 4 * lattice::Wide{slot.tested} + 1;
    default:
      return false;
  }
}

}  // namespace

TEST_CASE("where a method looks, F is just what its step table says") {
  std::array<int, 32> seen{};
  for (std::uint32_t n = 0; n < kCases; ++n) {
    const SweepCase c = sweep_case(n);
    const auto f = sign_polynomial(c.curve);
    const lattice::Trace trace = kadr::test::trace(c.curve, c.method, {}, 500);
    // n axes and cubics have no F; Beziers by crossings have t
    const bool events = !trace.slots.empty() && trace.slots.front().parameter >= 0;
    lattice::PlaneNode node{trace.begin[0], trace.begin[1]};
    for (const lattice::Slot& slot : trace.slots) {
      const auto places = tested_places(c.curve, c.method, node);
      if (!places.empty() && !events) {
        const bool same = agrees(c.curve, c.method, *f, places, slot);
        if (!same) {
          CAPTURE(n);
          CAPTURE(lattice::entry_of(c.method).name());
          CAPTURE(slot.tested);
          REQUIRE(same);
        }
        ++seen[static_cast<std::size_t>(c.method)];
      }
      node.x += slot.step[0];
      node.y += slot.step[1];
    }
  }
  for (const Method m :
       {Method::classic, Method::half_step, Method::crossing, Method::diagonal, Method::extra_points,
        Method::octant_midpoint, Method::magnitudes, Method::printed_difference, Method::progression})
    CHECK(seen[static_cast<std::size_t>(m)] > 100);
  // methods without a sign look nowhere
  CHECK(tested_places(kadr::test::line({7, 4}), Method::dda, {}).empty());
  CHECK(tested_places(kadr::test::line({7, 4, 3}), Method::half_step, {}).empty());
}

TEST_CASE("the corner ahead of the half-step method on line 7 4 is (1/2, 1/2) and goes on with the node") {
  // F = 7 y - 4 x: 2 F(1/2, 1/2) = 7 - 4 = 3, as the step table of paper 002 begins
  const auto places = tested_places(kadr::test::line({7, 4}), Method::half_step, {0, 0});
  REQUIRE(places.size() == 1);
  CHECK(places[0] == TestedPlace{1, 1});
  CHECK(tested_places(kadr::test::line({-7, 4}), Method::half_step, {-2, 1})[0] == TestedPlace{-5, 3});
}

TEST_CASE("the drawn curve is the curve: every place has F = 0, and it runs from end to end") {
  for (const Curve& curve : {Curve{lattice::ArcCurve{{7, 0}, {0, 7}, lattice::Turn::ccw}},
                             Curve{lattice::ellipse(12, 5)}, Curve{lattice::ParabolaCurve{3, -9, 6}},
                             Curve{lattice::BezierCurve{2, 2, {{{}, {12, 0}, {12, 9}}}}}}) {
    const StepTable table = followed(curve, Method::half_step);
    const auto f = sign_polynomial(curve);
    const std::vector<kadr::studies::Place> places = curve_places(curve, table);
    REQUIRE(places.size() > 20);
    double longest = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double fx = f->derivative_x().value(places[i].x, places[i].y),
                   fy = f->derivative_y().value(places[i].x, places[i].y);
      // distance to first order
      CHECK(std::fabs(f->value(places[i].x, places[i].y)) <= 1e-9 * std::hypot(fx, fy));
      if (i > 0)
        longest = std::max(longest, std::hypot(places[i].x - places[i - 1].x, places[i].y - places[i - 1].y));
    }
    CHECK(longest < 0.5);
    const lattice::Point end = lattice::end_of(curve);
    CHECK(std::hypot(places.back().x - static_cast<double>(end[0]),
                     places.back().y - static_cast<double>(end[1])) < 0.5);
  }
}

TEST_CASE("a deviation is measured to the place of the curve that is drawn") {
  const Curve arc = lattice::ArcCurve{{7, 0}, {0, 7}, lattice::Turn::ccw};
  const StepTable table = followed(arc, Method::half_step);
  for (const StepRow& row : table.rows) {
    const kadr::studies::Place foot = nearest_place(arc, row.node, -1);
    const double away =
        std::hypot(foot.x - static_cast<double>(row.node[0]), foot.y - static_cast<double>(row.node[1]));
    CHECK(away == doctest::Approx(std::fabs(row.deviation_steps)).epsilon(1e-9));
  }
}

TEST_CASE("the speed rose: 1 along an axis, 1/sqrt 2 or sqrt 2 across, L/(a + b) and L/max(a, b) between") {
  const auto half = speed_rose(Method::half_step, 24, 1000), both = speed_rose(Method::diagonal, 24, 1000);
  REQUIRE(half.size() == 24);
  CHECK(half[0].speed == 1.0);
  CHECK(half[3].speed == doctest::Approx(std::sqrt(0.5)).epsilon(1e-12));
  CHECK(both[3].speed == doctest::Approx(std::sqrt(2.0)).epsilon(1e-12));
  // 15 degrees: (966, 259); L = 1000.12, a + b = 1225
  CHECK(half[1].speed == doctest::Approx(std::hypot(966.0, 259.0) / 1225).epsilon(1e-12));
  CHECK(both[1].speed == doctest::Approx(std::hypot(966.0, 259.0) / 966).epsilon(1e-12));
  // a DDA takes 1024 slots whatever the direction
  CHECK(speed_rose(Method::dda, 24, 1000)[0].speed == doctest::Approx(1000.0 / 1024).epsilon(1e-12));
  CHECK(speed_rose(Method::chords, 8, 100)[0].speed == 0);
}

TEST_CASE("20,000 traces have one hash, the one that the page's core has in WebAssembly") {
  // tests/web/teach_test.mjs demands the same of the core; d508b1107e158b18 was found by g++, clang++ and wasm32
  CHECK(sweep_hash(0, 20'000) == 0xd508b1107e158b18ULL);
  // in pieces the same, and one case more or less is seen
  CHECK(sweep_hash(10'000, 10'000, sweep_hash(0, 10'000)) == 0xd508b1107e158b18ULL);
  CHECK(sweep_hash(0, 19'999) != 0xd508b1107e158b18ULL);
}

TEST_CASE("the sweep has every method and every kind of curve") {
  std::array<int, 32> methods{};
  std::array<int, 8> kinds{};
  for (std::uint32_t n = 0; n < 20'000; ++n) {
    const SweepCase c = sweep_case(n);
    ++methods[static_cast<std::size_t>(c.method)];
    ++kinds[c.curve.index()];
  }
  for (std::size_t m = 0; m < lattice::methods().size(); ++m) CHECK(methods[m] > 300);
  for (std::size_t k = 0; k < std::variant_size_v<Curve>; ++k) CHECK(kinds[k] > 1000);
}
