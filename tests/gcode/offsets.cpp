#include <doctest/doctest.h>

#include <cmath>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

void check_point(const AxisValues& at, double x, double y, double z = 0) {
  CHECK(at[0] == doctest::Approx(x).epsilon(1e-12));
  CHECK(at[1] == doctest::Approx(y).epsilon(1e-12));
  CHECK(at[2] == doctest::Approx(z).epsilon(1e-12));
}

}  // namespace

TEST_CASE("G92.1 G92.2 G92.3 stand beside other codes and act behind them") {
  // G28 goes to the machine's 0 while G92 X5 still holds; then X1 is the machine's 1
  const Outcome outcome = run("G92 X5\nG0 X1\nG92.2 G28\nG0 X1\n");
  CHECK_FALSE(outcome.diagnostics.has_errors());
  CHECK(outcome.moves()[2].end[0] == 0);
  CHECK(outcome.moves()[3].end[0] == 1);
  CHECK(last_point("G92 X5\nG92.2 G53 G0 X7\n")[0] == 7);
  CHECK(only_code("G92.1 G92.2\n") == Code::modal_conflict);
}

TEST_CASE("G10 L2 R turns the work system about its zero point") {
  // 90 degrees: program (3, 1) lies at (-1, 3) from the zero point (10, 20)
  check_point(last_point("G10 L2 P1 X10 Y20 R90\nG0 X3 Y1\n"), 9, 23);
  // 30 degrees: (2, 0) lies at (2 cos 30, 2 sin 30) = (sqrt 3, 1)
  check_point(last_point("G10 L2 P2 R30\nG55 G0 X2\n"), std::sqrt(3.0), 1);
  // G91 moves along the turned axes: on from there by (0, 2), which is (-1, sqrt 3)
  check_point(last_point("G10 L2 P1 R30\nG0 X2\nG91 Y2\n"), std::sqrt(3.0) - 1, 1 + std::sqrt(3.0));
  // the angle is parameter 5230, of G55 5250
  CHECK(last_point("G10 L2 P1 R30\nG10 L2 P2 R-7.5\n#1=#5230 #2=#5250\nG10 L2 P1 R0\nG0 X#1 Z#2\n")[0] == 30);
  CHECK(last_point("G10 L2 P2 R-7.5\nG0 Z#5250\n")[2] == -7.5);
}

TEST_CASE("G92 and G52 act inside the rotation") {
  // 90 degrees, here (1, 2): G92 X0 moves the zero by 1 along the turned X; then program (1, 1) is
  // (1 + 1, 1) before the turn, (-1, 2) after it
  check_point(last_point("G10 L2 P1 R90\nG0 X1 Y2\nG92 X0\nG0 X1 Y1\n"), -1, 2);
  // G52 X1 Y2: program (3, 4) is (4, 6) of the work system, turned by 90 degrees (-6, 4)
  check_point(last_point("G10 L2 P1 R90\nG52 X1 Y2\nG0 X3 Y4\n"), -6, 4);
}

TEST_CASE("G52 sets the offset of the axes that it names, G92.1 G92.2 G92.3 act on it") {
  check_point(last_point("G52 X5 Y6\nG52 X1\nG0 X0 Y0\n"), 1, 6);
  check_point(last_point("G0 X9\nG52 X5\nG92.2\nG0 X0 Y0\n"), 0, 0);
  check_point(last_point("G52 X5\nG92.2\nG92.3\nG0 X0\n"), 5, 0);
  check_point(last_point("G52 X5\nG92.1\nG92.3\nG0 X0\n"), 0, 0);
  // 5210: is it in force, 5211: its X in mm
  check_point(last_point("G20 G52 X1\n#1=#5210 #2=#5211\nG21 G92.1\nG0 X#1 Y#2 Z#5210\n"), 1, 25.4, 0);
}

