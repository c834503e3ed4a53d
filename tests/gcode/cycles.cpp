#include <doctest/doctest.h>

#include <fmt/format.h>

#include "machine/base/variants.h"
#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// The trace of a program in short: "T x y z" and "F x y z" for traverses and feed moves, other calls by name
/// and number; the calls of the head are left out.
std::vector<std::string> brief(const std::string& text, const InterpretOptions& options = {}) {
  const Outcome outcome = run("G21 G90 G17 F100\n" + text, options);
  CAPTURE(outcome.rendered);
  CHECK_FALSE(outcome.diagnostics.has_errors());
  std::vector<std::string> lines;
  const auto point = [&](const char* name, const Move& move) {
    lines.push_back(fmt::format("{} {:.6g} {:.6g} {:.6g}", name, move.end[0], move.end[1], move.end[2]));
  };
  const Overloaded brief_line{
      [&](const Traverse& move) { point("T", move); },
      [&](const Feed& move) { point("F", move); },
      [&](const Dwell& dwell) { lines.push_back(fmt::format("dwell {:.6g}", dwell.time_s)); },
      [&](const SpindleClockwise&) { lines.emplace_back("clockwise"); },
      [&](const SpindleCounterclockwise&) { lines.emplace_back("counterclockwise"); },
      [&](const SpindleStop&) { lines.emplace_back("stop"); },
      [&](const FeedOverride& feed) {
        lines.emplace_back(feed.enabled ? "feed override on" : "feed override off");
      },
      [&](const SpeedOverride& speed) {
        lines.emplace_back(speed.enabled ? "speed override on" : "speed override off");
      },
      [&](const SetPathMode& path) {
        lines.emplace_back(path.mode == PathMode::exact_path   ? "exact path"
                           : path.mode == PathMode::exact_stop ? "exact stop"
                                                               : "continuous");
      },
      [](const auto&) {},
  };
  for (const Block& b : outcome.blocks) std::visit(brief_line, b.action);
  return lines;
}

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("G81 goes over the hole, down to R, drills and comes back to R or to the initial level") {
  // from Z10: over the hole at Z10, rapid to R2, feed to Z-5, back to R2 (G99) or Z10 (G98)
  CHECK(brief("G61 G0 Z10\nG99 G81 X1 Y2 Z-5 R2\nX3\n") == Lines{"exact path", "T 0 0 10", "T 1 2 10",
                                                                 "T 1 2 2", "F 1 2 -5", "T 1 2 2",  //
                                                                 "T 3 2 2", "F 3 2 -5", "T 3 2 2"});
  CHECK(brief("G61 G0 Z10\nG98 G81 X1 Y2 Z-5 R2\nX3\n") ==
        Lines{"exact path", "T 0 0 10", "T 1 2 10", "T 1 2 2", "F 1 2 -5", "T 1 2 10",  //
              "T 3 2 10", "T 3 2 2", "F 3 2 -5", "T 3 2 10"});
}

TEST_CASE("a cycle that begins below R goes straight up to R first") {
  CHECK(brief("G61\nG98 G81 X1 Z-5 R2\n") ==
        Lines{"exact path", "T 0 0 2", "T 1 0 2", "F 1 0 -5", "T 1 0 2"});
}

TEST_CASE("cycles run along the normal of the plane in force") {
  // G18 drills along Y, G19 along X; the way to the hole is in the other two
  CHECK(brief("G61 G18 G0 Y10\nG98 G81 X1 Z2 Y-5 R2\n") ==
        Lines{"exact path", "T 0 10 0", "T 1 10 2", "T 1 2 2", "F 1 -5 2", "T 1 10 2"});
  CHECK(brief("G61 G19 G0 X10\nG99 G82 Y1 Z2 X-5 R2 P0.5\n") ==
        Lines{"exact path", "T 10 0 0", "T 10 1 2", "T 2 1 2", "F -5 1 2", "dwell 0.5", "T 2 1 2"});
}

