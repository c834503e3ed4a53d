#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

/// Polar words, X as a diameter, and M70 to M73; every case was compared with rs274.
namespace {

void check_points(const std::string& text, const std::vector<std::pair<double, double>>& expected) {
  const Outcome outcome = run(text);
  CAPTURE(text);
  CAPTURE(outcome.rendered);
  REQUIRE(outcome.moves().size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CAPTURE(i);
    CHECK(outcome.moves()[i].end[0] == doctest::Approx(expected[i].first).epsilon(1e-9));
    CHECK(outcome.moves()[i].end[1] == doctest::Approx(expected[i].second).epsilon(1e-9));
  }
}

double x_of(const std::string& text) { return last_point(text)[0]; }

}  // namespace

TEST_CASE("polar words give radius and angle from the origin, each alone keeps the other") {
  // 10 mm at 30 degrees: 5 sqrt 3 and 5; at 60: 5 and 5 sqrt 3; 20 mm there: twice that
  check_points("G0 @10 ^30\n^60\n@20\nM2\n", {{8.660254038, 5}, {5, 8.660254038}, {10, 17.320508076}});
  check_points("G0 X3 Y4\n^90\n@7\nM2\n", {{3, 4}, {0, 5}, {0, 7}});
  check_points("G20 G0 @1 ^90\nM2\n", {{0, 25.4}});
  // the line's own plane does not matter
  check_points("G18 G0 @10 ^90\nM2\n", {{0, 10}});
  check_points("F100 G0 X5\nG3 @5 ^90 I-5\nM2\n", {{5, 0}, {0, 5}});
}

TEST_CASE("under G91 polar words add to radius and angle of the present point") {
  // (3, 4) turned by 90 degrees is (-4, 3), at radius 5; 5 mm more double it; then radius 15 at -30 degrees
  check_points("G0 X3 Y4\nG91 ^90\n@5\n@5 ^-30\nM2\n",
               {{3, 4}, {-4, 3}, {-8, 6}, {-5.892304845, 13.794228634}});
}

TEST_CASE("the origin of polar words is that of the work system, turned with it") {
  // 10 mm at 30 degrees in a system at (5, 6) turned by 30: at 60 degrees from there
  check_points("G10 L2 P1 X5 Y6 R30\nG0 @10 ^30\nM2\n", {{10, 14.660254038}});
}

TEST_CASE("polar words are refused at the origin, beside X or Y, and without a motion") {
  CHECK(only_code("G0 @10 Z5\nM2\n") == Code::polar_origin);
  CHECK(only_code("G91 G0 @10 ^30\nM2\n") == Code::polar_origin);
  CHECK(only_code("G0 @10 X5\nM2\n") == Code::polar_and_axis);
  CHECK(only_code("G92 @5\nM2\n") == Code::polar_place);
  CHECK(only_code("G28 @5 ^10\nM2\n") == Code::polar_place);
  CHECK(only_code("G53 G0 @5 ^10\nM2\n") == Code::polar_place);
  CHECK(only_code("@5 ^3\nM2\n") == Code::axis_words_without_motion);
}

TEST_CASE("G7 reads X as a diameter, in moves and in offsets, from its own line on") {
  CHECK(x_of("G7 X5 G0\nM2\n") == 2.5);
  CHECK(x_of("G7\nG0 X5\nG91 X5\nM2\n") == 5);
  CHECK(x_of("G7\nG0 X5\nG8 X6\nM2\n") == 6);
  CHECK(x_of("G7\nG53 G0 X7\nM2\n") == 3.5);
  // G92 X4 names the point radius 2: back to X0 is 2 mm further in
  CHECK(x_of("G7\nG0 X10\nG92 X4\nX0\nM2\n") == 3);
  CHECK(x_of("G7\nG10 L2 P1 X6\nG0 X0\nM2\n") == 3);
}