TEST_CASE("G10 L20 lets the present point read what its words say, in any system") {
  // at (3, 4): in G55, turned by 90 degrees, it shall read (1, 2), which lies at (-2, 1): zero at (5, 3)
  const std::string program = "G10 L2 P2 R90\nG0 X3 Y4\nG10 L20 P2 X1 Y2\nG55\n";
  check_point(last_point(program + "#1=#5420 #2=#5421\nG54 G0 X#1 Y#2\n"), 1, 2);
  check_point(last_point(program + "G0 X0 Y0\n"), 5, 3);
  // an axis that is not named keeps its reading: Y of the turned system stays 0 - 3 = -3 ... X' = Y, Y' = -X
  check_point(last_point("G10 L2 P2 R90\nG0 X3 Y4\nG10 L20 P2 X0\nG55\n#1=#5420 #2=#5421\nG54 G0 X#1 Y#2\n"),
              0, -3);
}

TEST_CASE("G28 under a rotation moves along the turned axes") {
  // turned by 90 degrees about (10, 20): here (1, 2) is (8, 21); machine zero is program (-20, 10)
  const Outcome outcome = run("G10 L2 P1 X10 Y20 R90\nG0 X1 Y2\nG28 X5\nG28\n");
  REQUIRE(outcome.moves().size() == 5);
  check_point(outcome.moves()[1].end, 8, 25);  // program (5, 2)
  check_point(outcome.moves()[2].end, 8, 0);   // program (-20, 2)
  check_point(outcome.moves()[4].end, 0, 0);
}

TEST_CASE("G53 moves in machine coordinates whatever offsets hold") {
  const std::string offsets = "G10 L2 P1 X10 Y20 Z3 R30\nG52 X1 Y1\nG43.1 Z7\nG0 X4 Y5 Z6\n";
  const AxisValues before = last_point(offsets);
  check_point(last_point(offsets + "G53 G0 X2\n"), 2, before[1], before[2]);
  check_point(last_point(offsets + "G53 G0 X0 Y0 Z0\n"), 0, 0, 0);
}

TEST_CASE("parameters of a work system take effect with the change to it") {
  check_point(last_point("#5221=10\nG54 G0 X1\n"), 1, 0);
  check_point(last_point("#5221=10\nG55\nG54 G0 X1\n"), 11, 0);
}

TEST_CASE("an arc in XZ under a rotation is computed in the work system") {
  // a half circle of program X 0 to 4 about X2, turned by 30 degrees: the end (4 cos 30, 4 sin 30), the
  // centre half way
  const Outcome outcome = run("F100 G10 L2 P1 R30\nG18 G2 X4 I2\n");
  REQUIRE_FALSE(outcome.diagnostics.has_errors());
  const LineOrArc arc = outcome.moves().back();
  check_point(arc.end, 2 * std::sqrt(3.0), 2);
  CHECK(arc.center_first_mm == doctest::Approx(0));
  CHECK(arc.center_second_mm == doctest::Approx(std::sqrt(3.0)));
  CHECK(arc.plane_rotation_deg == 30);
  CHECK(arc.length_u == doctest::Approx(2 * std::acos(-1.0)));
}

TEST_CASE("a rotation that changes under G92 loses the place as RS-274/NGC does, with a warning") {
  // G52 X2 under no rotation; turned by 90 degrees the offset lies along Y: the controller takes the tool to
  // be (-2, 2) off, so that a move of Z alone moves X and Y there
  const Outcome outcome = run("G52 X2\nG10 L2 P1 R90\nG0 Z1\n");
  CHECK(outcome.codes() == std::vector<Code>{Code::rotation_under_g92});
  check_point(outcome.moves().back().end, -2, 2, 1);
}

TEST_CASE("words that an offset code can't use are refused") {
  CHECK(only_code("G52\n") == Code::word_missing);
  CHECK(only_code("G52 X1 G0\n") == Code::axis_words_wanted_twice);
  CHECK(only_code("G10 L20 P1 R5\n") == Code::word_unused);
  CHECK(only_code("G10 L2 P1 I5\n") == Code::word_unused);
  CHECK(only_code("G10 L2 P10 X1\n") == Code::word_out_of_range);
  CHECK(only_code("G10 L3 P1 X1\n") == Code::word_out_of_range);
  CHECK(only_code("G10 L2 X1\n") == Code::word_missing);
  CHECK(only_code("#5413=1\n") == Code::parameter_read_only);
  CHECK_FALSE(run("#5414=1\n").diagnostics.has_errors());
}
