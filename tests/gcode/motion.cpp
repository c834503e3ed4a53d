#include <doctest/doctest.h>

#include <cmath>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

TEST_CASE("absolute and incremental moves reach the same points") {
  CHECK(last_point("G90 G0 X5 Y5\nG91 X-2 Z3\nG90 Y1\n") == AxisValues{3, 1, 3});
}

TEST_CASE("inches are 25.4 mm for lengths and feeds, degrees stay degrees") {
  const Outcome outcome = run("G20\nF10\nG1 X1 A90\nB45\n");
  REQUIRE(outcome.moves().size() == 2);
  CHECK(outcome.moves()[0].end[0] == 25.4);
  CHECK(outcome.moves()[0].end[3] == 90);
  // 10 in/min = 254 mm/min = 4.2333 mm/s
  CHECK(outcome.moves()[0].feed_u_s == doctest::Approx(254.0 / 60).epsilon(1e-15));
  // 10 deg/min, never scaled
  CHECK(outcome.moves()[1].feed_u_s == doctest::Approx(10.0 / 60).epsilon(1e-15));
  CHECK(outcome.trace[0] == "SET_FEED_RATE 254.000000");
}

TEST_CASE("F measures X Y Z if one of them moves, else U V W, else the rotary axes") {
  const Outcome outcome = run("F600 G1 X3 Y4 A360 U1\nA0 U13\nA90\nA0 B120\nX3 Y4\nG91 X0 Y0.0001 A360\n");
  REQUIRE(outcome.moves().size() == 6);
  const auto& m = outcome.moves();
  CHECK(m[0].feed_length == FeedLength::xyz);
  CHECK(m[0].length_u == 5);  // 3-4-5
  CHECK(m[1].feed_length == FeedLength::uvw);
  CHECK(m[1].length_u == 12);
  CHECK(m[2].feed_length == FeedLength::rotary);
  CHECK(m[2].length_u == 90);
  CHECK(m[3].length_u == 150);  // 90-120-150
  CHECK(m[4].length_u == 0);
  CHECK(m[5].feed_length == FeedLength::xyz);
  CHECK(m[5].length_u == doctest::Approx(0.0001).epsilon(1e-9));
}

TEST_CASE("rounding of offsets doesn't turn a rotary move into a linear one") {
  // 0.1 + 0.2 style residues of about 1e-17 must not count as motion of X
  const Outcome outcome = run("G0 X0.3\nG92 X0.1\nF60 G1 X0.1 A90\n");
  CHECK(outcome.moves().back().feed_length == FeedLength::rotary);
  CHECK(outcome.moves().back().length_u == 90);
}

TEST_CASE("inverse time gives each move its seconds: F2 is 30 s") {
  const Outcome outcome = run("G93\nG1 X10 F2\nX30 F60\nG94\nG1 X0 F120\n");
  CHECK_FALSE(outcome.diagnostics.has_errors());
  const auto m = outcome.moves();
  CHECK(m[0].duration_s == 30);
  CHECK(m[0].feed_u_s == doctest::Approx(10.0 / 30).epsilon(1e-15));
  CHECK(m[1].duration_s == 1);
  CHECK(m[2].duration_s == 0);
  CHECK(m[2].feed_u_s == 2);
}

TEST_CASE("a feed move without F, with F0, and under G93 without its own F is refused") {
  CHECK(only_code("G1 X5\n") == Code::feed_missing);
  CHECK(only_code("G1 X5\nX6\nX7\n") == Code::feed_missing);
  CHECK(only_code("F0 G1 X5\n") == Code::feed_zero);
  CHECK(only_code("F100 G1 X5\nG93 X6\n") == Code::inverse_feed_missing);
  CHECK(only_code("G93 G1 F0 X6\n") == Code::feed_zero);
  CHECK(only_code("G93 G1 F1 X6\nG94 X7\n") == Code::feed_missing);
}

TEST_CASE("G94 and G95 take away the feed that held before, even a repeated G94") {
  const Outcome outcome = run("F100 G1 X1\nG94\nX2\nX3\n");
  CHECK(outcome.codes() == std::vector<Code>{Code::feed_cleared});
  CHECK(outcome.trace[2] == "SET_FEED_MODE G94");
  CHECK(outcome.trace[3] == "SET_FEED_RATE 0.000000");
  CHECK(only_code("S100 F100\nG95\nG1 X2\n") == Code::feed_cleared);
  CHECK(run("F100 G1 X1\nG94\nF50 X2\n").codes().empty());
}

TEST_CASE("F is taken before the units of its line change, with a warning") {
  const Outcome outcome = run("G20 G1 X1 F10\n");
  CHECK(outcome.codes() == std::vector<Code>{Code::feed_before_units});
  CHECK(outcome.moves()[0].feed_u_s == doctest::Approx(10.0 / 60).epsilon(1e-15));
  CHECK(outcome.moves()[0].end[0] == 25.4);
}

TEST_CASE("work systems, G92 and tool length add up: machine = program + work + G92 + tool") {
  // work 100, G92 at machine 105 called 0 means offset 5, tool 10
  CHECK(last_point("G10 L2 P2 X100\nG55\nG0 X5\nG92 X0\nG43.1 X10\nX1\n")[0] == 116);
}