TEST_CASE("M72 gives back the modes that M70 kept, but not the motion") {
  const std::string keep = "G91 G20 F10 G18 M3 S100 M8\nM70\nG90 G21 F200 G17 M5 M9 S5\nM72\n";
  const Outcome outcome =
      run(keep + "(PRINT,#<_feed> #<_metric> #<_incremental> #<_plane> #<_flood> #<_rpm>)\nM2\n");
  const std::vector<std::string>& trace = outcome.trace;
  // the words that differ run in the order of a line, the coolant after it
  const std::vector<std::string> given_back = {
      "SET_FEED_RATE 254.000000", "SET_SPINDLE_SPEED 0 100.000000", "START_SPINDLE_CLOCKWISE 0", "FLOOD_ON",
      "# 10.000000 0.000000 1.000000 180.000000 1.000000 100.000000"};
  const auto at = std::search(trace.begin(), trace.end(), given_back.begin(), given_back.end());
  CHECK(at != trace.end());
  CHECK(only_code("F100\nG1 X1\nM70\nG2 I1\nM72\nX5\nM2\n") == Code::arc_center_missing);
  CHECK(only_code("M72\nM2\n") == Code::modal_state_missing);
  CHECK(only_code("M70\nM71\nM72\nM2\n") == Code::modal_state_missing);
}

TEST_CASE("M73 gives the modes back at the return, M70 in a sub is that sub's own") {
  CHECK(x_of("O1 sub\nM73\nG91 G20\nO1 endsub\nO1 call\nG0 X1\nX2\nM2\n") == 2);
  CHECK(x_of("O1 sub\nM70\nG91 G20\nO1 endsub\nO1 call\nG0 X1\nX2\nM2\n") == 3 * 25.4);
  CHECK(x_of("O1 sub\nM70\nG91\nM72\nO1 endsub\nG91\nM70\nG90\nO1 call\nM72\nG0 X1\nX2\nM2\n") == 3);
}

TEST_CASE("what goes wrong while modes are restored is told at the word that restores them") {
  // kept under G18 and given back under G17, with compensation on both times: the plane may not change there
  const Outcome refused = run(
      "G18 F100\nG41.1 D2\nG1 X20\nM70\nG40\nG17 G1 X50\nG41.1 D2\nG1 X90\n  M72\nG1 X99\nG40\nG0 Y9\nM2\n");
  CAPTURE(refused.rendered);
  REQUIRE(refused.diagnostics.has_errors());
  CHECK(refused.diagnostics.list().front().span == Span{0, 9, 3, 3});
}

TEST_CASE("an incremental angle of a repeated cycle goes on from hole to hole") {
  // six holes on a circle of radius 10
  const Outcome outcome = run("G0 X10 Y0 Z5 F100\nG91 G81 R-1 Z-2 ^60 L6\nM2\n");
  std::vector<AxisValues> holes;
  for (const Feed& feed : outcome.all<Feed>()) holes.push_back(feed.end);
  REQUIRE(holes.size() == 6);
  CHECK(holes[0][0] == doctest::Approx(5));
  CHECK(holes[0][1] == doctest::Approx(8.660254037844386));
  CHECK(holes[2][0] == doctest::Approx(-10));
  CHECK(holes[5][0] == doctest::Approx(10));
  CHECK(std::fabs(holes[5][1]) < 1e-12);
}

TEST_CASE("polar words end splines, and lie in the plane XY only") {
  // 5 at 30 degrees: the next move along X shows where the spline ended
  CHECK(last_point("F100\nG5 @5 ^30 I1 J1 P1 Q1\nG1 X0\n")[1] == doctest::Approx(2.5));
  CHECK(last_point("F100\nG5.1 @5 ^30 I1 J1\nG1 X0\n")[1] == doctest::Approx(2.5));
  CHECK(only_code("F100\nG5.2 P1\n@5 ^30 P1\n") == Code::nurbs_point);
  CHECK(only_code("G18\nG0 @5 ^30\n") == Code::polar_place);
  CHECK(only_code("G19\nG17 G0 @5 ^30\n") == Code::polar_place);
  CHECK(last_point("G18 G0 @5 ^30\n")[1] == doctest::Approx(2.5));
}