TEST_CASE("under G91 R counts from the initial level, Z from R, and L repeats at equal steps") {
  // from Z10: R-8 is Z2, Z-3 is Z-1; holes at X4, X8, X12
  CHECK(brief("G61 G0 Z10\nG91 G98 G81 X4 Z-3 R-8 L3\n") ==
        Lines{"exact path", "T 0 0 10",                       //
              "T 4 0 10", "T 4 0 2", "F 4 0 -1", "T 4 0 10",  //
              "T 8 0 10", "T 8 0 2", "F 8 0 -1", "T 8 0 10",  //
              "T 12 0 10", "T 12 0 2", "F 12 0 -1", "T 12 0 10"});
  // the sequence began at Z10: R of the second line counts from there, though the tool is at Z2
  CHECK(brief("G61 G0 Z10\nG91 G99 G81 X4 Z-3 R-8\nX1\n").back() == "T 5 0 2");
}

TEST_CASE("under G90 L drills the same hole again") {
  CHECK(brief("G61\nG81 X4 Z-3 R1 L2\n") ==
        Lines{"exact path", "T 0 0 1", "T 4 0 1", "F 4 0 -3", "T 4 0 1", "T 4 0 1", "F 4 0 -3", "T 4 0 1"});
}

TEST_CASE("G73 breaks the chip by 0.254 mm, G83 clears the hole and comes back 0.254 mm above its bottom") {
  // R2, Q3: 2-3 = -1, -4, then the bottom -5
  CHECK(brief("G61 G0 Z2\nG73 X1 Z-5 R2 Q3\n") == Lines{"exact path", "T 0 0 2", "T 1 0 2", "F 1 0 -1",
                                                        "T 1 0 -0.746", "F 1 0 -4", "T 1 0 -3.746",
                                                        "F 1 0 -5", "T 1 0 2"});
  // the pecks come out to R even under G98
  CHECK(brief("G61 G0 Z9\nG98 G83 X1 Z-5 R2 Q3\n") ==
        Lines{"exact path", "T 0 0 9", "T 1 0 9", "T 1 0 2", "F 1 0 -1", "T 1 0 2", "T 1 0 -0.746",
              "F 1 0 -4", "T 1 0 2", "T 1 0 -3.746", "F 1 0 -5", "T 1 0 9"});
}

TEST_CASE("pecks of an inch program clear by 0.010 inch, as by 0.254 mm in another") {
  // R0.1 in = 2.54 mm; Q0.1: first peck at 0, back to 0.01 in = 0.254 mm, bottom at -0.05 in = -1.27 mm
  CHECK(brief("G61 G20\nG0 Z0.1\nG73 X0 Z-0.05 R0.1 Q0.1\n") == Lines{"exact path", "T 0 0 2.54",
                                                                      "T 0 0 2.54", "F 0 0 0", "T 0 0 0.254",
                                                                      "F 0 0 -1.27", "T 0 0 2.54"});
}

TEST_CASE("the last peck ends where the hole does") {
  // 6 pecks of 1 from R2 to Z-4: no empty seventh
  const Outcome outcome = run("F100\nG81 X0 Z-4 R2\nG73 X0 Z-4 R2 Q1\n");
  CHECK(outcome.all<Feed>().size() == 1 + 6);
}

TEST_CASE("G85 bores in and out at the feed, G89 waits at the bottom, G86 stops the spindle there") {
  CHECK(brief("G61 G0 Z9\nG98 G85 X1 Z-5 R2\n") ==
        Lines{"exact path", "T 0 0 9", "T 1 0 9", "T 1 0 2", "F 1 0 -5", "F 1 0 2", "T 1 0 9"});
  CHECK(brief("G61 G0 Z9\nG98 G89 X1 Z-5 R2 P0.25\n") ==
        Lines{"exact path", "T 0 0 9", "T 1 0 9", "T 1 0 2", "F 1 0 -5", "dwell 0.25", "F 1 0 9"});
  CHECK(brief("G61 G0 Z2\nM4 S100\nG86 X1 Z-5 R2 P1\n") == Lines{"exact path", "T 0 0 2", "counterclockwise",
                                                                 "T 1 0 2", "F 1 0 -5", "dwell 1", "stop",
                                                                 "T 1 0 2", "counterclockwise"});
}

