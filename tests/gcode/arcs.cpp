#include <doctest/doctest.h>

#include <cmath>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

const double kPiByAcos = std::acos(-1.0);

LineOrArc arc_of(const std::string& text) {
  const Outcome outcome = run("F600\n" + text + "\n");
  CAPTURE(outcome.rendered);
  REQUIRE_FALSE(outcome.diagnostics.has_errors());
  REQUIRE_FALSE(outcome.moves().empty());
  return outcome.moves().back();
}

/// Center of the arc of a moved line, checked against both radii.
void check_center(const LineOrArc& b, double first, double second) {
  CHECK(b.center_first_mm == doctest::Approx(first).epsilon(1e-12));
  CHECK(b.center_second_mm == doctest::Approx(second).epsilon(1e-12));
}

}  // namespace

TEST_CASE("a quarter by its centre and by its radius is the same arc of length pi/2 times 10") {
  for (const char* text : {"G3 X10 Y10 I0 J10", "G3 X10 Y10 R10", "G90.1 G3 X10 Y10 I0 J10"}) {
    const LineOrArc b = arc_of(text);
    check_center(b, 0, 10);
    CHECK(b.turns == 1);
    CHECK(b.length_u == doctest::Approx(5 * kPiByAcos).epsilon(1e-14));
    CHECK(b.feed_u_s == 10);
  }
}

TEST_CASE("the sign of R chooses between the short and the long way round") {
  // from (0, 0) to (1, 0): R1 has its centre at (1/2, -+ sqrt(3)/2)
  check_center(arc_of("G2 X1 R1"), 0.5, -std::sqrt(0.75));
  check_center(arc_of("G3 X1 R1"), 0.5, std::sqrt(0.75));
  check_center(arc_of("G2 X1 R-1"), 0.5, std::sqrt(0.75));
  check_center(arc_of("G3 X1 R-1"), 0.5, -std::sqrt(0.75));
  CHECK(arc_of("G2 X1 R1").length_u == doctest::Approx(kPiByAcos / 3).epsilon(1e-12));
  CHECK(arc_of("G2 X1 R-1").length_u == doctest::Approx(5 * kPiByAcos / 3).epsilon(1e-12));
}

TEST_CASE("a full circle ends where it starts, further turns add whole circles") {
  CHECK(arc_of("G3 I5").length_u == doctest::Approx(10 * kPiByAcos).epsilon(1e-14));
  CHECK(arc_of("G2 I5 P3").length_u == doctest::Approx(30 * kPiByAcos).epsilon(1e-14));
  CHECK(arc_of("G2 I5 P3").turns == -3);
  CHECK(arc_of("G3 X10 I5 P2").length_u == doctest::Approx(15 * kPiByAcos).epsilon(1e-14));
}

TEST_CASE("a helix measures along the screw: 3 mm radius, one turn, pitch 8 pi gives 10 pi") {
  // sqrt((2 pi 3)^2 + (8 pi)^2) = pi sqrt(36 + 64) = 10 pi
  const LineOrArc b = arc_of("G3 I3 Z[8*ACOS[-1]/180*3.14159265358979323846]");
  CHECK(b.length_u == doctest::Approx(10 * kPiByAcos).epsilon(1e-13));
  CHECK(b.feed_length == FeedLength::xyz);
}

TEST_CASE("each plane is right-handed: G3 turns from its first to its second axis") {
  // XY: from (10,0) about the origin to (0,10)
  CHECK(arc_of("G17 G0 X10\nG3 X0 Y10 I-10").length_u == doctest::Approx(5 * kPiByAcos).epsilon(1e-13));
  // ZX: first axis Z, second X: a quarter counter-clockwise goes from +Z to +X
  const LineOrArc zx = arc_of("G18 G0 Z10\nG3 X10 Z0 I0 K-10");
  CHECK(zx.length_u == doctest::Approx(5 * kPiByAcos).epsilon(1e-13));
  CHECK(zx.plane == Plane::zx);
  check_center(zx, 0, 0);
  CHECK(arc_of("G18 G0 Z10\nG2 X10 Z0 I0 K-10").length_u == doctest::Approx(15 * kPiByAcos).epsilon(1e-13));
  // YZ
  CHECK(arc_of("G19 G0 Y10\nG3 Y0 Z10 J-10").length_u == doctest::Approx(5 * kPiByAcos).epsilon(1e-13));
}

TEST_CASE("the trace names the plane and gives the centre in its axis order") {
  const Outcome outcome = run("F600\nG18 G3 X4 Z0 I2\n");
  CHECK(
      outcome.trace[1] ==
      "ARC_FEED 4.000000 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000 XZ 0.000000 "
      "2.000000 1");
}

TEST_CASE("absolute centres respect offsets and units") {
  check_center(arc_of("G10 L2 P1 X100\nG54\nG90.1\nG0 X0 Y0\nG3 X2 Y0 I1 J0"), 101, 0);
  check_center(arc_of("G20\nG2 X2 I1"), 25.4, 0);
  check_center(arc_of("G91 G0 X5\nG2 X2 I1"), 6, 0);
}

