#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

std::vector<LineOrArc> moves_of(const std::string& text, const InterpretOptions& options = {}) {
  const Outcome outcome = run(text, options);
  CAPTURE(outcome.rendered);
  CHECK_FALSE(outcome.diagnostics.has_errors());
  std::vector<LineOrArc> moves = outcome.moves();
  return moves;
}

/// X of each pass of a G76 program without tapers: the feed moves.
std::vector<double> pass_positions(const std::string& text) {
  std::vector<double> x;
  for (const LineOrArc& b : moves_of(text)) {
    if (b.kind == BlockKind::feed) x.push_back(b.end[0]);
  }
  return x;
}

}  // namespace

TEST_CASE("G33 moves by K for each turn of the spindle") {
  const Outcome outcome = run("G21 M3 S300\nG0 X20 Z5\nG33 Z-10 K1.5\n");
  CHECK_FALSE(outcome.diagnostics.has_errors());
  const std::vector<std::string> tail(outcome.trace.end() - 4, outcome.trace.end());
  CHECK(tail[0] == "START_SPEED_FEED_SYNC 1.500000 0");
  CHECK(tail[1].substr(0, 45) == "STRAIGHT_FEED 20.000000 0.000000 -10.000000 0");
  CHECK(tail[2] == "STOP_SPEED_FEED_SYNC");
  // 300 rpm are 5 turns per second: 7.5 mm/s
  const LineOrArc thread = outcome.moves().back();
  CHECK(thread.pitch_u_rev == 1.5);
  CHECK(thread.feed_u_s == doctest::Approx(7.5).epsilon(1e-15));
  CHECK(thread.length_u == 15);
}

TEST_CASE("the pitch of a tapered thread is along the thread") {
  // X by 3, Z by 4: 5 mm of thread at 1 mm per turn and 1 turn per second take 5 s
  const LineOrArc thread = moves_of("M3 S60\nG33 X3 Z4 K1\n").back();
  CHECK(thread.length_u == 5);
  CHECK(thread.feed_u_s == doctest::Approx(1).epsilon(1e-15));
}

TEST_CASE("K of an inch program is in inches, of a rotary move in degrees") {
  CHECK(moves_of("G20 M3 S60\nG33 Z1 K0.1\n").back().pitch_u_rev == doctest::Approx(2.54).epsilon(1e-15));
  CHECK(moves_of("G20 M3 S60\nG33 A90 K10\n").back().pitch_u_rev == 10);
}

TEST_CASE("G33.1 taps down and comes back to where it began, I times as fast") {
  const Outcome outcome = run("M3 S120\nG0 X5 Z2\nG33.1 Z-8 K1.25 I2\nG0 Y1\n");
  CHECK_FALSE(outcome.diagnostics.has_errors());
  const std::vector<RigidTap> taps = outcome.all<RigidTap>();
  REQUIRE(taps.size() == 1);
  const RigidTap& tap = taps.front();
  CHECK(tap.end[2] == -8);
  CHECK(tap.length_u == 10);
  CHECK(tap.retract_ratio == 2);
  CHECK(tap.feed_u_s == doctest::Approx(2.5).epsilon(1e-15));
  CHECK(outcome.moves().back().end == AxisValues{5, 1, 2});
}

TEST_CASE("threads need a turning spindle, their words, and no F") {
  CHECK(only_code("S100\nG33 Z-5 K1\n") == Code::thread_spindle_stopped);
  CHECK(only_code("M3 S100\nM5\nG33.1 Z-5 K1\n") == Code::thread_spindle_stopped);
  CHECK(only_code("G0 X9\nG76 P1 Z-5 I-1 J0.1 K0.5 \nG0\n", {}) != Code::broken_promise);
  CHECK(only_code("M3 S1\nG33 Z-5\n") == Code::word_missing);
  CHECK(only_code("M3 S1\nG33 K1\n") == Code::word_missing);
  CHECK(only_code("M3 S1\nG33 Z-5 K1\nZ-6\n") == Code::word_missing);
  CHECK(only_code("M3 S1\nG33 Z-5 K1 F100\n") == Code::thread_with_feed);
  CHECK(only_code("M3 S1\nG33 Z-5 K1 $1\n") == Code::word_out_of_range);
  CHECK(run("M3 S1\nG33 Z-5 K1 $0\nZ-6 K1\nM2\n").codes().empty());
  CHECK(run("G93 M3 S1\nG33 Z-5 K1\nM2\n").codes().empty());
  CHECK(only_code("M3\nG33 Z-5 K1\nM2\n") == Code::feed_of_standing_spindle);
  CHECK_FALSE(run("M3\nG33 Z-5 K1\nM2\n").diagnostics.has_errors());
}