TEST_CASE("G84 taps with the spindle clockwise, G74 counter-clockwise, both without overrides") {
  CHECK(brief("G61 G0 Z2\nM3 S100\nG84 X1 Z-5 R2 P0.5\n") ==
        Lines{"exact path", "T 0 0 2", "clockwise", "T 1 0 2", "feed override off", "speed override off",
              "F 1 0 -5", "stop", "counterclockwise", "dwell 0.5", "F 1 0 2", "stop", "clockwise",
              "feed override on", "speed override on"});
  // what M49 and M50 have disabled stays disabled; a P that never was given waits 0 seconds
  CHECK(brief("G61 G0 Z2\nM50 P0\nM4 S100\nG74 X1 Z-5 R2\n") ==
        Lines{"exact path", "T 0 0 2", "feed override off", "counterclockwise", "T 1 0 2",
              "feed override off", "speed override off", "F 1 0 -5", "stop", "clockwise", "dwell 0",
              "F 1 0 2", "stop", "counterclockwise", "speed override on"});
  const Outcome outcome = run("F100 M3 S100\nG84 X1 Z-5 R2\nG0 X0\n");
  for (const Feed& feed : outcome.all<Feed>()) CHECK_FALSE(feed.feed_override_enabled);
  CHECK(outcome.moves().back().feed_override_enabled);
}

TEST_CASE("a cycle runs on an exact path and gives the path mode back") {
  CHECK(brief("G64 P0.1\nG0 Z2\nG81 X1 Z-5 R2\nG61.1\nX2\n") ==
        Lines{"continuous", "T 0 0 2", "exact path", "T 1 0 2", "F 1 0 -5", "T 1 0 2", "continuous",
              "exact stop", "exact path", "T 2 0 2", "F 2 0 -5", "T 2 0 2", "exact stop"});
  const Outcome outcome = run("F100 G64 P0.1\nG81 X1 Z-5 R2\nG0 X0\n");
  CHECK(outcome.moves().back().path_tolerance_mm == 0.1);
  CHECK(outcome.moves()[2].path_mode == PathMode::exact_path);
}

TEST_CASE("R, bottom, Q and P are kept while a cycle goes on, and no longer") {
  CHECK(brief("G61 G0 Z2\nG82 X1 Z-5 R2 P0.5\nX2 Z-6\nX3 P1\n") ==
        Lines{"exact path", "T 0 0 2", "T 1 0 2", "F 1 0 -5", "dwell 0.5", "T 1 0 2",  //
              "T 2 0 2", "F 2 0 -6", "dwell 0.5", "T 2 0 2",                           //
              "T 3 0 2", "F 3 0 -6", "dwell 1", "T 3 0 2"});
  CHECK(only_code("F100\nG81 X1 Z-5 R2\nG82 X2 P1\n") == Code::word_missing);
  CHECK(only_code("F100\nG81 X1 Z-5 R2\nG80\nG81 X2 R2\n") == Code::word_missing);
  CHECK(only_code("F100\nG81 X1 Z-5 R2\nG0 X0\nG81 X2 Z-5\n") == Code::word_missing);
}

TEST_CASE(
    "the initial level is that of the sequence, kept over a change of cycle, lost with another motion") {
  // G82 begins at R2, yet returns to Z10 where G81 began
  CHECK(brief("G61 G0 Z10\nG99 G81 X1 Z-5 R2\nG98 G82 X2 Z-5 R2 P0\n").back() == "T 2 0 10");
  CHECK(brief("G61 G0 Z10\nG99 G81 X1 Z-5 R2\nG80\nG98 G82 X2 Z-5 R3 P0\n").back() == "T 2 0 3");
  CHECK(brief("G61 G0 Z10\nG99 G81 X1 Z-5 R2\nG0 Z5\nG98 G82 X2 Z-5 R3 P0\n").back() == "T 2 0 5");
}