TEST_CASE("an arc's end may be off by 0.0283 mm or 0.1 % of the radius, and never by 2.83 mm") {
  // radius 5, end radius 5 + e
  CHECK_FALSE(run("F1 G2 X10.028 I5\n").diagnostics.has_errors());
  CHECK(only_code("F1 G2 X10.029 I5\n") == Code::arc_end_off_circle);
  // radius 100: 0.1 % of the larger radius 100.1 is 0.1001
  CHECK_FALSE(run("F1 G2 X200.1 I100\n").diagnostics.has_errors());
  CHECK(only_code("F1 G2 X200.101 I100\n") == Code::arc_end_off_circle);
  // radius 5000: 2.83 mm caps the 5 mm of 0.1 %
  CHECK_FALSE(run("F1 G2 X10002.8 I5000\n").diagnostics.has_errors());
  CHECK(only_code("F1 G2 X10002.84 I5000\n") == Code::arc_end_off_circle);
  // in inches the limit is 0.00283 in = 0.0719 mm
  CHECK_FALSE(run("G20\nF1 G2 X2.0028 I1\n").diagnostics.has_errors());
  CHECK(only_code("G20\nF1 G2 X2.0029 I1\n") == Code::arc_end_off_circle);
}

TEST_CASE("an arc that passes by tolerance only is told, an exact one is not") {
  CHECK(run("F1 G2 X10.02 I5\n").codes() == std::vector<Code>{Code::arc_by_tolerance});
  CHECK(run("F1 G2 X10.009 I5\n").codes().empty());
}

TEST_CASE("a radius short by up to 0.00127 mm is a half circle") {
  const Outcome outcome = run("F1 G2 X2 R0.999\n");
  CHECK(outcome.codes() == std::vector<Code>{Code::arc_by_tolerance});
  check_center(outcome.moves()[0], 1, 0);
  CHECK(outcome.moves()[0].length_u == doctest::Approx(kPiByAcos).epsilon(1e-12));
  CHECK(run("F1 G2 X2 R1\n").codes().empty());
  CHECK(only_code("F1 G2 X2 R0.998\n") == Code::arc_radius_too_small);
}

TEST_CASE("R a little over the half distance bulges to the right side") {
  // h = 1, R = 1.0001: offset sqrt(R^2 - 1) = 0.0141425, centre below the chord for G2
  const LineOrArc b = arc_of("G2 X2 R1.0001");
  check_center(b, 1, -std::sqrt(1.0001 * 1.0001 - 1));
  CHECK(b.length_u < kPiByAcos);
}

TEST_CASE("arcs that can't be are refused each with its own code") {
  CHECK(only_code("F1 G2 X5\n") == Code::arc_center_missing);
  CHECK(only_code("F1 G90.1 G2 X5 I1\n") == Code::arc_center_missing);
  CHECK(only_code("F1 G2 X5 I1 R5\n") == Code::arc_format_mixed);
  CHECK(only_code("F1 G2 X5 K1\n") == Code::arc_offset_outside_plane);
  CHECK(only_code("F1 G18 G2 X5 J1\n") == Code::arc_offset_outside_plane);
  CHECK(only_code("F1 G2 R5\n") == Code::arc_radius_undetermined);
  CHECK(only_code("F1 G2 X5 I0\n") == Code::arc_radius_zero);
  CHECK(only_code("F1 G2 X2 I1 P0\n") == Code::word_out_of_range);
  CHECK(only_code("F1 G2 X2 I1 P1.5\n") == Code::word_not_whole);
  CHECK(only_code("F1 G2 X2 R0\n") == Code::arc_radius_too_small);
}

TEST_CASE("the centre lies at the same distance from both ends for random arcs of given radius") {
  Random random(seed());
  for (std::uint64_t i = 0; i < count(2000); ++i) {
    const double x = random.real(-100, 100), y = random.real(-100, 100);
    const double half = std::sqrt(x * x + y * y) / 2;
    const double radius = half * random.real(1.0001, 5) * (random.chance(0.5) ? 1 : -1);
    char text[128];
    std::snprintf(text, sizeof text, "F1 G%d X%.9f Y%.9f R%.9f\n", random.chance(0.5) ? 2 : 3, x, y, radius);
    CAPTURE(text);
    const Outcome outcome = run(text);
    REQUIRE(outcome.moves().size() == 1);
    const LineOrArc b = outcome.moves()[0];
    const double start = std::hypot(b.center_first_mm, b.center_second_mm);
    const double end = std::hypot(b.center_first_mm - b.end[0], b.center_second_mm - b.end[1]);
    REQUIRE(start == doctest::Approx(std::fabs(radius)).epsilon(1e-9));
    REQUIRE(end == doctest::Approx(std::fabs(radius)).epsilon(1e-9));
    // R > 0: at most half a turn
    REQUIRE((b.length_u <= kPiByAcos * std::fabs(radius) * (1 + 1e-9)) == (radius > 0));
  }
}