TEST_CASE("the passes of G76 deepen by J times the R-th root of their number") {
  // from X20, crest at 20 - 2 = 18: depth of pass n is 0.5 n^(1/R) until 1 is reached, then the full 1
  for (const double degression : {1.0, 1.5, 2.0, 3.0}) {
    std::vector<double> expected;
    for (int n = 1; 0.5 * std::pow(n, 1 / degression) < 1; ++n)
      expected.push_back(18 - 0.5 * std::pow(n, 1 / degression));
    for (int spring = 0; spring <= 2; ++spring) expected.push_back(17);
    const auto x =
        pass_positions(fmt::format("G18 M3 S300\nG0 X20 Z5\nG76 P1.5 Z-20 I-2 J0.5 K1 R{} H2\n", degression));
    REQUIRE(x.size() == expected.size());
    for (std::size_t i = 0; i < x.size(); ++i) CHECK(x[i] == doctest::Approx(expected[i]).epsilon(1e-12));
  }
}

TEST_CASE("G76 cuts an inside thread away from the axis") {
  // from X10, crest at 12, first pass at 12.5, then 13
  CHECK(pass_positions("G18 M3 S300\nG0 X10 Z5\nG76 P1.5 Z-20 I2 J0.5 K1\n") ==
        std::vector<double>{12.5, 13});
}

TEST_CASE("one pass of G76 draws back by K, comes in, threads and goes out; the end is the drive line's") {
  const auto m = moves_of("G18 M3 S300\nG0 X20 Z5\nG76 P1.5 Z-20 I-2 J0.9 K1\n");
  // first pass, depth 2.9: back at 20 - 2.9 + 3; second, depth 3: back at 20
  const std::vector<std::array<double, 2>> xz = {{20, 5}, {20.1, 5}, {17.1, 5}, {17.1, -20}, {20.1, -20},
                                                 {20, 5}, {17, 5},   {17, -20}, {20, -20},   {20, -20}};
  REQUIRE(m.size() == xz.size());
  for (std::size_t i = 0; i < m.size(); ++i) {
    CHECK(m[i].end[0] == doctest::Approx(xz[i][0]).epsilon(1e-12));
    CHECK(m[i].end[2] == doctest::Approx(xz[i][1]).epsilon(1e-12));
    CHECK((m[i].kind == BlockKind::feed) == (i == 3 || i == 7));
  }
  // 1.5 mm per turn at 5 turns per second
  CHECK(m[3].feed_u_s == doctest::Approx(7.5).epsilon(1e-15));
  CHECK_FALSE(m[3].feed_override_enabled);
  CHECK(m[9].feed_override_enabled);
}

TEST_CASE("the compound slide shifts each pass by its depth times tan Q") {
  // depth 0.5 below the crest: start 5 - 0.5 tan 30, end -20 + (1 - 0.5) tan 30; the last pass starts at
  // 5 - tan 30 and ends at -20
  const auto m = moves_of("G18 M3 S300\nG0 X20 Z5\nG76 P1.5 Z-20 I-2 J0.5 K1 Q30\n");
  const double t = 1 / std::sqrt(3.0);
  CHECK(m[1].end[2] == doctest::Approx(5 - 0.5 * t).epsilon(1e-12));
  CHECK(m[3].end[2] == doctest::Approx(-20 + 0.5 * t).epsilon(1e-12));
  CHECK(m[5].end[2] == doctest::Approx(5 - t).epsilon(1e-12));
  CHECK(m[7].end[2] == doctest::Approx(-20).epsilon(1e-12));
  // towards +Z everything is mirrored
  const auto up = moves_of("G18 M3 S300\nG0 X20 Z-20\nG76 P1.5 Z5 I-2 J0.5 K1 Q30\n");
  CHECK(up[1].end[2] == doctest::Approx(-20 + 0.5 * t).epsilon(1e-12));
  CHECK(up[3].end[2] == doctest::Approx(5 - 0.5 * t).epsilon(1e-12));
}