TEST_CASE("cycles follow offsets, rotation and units") {
  // G54 at (5, 0, 1) turned by 90 degrees: program (1, 2) is machine (5 - 2, 0 + 1)
  InterpretOptions options;
  const auto at = brief("G10 L2 P1 X5 Z1\nG61 G0 Z3\nG81 X1 Y2 Z-4 R2\n", options);
  CHECK(at == Lines{"exact path", "T 0 0 4", "T 6 2 4", "T 6 2 3", "F 6 2 -3", "T 6 2 3"});
  CHECK(brief("G61 G20\nG81 X1 Y2 Z-1 R1\n")[3] == "F 25.4 50.8 -25.4");
}

TEST_CASE("cycles are refused where they make no sense") {
  CHECK(only_code("F100\nG81 X1 Z5 R2\n") == Code::cycle_retract_below_bottom);
  CHECK(run("F100\nG81 X1 Z2 R2\n").codes().empty());
  CHECK(only_code("G93\nG81 X1 Z-5 R2 F10\n") == Code::cycle_under_inverse_time);
  CHECK(only_code("F100\nG81 X1 Z-5 R2 A5\n") == Code::cycle_axis_refused);
  CHECK(only_code("F100\nG81 X1 Z-5 R2 U5\n") == Code::cycle_axis_refused);
  CHECK(only_code("F100\nG81 X1 Z-5 R2 L0\n") == Code::word_out_of_range);
  CHECK(only_code("F100\nG81 X1 Z-5 R2 L1.5\n") == Code::word_not_whole);
  CHECK(only_code("F100\nG83 X1 Z-5 R2 Q0\n") == Code::word_out_of_range);
  CHECK(only_code("F100\nG82 X1 Z-5 R2 P-2\n") == Code::word_out_of_range);
  CHECK(only_code("F100\nG81 X1 Z-5 R2 Q1\n") == Code::word_unused);
  CHECK(only_code("F100\nG81 X1 Z-5 R2 P1\n") == Code::word_unused);
  CHECK(only_code("F100 M4 S9\nG74 X1 Z-5 R2 L2\n") == Code::word_unused);
  CHECK(only_code("F100\nG81\n") == Code::word_missing);
  CHECK(only_code("F100\nG81 X1 Z-5 R2\nR3\n") == Code::word_unused);
  CHECK(only_code("G81 X1 Z-5 R2\nX2\n") == Code::feed_missing);
  CHECK(only_code("F100\nG81 X1 Z-5 R2\nG80\nX2\n") == Code::axis_words_without_motion);
  CHECK(only_code("F100\nG86 X1 Z-5 R2 P1\n") == Code::cycle_spindle);
  CHECK(only_code("F100 M4 S1\nG84 X1 Z-5 R2\n") == Code::cycle_spindle);
  CHECK(only_code("F100 M3 S1\nG74 X1 Z-5 R2\n") == Code::cycle_spindle);
  CHECK(only_code("F100\nG88 X1 Z-5 R2 P1\n") == Code::word_not_run);
}

TEST_CASE("a mistake in the first line of a cycle is not told again on the lines that go on") {
  CHECK(only_code("F100\nG81 X1 Z-5\nX2\nX3\n") == Code::word_missing);
  CHECK(only_code("F100\nG83 X1 Z-5 R2\nX2\nX3\n") == Code::word_missing);
}

TEST_CASE("a tool change behind a tap outside G17 goes on where the tool stands") {
  // the tap in G18 ends at X2 Y5 Z7 (exchanged axes) where the program takes it for X7 Y2 Z5
  const std::string tap = "F100 S100 M3 G18\nG84 X7 Z5 Y-3 R2\nG80\n";
  CHECK(run(tap + "G0 A1\nM2\n").moves().back().end == AxisValues{7, 2, 5, 1});
  CHECK(run(tap + "T1 M6\nG0 A1\nM2\n").moves().back().end == AxisValues{2, 5, 7, 1});
}
