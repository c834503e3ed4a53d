#include <doctest/doctest.h>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

TEST_CASE("the words of a line run in the order of RS-274/NGC, however they are written") {
  const Outcome outcome = run("M0 X1 G1 G64 M49 M8 M3 M6 T2 S500 F60 G94 G4 P2 (MSG, order)\n");
  CHECK_FALSE(outcome.diagnostics.has_errors());
  const std::vector<std::string> expected = {
      "MESSAGE \" order\"",
      "SET_FEED_MODE G94",
      "SET_FEED_RATE 0.000000",
      "SET_FEED_RATE 60.000000",
      "SET_SPINDLE_SPEED 0 500.000000",
      "SELECT_TOOL 2",
      "STOP_SPINDLE_TURNING 0",
      "CHANGE_TOOL 2",
      "START_SPINDLE_CLOCKWISE 0",
      "FLOOD_ON",
      "DWELL 2.000000",
      "SET_MOTION_CONTROL_MODE CONTINUOUS 2.000000",
      "STRAIGHT_FEED 1.000000 0.000000 0.000000 0.000000 0.000000 0.000000 "
      "0.000000 0.000000 0.000000",
      "PROGRAM_STOP",
      "PROGRAM_END"};
  CHECK(outcome.trace == expected);
  // G4 and G64 share P, and nothing stops the spindle
  CHECK(outcome.codes() == std::vector<Code>{Code::word_shared, Code::spindle_left_running});
}

TEST_CASE("plane, units, offsets and distance of a line hold for the move of that line") {
  CHECK(last_point("X1 G91 G20 G0\n")[0] == 25.4);
  CHECK(last_point("G0 X10\nX5 G91\n")[0] == 15);
  CHECK(run("F60\nX0 Z0 I1 G2 G18\n").moves()[0].plane == Plane::zx);
  CHECK(last_point("G10 L2 P3 X9\nX1 G56 G0\n")[0] == 10);
}

TEST_CASE("M2 stops spindle and coolant, returns to G94 and clears the feed") {
  const Outcome outcome = run("M7\nM8\nM49\nM2\n");
  const std::vector<std::string> expected = {
      "MIST_ON",  "FLOOD_ON",  "SET_FEED_MODE G94", "SET_FEED_RATE 0.000000", "STOP_SPINDLE_TURNING 0",
      "MIST_OFF", "FLOOD_OFF", "PROGRAM_END"};
  CHECK(outcome.trace == expected);
}

TEST_CASE("M48 to M51 switch feed and speed override") {
  const auto blocks = run("M49\nM48\nM50 P0\nM50\nM51 P0\nM51 P1\n").blocks;
  REQUIRE(blocks.size() == 9);  // with the program end
  const std::pair<BlockKind, int> expected[] = {
      {BlockKind::feed_override, 0},  {BlockKind::speed_override, 0}, {BlockKind::feed_override, 1},
      {BlockKind::speed_override, 1}, {BlockKind::feed_override, 0},  {BlockKind::feed_override, 1},
      {BlockKind::speed_override, 0}, {BlockKind::speed_override, 1}};
  for (std::size_t i = 0; i < 8; ++i) {
    CHECK(blocks[i].kind() == expected[i].first);
    const auto* feed = std::get_if<FeedOverride>(&blocks[i].action);
    const bool enabled = feed != nullptr ? feed->enabled : std::get<SpeedOverride>(blocks[i].action).enabled;
    CHECK(enabled == (expected[i].second == 1));
  }
}

TEST_CASE("spindle blocks carry the speed in force") {
  const auto blocks = run("S1500 M3\nS200\nM4\nM5\n").blocks;
  CHECK(is<SpindleSpeed>(blocks[0]));
  CHECK(std::get<SpindleClockwise>(blocks[1].action).speed_rpm == 1500);
  CHECK(std::get<SpindleCounterclockwise>(blocks[3].action).speed_rpm == 200);
  CHECK(is<SpindleStop>(blocks[4]));
}

TEST_CASE("a tool is changed to the one selected last, without a selection to tool 0") {
  CHECK(run("T5\nM6\n").trace[2] == "CHANGE_TOOL 5");
  CHECK(run("M6\n").trace[1] == "CHANGE_TOOL 0");
}

TEST_CASE("stops are told apart") {
  CHECK(run("M0\nM1\nM60\n").trace ==
        std::vector<std::string>{"PROGRAM_STOP", "OPTIONAL_PROGRAM_STOP", "PROGRAM_STOP", "PROGRAM_END"});
}

TEST_CASE("codes of one group exclude each other on a line") {
  for (const std::string line :
       {"G0 G1 X1", "G17 G18", "G20 G21", "G90 G91", "G90.1 G91.1", "G93 G94", "G43 G49", "G54 G55",
        "G61 G64", "G4 P1 G53", "M3 M5", "M7 M8", "M0 M2", "M48 M49", "G1 G1 X1"}) {
    CAPTURE(line);
    CHECK(only_code("F1\n" + line + "\n") == Code::modal_conflict);
  }
}

TEST_CASE("words that nothing reads are refused, not left out") {
  for (const std::string line :
       {"G0 X1 P1", "F1 G1 X1 I1", "G0 X1 R2", "H1", "L1", "Q3", "D1", "E2", "J1", "K1"}) {
    CAPTURE(line);
    CHECK(only_code(line + "\n") == Code::word_unused);
  }
  CHECK(only_code("F1 G2 X2 I1\nP2\n") == Code::word_unused);
}

TEST_CASE("codes of the dialect that kadr does not run are named, unknown ones told apart") {
  for (const std::string line : {"G87 X1 Y1 Z-1 R1 F1", "G71", "M101", "G17.1"}) {
    CAPTURE(line);
    CHECK(only_code(line + "\n") == Code::word_not_run);
  }
  for (const std::string line : {"G15", "G100", "G1.05 X1", "M10", "M1.5", "M200", "G-1", "G999999999"}) {
    CAPTURE(line);
    CHECK(only_code(line + "\n") == Code::unknown_code);
  }
}

TEST_CASE("a tool length without a table is zero, and told unless H0 asks for it") {
  CHECK(run("G43 H0\nG49\nG43\n").codes().empty());
  for (const std::string program : {"G43 H3\n", "T3 M6\nG43\n"}) {
    CAPTURE(program);
    const Outcome outcome = run(program);
    CHECK(outcome.codes() == std::vector<Code>{Code::tool_length_unknown});
    CHECK_FALSE(outcome.diagnostics.has_errors());
  }
  CHECK(only_code("G43 H-1\n") == Code::word_out_of_range);
}