TEST_CASE("tapers of G76 reach the crest of the last pass over E, with the pitch along them") {
  const Outcome outcome = run("G18 M3 S300\nG0 X20 Z5\nG76 P1.5 Z-20 I-2 J0.99 K1 E1 L3\n");
  const auto m = outcome.moves();
  // pass of depth 2.99: back, in to 20 - 2.99 + 1, down the taper to -2.99 over 1 mm, ..., out
  const std::vector<std::array<double, 2>> xz = {{20.01, 5},   {18.01, 5},   {17.01, 4},
                                                 {17.01, -19}, {18.01, -20}, {20.01, -20}};
  for (std::size_t i = 0; i < xz.size(); ++i) {
    CHECK(m[i + 1].end[0] == doctest::Approx(xz[i][0]).epsilon(1e-12));
    CHECK(m[i + 1].end[2] == doctest::Approx(xz[i][1]).epsilon(1e-12));
  }
  // 45 degrees: 1 mm along Z is sqrt 2 along the taper
  CHECK(m[2].pitch_u_rev == doctest::Approx(1.5 * std::sqrt(2.0)).epsilon(1e-12));
  CHECK(m[3].pitch_u_rev == doctest::Approx(1.5 * std::sqrt(2.0)).epsilon(1e-12));
  CHECK(m[4].pitch_u_rev == 1.5);
  CHECK(m[5].pitch_u_rev == doctest::Approx(1.5 * std::sqrt(2.0)).epsilon(1e-12));
}

TEST_CASE("G76 is refused without its words, with impossible depths and with other axes") {
  const std::string head = "G18 M3 S300\nG0 X20 Z5\n";
  CHECK(only_code(head + "G76 Z-20 I-2 J0.5 K1\n") == Code::word_missing);
  CHECK(only_code(head + "G76 P1 Z-20 J0.5 K1\n") == Code::word_missing);
  CHECK(only_code(head + "G76 P1 I-2 J0.5 K1\n") == Code::word_missing);
  CHECK(only_code(head + "G76 P1 Z-20 I-2 J0.5 K1\nZ-30\n") == Code::word_missing);
  CHECK(only_code(head + "G76 P1 Z-20 I0 J0.5 K1\n") == Code::thread_depth);
  CHECK(only_code(head + "G76 P1 Z-20 I-2 J0 K1\n") == Code::thread_depth);
  CHECK(only_code(head + "G76 P1 Z-20 I-2 J1 K1\n") == Code::thread_depth);
  CHECK(only_code(head + "G76 P1 Z-20 I-2 J0.5 K1 A5\n") == Code::thread_axis_refused);
  CHECK(only_code(head + "G76 P1 Z-20 I-2 J0.5 K1 H1.5\n") == Code::word_not_whole);
  CHECK(only_code(head + "G76 P1 Z-20 I-2 J0.5 K1 L-1\n") == Code::word_out_of_range);
  CHECK(only_code(head + "G76 P1 Z-20 I-2 J0.001 K1 R9\n") == Code::thread_passes);
  CHECK(only_code(head + "M5\nG76 P1 Z-20 I-2 J0.5 K1\n") == Code::thread_spindle_stopped);
  // accepted, with a warning
  CHECK(only_code(head + "G76 P1 Z-20 I-2 J0.5 K1 R0.5\nM2\n") == Code::thread_unusual);
  CHECK(only_code(head + "G76 P1 Z-20 I-2 J0.5 K1 E15 L1\nM2\n") == Code::thread_unusual);
  CHECK(only_code(head + "G76 P1 Z-20 I-2 J0.5 K1 Q-1\nM2\n") == Code::thread_unusual);
  CHECK(only_code(head + "G17\nG76 P1 Z-20 I-2 J0.5 K1\nM2\n") == Code::thread_unusual);
}

TEST_CASE("under G95 F is the way per turn of the spindle") {
  const Outcome outcome = run("G21 G95 F0.2 M3 S600\nG1 X10\nG20\nF0.01 X1\nA5\n");
  CHECK(outcome.trace[0] == "SET_FEED_MODE G95");
  CHECK(outcome.trace[1] == "SET_FEED_RATE 0.000000");
  CHECK(outcome.trace[2] == "SET_FEED_RATE 0.200000");
  CHECK(outcome.trace[6] == "SET_FEED_RATE 0.254000");
  const auto m = outcome.moves();
  // 10 turns per second
  CHECK(m[0].pitch_u_rev == 0.2);
  CHECK(m[0].feed_u_s == doctest::Approx(2).epsilon(1e-15));
  CHECK(m[1].feed_u_s == doctest::Approx(2.54).epsilon(1e-15));
  CHECK(m[2].feed_u_s == doctest::Approx(0.1).epsilon(1e-15));
}

