#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// The only spline of a program.
Spline spline_of(const std::string& program, const InterpretOptions& options = {}) {
  const Outcome outcome = run(program, options);
  INFO(outcome.rendered);
  CHECK_FALSE(outcome.diagnostics.has_errors());
  const std::vector<Spline> found = outcome.all<Spline>();
  REQUIRE_FALSE(found.empty());
  return found.back();
}

void check_point(const Spline& block, std::size_t i, double x, double y, double weight = 1) {
  CAPTURE(i);
  REQUIRE(i < block.control_points.size());
  CHECK(block.control_points[i].x_mm == doctest::Approx(x));
  CHECK(block.control_points[i].y_mm == doctest::Approx(y));
  CHECK(block.control_points[i].weight == weight);
}

}  // namespace

TEST_CASE("G5 puts its control points aside of start and end") {
  const Spline b = spline_of("F120\nG0 X1 Y1\nG5 X11 Y21 I0 J3 P-2 Q-5\n");
  REQUIRE(b.control_points.size() == 4);
  CHECK(b.order == 4);
  check_point(b, 0, 1, 1);
  check_point(b, 1, 1, 4);
  check_point(b, 2, 9, 16);
  check_point(b, 3, 11, 21);
  CHECK(b.end[0] == 11);
  CHECK(b.feed_u_s == 2);
}

TEST_CASE("a G5 without I and J goes on where the one before was heading") {
  const Spline b = spline_of("F100\nG5 X1 Y1 I0 J3 P0 Q-3\nG5 X2 Y2 P0.5 Q-3\n");
  check_point(b, 1, 1, 1 + 3);
  check_point(b, 2, 2.5, -1);
}

TEST_CASE("a G5 holds for its line: axis words go on with the motion before it") {
  const Outcome outcome = run("F100\nG0 X1\nG5 X2 Y2 I1 J1 P-1 Q0\nX5\n");
  CHECK(outcome.trace.back() == "PROGRAM_END");
  REQUIRE(outcome.moves().size() == 2);
  CHECK(outcome.moves()[1].kind == BlockKind::traverse);
  CHECK(outcome.moves()[1].end[1] == 2);
}

TEST_CASE("the parabola of G5.1 through the origin has its length in closed form") {
  // y = x^2 from -2 to 2: 2 (x sqrt(1 + 4 x^2) / 2 + asinh(2 x) / 4) at x = 2
  const Spline b = spline_of("F60\nG0 X-2 Y4\nG5.1 X2 I2 J-8\n");
  CHECK(b.order == 3);
  check_point(b, 1, 0, -4);
  const double exact = 2 * (std::sqrt(17.0) + std::asinh(4.0) / 4);
  CHECK(std::fabs(b.length_u - exact) < 1e-9 * exact);
}

TEST_CASE("a NURBS block takes its points, weights and order from its lines") {
  const std::string program = "F60\nG0 X1 Y1\nG5.2 P2 L4\nX0 Y1 P1\nX2 Y2 P0.5\nX2 Y0 P1\nX0 Y0 P3\nG5.3\n";
  const Spline b = spline_of(program);
  REQUIRE(b.control_points.size() == 5);
  CHECK(b.order == 4);
  check_point(b, 0, 1, 1, 2);
  check_point(b, 2, 2, 2, 0.5);
  check_point(b, 4, 0, 0, 3);
  const std::vector<Block> blocks = run(program).blocks;
  const auto spline =
      std::find_if(blocks.begin(), blocks.end(), [](const Block& one) { return is<Spline>(one); });
  REQUIRE(spline != blocks.end());
  CHECK(spline->span.line == 8);
  // the first point may stand on the line of G5.2, with weight 1
  const Spline short_one = spline_of("F60\nG5.2 X1 Y1\nX2 Y0 P1\nG5.3\n");
  check_point(short_one, 1, 1, 1, 1);
  CHECK(short_one.order == 3);
}

TEST_CASE("three points of weights 1, sqrt(1/2), 1 are a quarter circle") {
  const Spline b = spline_of("F60\nG0 X10\nG5.2 P1\nX10 Y10 P[SQRT[0.5]]\nX0 Y10 P1\nG5.3\n");
  CHECK(b.length_u == doctest::Approx(5 * 3.14159265358979324).epsilon(1e-10));
}

TEST_CASE("no motion holds after G5.3") {
  CHECK(only_code("F60\nG1 X1\nG5.2 P1\nX10 Y10 P1\nX0 Y10 P1\nG5.3\nX5\n") ==
        Code::axis_words_without_motion);
}

TEST_CASE("splines are read in the units, distances and work system in force") {
  const Spline inches = spline_of("G20\nF60\nG5 X1 Y2 I0 J3 P0 Q-3\n");
  check_point(inches, 1, 0, 76.2);
  CHECK(inches.feed_u_s == doctest::Approx(25.4));
  const Spline incremental = spline_of("G91 F60\nG1 X1 Y1\nG5 X1 Y2 I0 J3 P0 Q-3\n");
  check_point(incremental, 2, 2, 0);
  // a quarter turn of G54: program (x, y) is machine (-y, x)
  const Spline turned = spline_of("G10 L2 P1 R90 X100\nF60\nG5 X10 Y20 I3 J4 P-5 Q6\n");
  check_point(turned, 1, 0 + -4, 0 + 3);
  check_point(turned, 2, 100 - 26, 5);
  check_point(turned, 3, 100 - 20, 10);
  // points of a NURBS under G91 all count from the position before it
  const Spline nurbs = spline_of("F60\nG0 X1\nG91\nG5.2 P1\nX1 Y1 P1\nX2 Y0 P1\nG5.3\n");
  check_point(nurbs, 1, 2, 1);
  check_point(nurbs, 2, 3, 0);
}

TEST_CASE("a spline under G93 lasts 60 / F seconds") {
  const Spline b = spline_of("G93\nG5 X1 Y1 I0 J3 P0 Q-3 F30\n");
  CHECK(b.duration_s == 2);
  CHECK(b.feed_u_s == doctest::Approx(b.length_u / 2));
  const Spline nurbs = spline_of("G93\nG5.2 P1 F15\nX1 Y1 P1\nX2 Y0 P1\nG5.3\n");
  CHECK(nurbs.duration_s == 4);
  CHECK(only_code("G93\nG5.2 P1\nX1 Y1 P1\nX2 Y0 P1\nG5.3\n") == Code::inverse_feed_missing);
  // without F at the feed in force: 90 mm/min
  const Spline slow = spline_of("F90\nG93\nG5.2 P1\nX1 Y1 P1\nX2 Y0 P1\nG5.3\n");
  CHECK(slow.feed_u_s == doctest::Approx(1.5));
  CHECK(slow.duration_s == 0);
}

TEST_CASE("G5 of Marlin takes missing offsets as zero, without looking back") {
  InterpretOptions marlin;
  marlin.dialect = Dialect::marlin;
  const Spline b = spline_of("F60\nG5 X1 Y1 I0 J3 P0 Q-3\nG5 X2 Y2 Q-3\n", marlin);
  check_point(b, 1, 1, 1);
  check_point(b, 2, 2, -1);
  CHECK(run("F60\nG5 X2 Y2 Q-3\n", marlin).diagnostics.list().empty());
}

TEST_CASE("an error inside a NURBS block is told once, and its curve is not judged") {
  CHECK(only_code("F60\nG5.2 P1\nX1 P1\nG5.3\nG2 X9 I1\n") == Code::nurbs_point);
  CHECK(only_code("F60\nG5.2 P1\nX1.2.3 P1\nG5.3\n") == Code::bad_number);
}