TEST_CASE("every work system has its own offset") {
  const char* const kSystems[] = {"54", "55", "56", "57", "58", "59", "59.1", "59.2", "59.3"};
  for (int i = 0; i < 9; ++i) {
    const std::string text = "G10 L2 P" + std::to_string(i + 1) + " X" + std::to_string(10 * (i + 1)) +
                             "\nG54\nG" + kSystems[i] + " G0 X1\n";
    CHECK(last_point(text)[0] == 10 * (i + 1) + 1);
  }
}

TEST_CASE("G10 L20 makes the present point read the given value, P0 is the system in force") {
  CHECK(last_point("G0 X7\nG10 L20 P0 X2\nX0\n")[0] == 5);
  CHECK(last_point("G0 X7\nG10 L20 P2 X2\nX0\nG55 X0\n")[0] == 5);
  CHECK(last_point("G91 G10 L2 P1 X4\nG90 G0 X1\n")[0] == 5);
}

TEST_CASE("G92 names the present point; G92.2 suspends, G92.3 restores, G92.1 clears") {
  const Outcome outcome = run("G0 X10\nG92 X4\nX0\nG92.2\nX0\nG92.3\nX0\nG92.1\nX0\nG92.3\nX0\n");
  const auto m = outcome.moves();
  CHECK(m[1].end[0] == 6);
  CHECK(m[2].end[0] == 0);
  CHECK(m[3].end[0] == 6);
  CHECK(m[4].end[0] == 0);
  CHECK(m[5].end[0] == 0);
}

TEST_CASE("G53 goes to machine coordinates whatever the offsets") {
  CHECK(last_point("G10 L2 P1 X100\nG54\nG43.1 X5\nG53 G0 X3\n")[0] == 3);
  CHECK(only_code("G91 G53 G0 X3\n") == Code::g53_misplaced);
  CHECK(only_code("F1 G53 G2 X3 I1\n") == Code::g53_misplaced);
  CHECK(only_code("G0 X1\nG53\n") == Code::g53_misplaced);
}

TEST_CASE("G28 goes by way of the named point and moves only the named axes on to the reference") {
  InterpretOptions options;
  options.g28 = {1, 2, 3};
  options.g30 = {7, 8, 9};
  const auto m = run("G0 X5 Y5 Z5\nG28 Z6\nG30\nG91 G28 X1\n", options).moves();
  REQUIRE(m.size() == 7);
  CHECK(m[1].end == AxisValues{5, 5, 6});
  CHECK(m[2].end == AxisValues{5, 5, 3});
  CHECK(m[3].end == AxisValues{5, 5, 3});
  CHECK(m[4].end == AxisValues{7, 8, 9});
  CHECK(m[5].end == AxisValues{8, 8, 9});
  CHECK(m[6].end == AxisValues{1, 8, 9});
  CHECK(m[6].kind == BlockKind::traverse);
}

TEST_CASE("G28.1 and G30.1 remember the present machine point") {
  CHECK(last_point("G0 X5\nG92 X0\nG28.1\nX9\nG28\n")[0] == 5);
  CHECK(last_point("G0 Y4\nG30.1\nY9\nG30\n")[1] == 4);
}

TEST_CASE("the start point is the machine's home") {
  InterpretOptions options;
  options.home = {1, 2, 3};
  CHECK(last_point("G91 G0 X1\n", options) == AxisValues{2, 2, 3});
}

TEST_CASE("path mode and override permission travel on each move") {
  const auto m = run("F60 G1 X1\nG64 P0.05\nX2\nM49\nG61.1\nX3\nM50\nG20\nG64 P0.01\nX0\n").moves();
  CHECK(m[0].path_mode == PathMode::continuous);
  CHECK(m[1].path_mode == PathMode::continuous);
  CHECK(m[1].path_tolerance_mm == 0.05);
  CHECK(m[1].feed_override_enabled);
  CHECK(m[2].path_mode == PathMode::exact_stop);
  CHECK_FALSE(m[2].feed_override_enabled);
  CHECK(m[3].feed_override_enabled);
  CHECK(m[3].path_tolerance_mm == doctest::Approx(0.254).epsilon(1e-15));
}

TEST_CASE("G80 beside a motion code on one line is harmless, alone it ends the motion") {
  CHECK(last_point("G0 G17 G40 G49 G80 G90\nX2\n")[0] == 2);
  CHECK(only_code("G0 X1\nG80\nX2\n") == Code::axis_words_without_motion);
  CHECK(only_code("X2\n") == Code::axis_words_without_motion);
  CHECK(only_code("G80 X1\n") == Code::axis_words_without_motion);
}

TEST_CASE("a motion code without axis words is a move of length zero") {
  const Outcome outcome = run("G0\nF10\nG1\n");
  REQUIRE(outcome.moves().size() == 2);
  CHECK(outcome.moves()[1].length_u == 0);
}

TEST_CASE("an axis that the machine lacks is refused") {
  InterpretOptions options;
  options.axis_letters = "XYZ";
  CHECK(only_code("G0 X1 A5\n", options) == Code::axis_not_on_machine);
  CHECK(only_code("G92 W0\n", options) == Code::axis_not_on_machine);
}