TEST_CASE("under G95 a feed move at S0 is refused, one with the spindle standing is told once") {
  CHECK(only_code("G95 F0.1 M3\nG1 X1\nX2\n") == Code::feed_without_speed);
  const Outcome outcome = run("G95 F0.1 S500\nG1 X1\nX2\nG81 X1 Z-1 R1\n");
  CHECK(outcome.codes() == std::vector<Code>{Code::feed_of_standing_spindle});
  CHECK_FALSE(outcome.diagnostics.has_errors());
  CHECK(outcome.moves()[0].feed_u_s == 0);
  CHECK(outcome.moves()[0].pitch_u_rev == 0.1);
  // rs274 does not ask for the speed in cycles and splines
  CHECK(only_code("G95 F0.1\nG5.1 X1 I1 J1\nM2\n") == Code::feed_of_standing_spindle);
  CHECK(only_code("G95 F0.1\nG81 X1 Z-1 R1\n") == Code::feed_of_standing_spindle);
}

TEST_CASE("under G96 the spindle follows the surface speed at the tool's distance from X0") {
  // 100 m/min at radius 50 mm: 100000 / (2 pi 50) = 318.3 rpm; at 0.1 mm/turn
  const std::string head = "G21 G95 F0.1 G96 S100 M3\n";
  const double pi = std::acos(-1.0);
  const auto along = moves_of(head + "G0 X50\nG1 Z-10\n").back();
  CHECK(along.feed_u_s == doctest::Approx(0.1 * 100000 / (2 * pi * 50) / 60).epsilon(1e-12));
  // facing from radius 50 to 30: turns = length / pitch, each as long as at the mean radius 40
  const auto facing = moves_of(head + "G0 X50\nG1 X30\n").back();
  CHECK(facing.feed_u_s == doctest::Approx(0.1 * 100000 / (2 * pi * 40) / 60).epsilon(1e-12));
  // through the centre the radius is |x|: from -20 to 20 the mean is 10; within 0.16 mm of X0 the spindle
  // stays at 100000 rpm, which is less than 1e-4 of the turns
  const auto through = moves_of(head + "G0 X-20\nG1 X20\n").back();
  CHECK(through.feed_u_s == doctest::Approx(0.1 * 100000 / (2 * pi * 10) / 60).epsilon(1e-4));
  // far out a move of a few last digits has the speed of its place
  const auto tiny = moves_of(head + "G0 X100000000\nG1 X100000000.00000003 Z-10\n").back();
  CHECK(tiny.feed_u_s == doctest::Approx(0.1 * 100000 / (2 * pi * 1e8) / 60).epsilon(1e-12));
  // D keeps the spindle at 200 rpm inside radius 79.6: at 50 it turns at 200
  const auto held = moves_of("G21 G95 F0.1 G96 D200 S100 M3\nG0 X50\nG1 Z-10\n").back();
  CHECK(held.feed_u_s == doctest::Approx(0.1 * 200 / 60).epsilon(1e-12));
  // in inches S is feet per minute
  const auto feet = moves_of("G20\nG95 F0.1 G96 S100 M3\nG0 X1\nG1 Z-1\n").back();
  CHECK(feet.feed_u_s == doctest::Approx(2.54 * 100 * 304.8 / (2 * pi * 25.4) / 60).epsilon(1e-12));
  // G97 takes S as rpm again
  const auto rpm = moves_of(head + "G0 X50\nG97 S60\nG1 Z-10\n").back();
  CHECK(rpm.feed_u_s == doctest::Approx(0.1).epsilon(1e-12));
}

TEST_CASE("G33 and G33.1 take an E that does nothing, with a warning") {
  CHECK(only_code("M3 S100\nG33 Z-5 K1 E1\nM2\n") == Code::thread_unusual);
  CHECK(only_code("M3 S100\nG33.1 Z-5 K1 E1\nM2\n") == Code::thread_unusual);
}

TEST_CASE("G96 needs S, and tells it as it was written") {
  CHECK(only_code("G96\n") == Code::word_missing);
  CHECK(only_code("G97 D100\n") == Code::word_unused);
  const Outcome outcome = run("G96 D1500 S120\nS90\nG97\n");
  CHECK(outcome.trace[0] == "SET_SPINDLE_SPEED 0 120.000000");
  CHECK(std::get<SpindleMode>(outcome.blocks[0].action).surface_speed_m_min == 120);
  CHECK(std::get<SpindleMode>(outcome.blocks[0].action).maximum_rpm == 1500);
  CHECK(std::get<SpindleSpeed>(outcome.blocks[2].action).surface_speed_m_min == 90);
  CHECK(std::get<SpindleMode>(outcome.blocks[3].action).surface_speed_m_min == 0);
}
