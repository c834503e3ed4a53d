#include <doctest/doctest.h>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

TEST_CASE("outputs are set at once or with the next motion") {
  CHECK(run("M62 P1\nM63 P2\nM64 P3\nM65 P4\nM67 E5 Q2.5\nM68 E6 Q-1\n").trace ==
        std::vector<std::string>{"SET_DIGITAL 1 on @motion", "SET_DIGITAL 2 off @motion",
                                 "SET_DIGITAL 3 on @now", "SET_DIGITAL 4 off @now",
                                 "SET_ANALOG 5 2.500000 @motion", "SET_ANALOG 6 -1.000000 @now",
                                 "PROGRAM_END"});
}

TEST_CASE("M66 waits, and #5399 is what it read, -1 after the time") {
  CHECK(run("M66 P1\nM66 E2\nM66 P3 L3 Q5\n").trace ==
        std::vector<std::string>{"WAIT_INPUT 1 digital immediate 0.000000",
                                 "WAIT_INPUT 2 analog immediate 0.000000",
                                 "WAIT_INPUT 3 digital high 5.000000", "PROGRAM_END"});
  InterpretOptions options;
  options.read_input = [](const InputWait& wait) {
    return InputReading{wait.mode != WaitMode::fall, wait.analog ? 2.5 : 1};
  };
  CHECK(last_point("M66 E1\nG0 X#5399\n", options)[0] == 2.5);
  CHECK(last_point("M66 P1 L1 Q9\nG0 X#5399\n", options)[0] == 1);
  CHECK(last_point("M66 P1 L2 Q9\nG0 X#5399\n", options)[0] == -1);
  CHECK(last_point("#5399=7\nM66 P1\nG0 X#5399\n")[0] == 0);
}

TEST_CASE("words that outputs and inputs can't use are refused") {
  for (const char* text : {"M62\n", "M67 Q1\n", "M67 E1\n"}) CHECK(only_code(text) == Code::word_missing);
  for (const char* text : {"M66\n", "M66 P1 E1\n", "M66 E1 L1 Q1\n", "M66 P1 L1\n", "M66 P1 L3 Q0\n"}) {
    CAPTURE(text);
    CHECK(only_code(text) == Code::input_unclear);
  }
  CHECK(only_code("M66 P-1\n") == Code::word_out_of_range);
  CHECK(only_code("M66 P1 L5 Q1\n") == Code::word_out_of_range);
  CHECK(only_code("M62 P1 M64\n") == Code::modal_conflict);
}

TEST_CASE("there is one spindle: $0, and $-1 for all") {
  CHECK_FALSE(run("S100 $0\nM3 $-1\n").diagnostics.has_errors());
  CHECK(only_code("M3 $1\n") == Code::word_out_of_range);
  CHECK(only_code("G0 X1 $0\n") == Code::word_unused);
}

TEST_CASE("M72 restores the modal state that M70 has saved, but the motion") {
  const std::string change = "G91 G18 F7 S300 M4 G64 P0.5 M8\n";
  const Outcome outcome = run("F50 S100 M3 G61\nM70\n" + change + "M72\nG1 X1\nG2 X3 I1\n");
  CHECK_FALSE(outcome.diagnostics.has_errors());
  CHECK(outcome.moves().back().end[0] == 3);
  CHECK(outcome.moves().back().plane == Plane::xy);
  CHECK(outcome.moves().back().feed_u_s == doctest::Approx(50.0 / 60));
  CHECK(outcome.moves().back().path_mode == PathMode::exact_path);
}

TEST_CASE("M72 gives back path mode and overrides on one line, so that they share P") {
  // G64 P0 and M51 of the line that gives the modes back: P0 disables the speed override
  std::vector<bool> speed_override;
  const Outcome outcome = run("M50 P0\nM70\nM50\nG64 P0.1\nM72\nM2\n");
  for (const SpeedOverride& speed : outcome.all<SpeedOverride>()) speed_override.push_back(speed.enabled);
  REQUIRE_FALSE(speed_override.empty());
  CHECK_FALSE(speed_override.front());
}

TEST_CASE("M72 gives back what LinuxCNC keeps: rounded F and S, one coolant, an enabled override") {
  const auto calls = [](const std::string& text) {
    std::string trace;
    for (const Block& b : run(text).blocks) {
      std::string line;
      append_canon(line, b);
      trace += line.substr(0, line.find(" @")) + ";";
    }
    return trace.substr(0, trace.find("PROGRAM_END"));
  };
  CHECK(calls("M70\nM8\nM72\n") == "FLOOD_ON;MIST_OFF;FLOOD_OFF;");
  // mist alone was kept: flood stays on
  CHECK(calls("M7\nM70\nM8\nM72\nM9\n") == "MIST_ON;FLOOD_ON;MIST_OFF;FLOOD_OFF;");
  CHECK(calls("F100.26 S100.6\nM70\nF5 S2\nM72\n").find("100.300000;SET_SPINDLE_SPEED 0 101.000000") !=
        std::string::npos);
  CHECK(run("M70\nM50 P0\nM72\nF1 G1 X1\n").moves().back().feed_override_enabled == true);
  CHECK(run("M50 P0\nM70\nM48\nM72\nF1 G1 X1\n").moves().back().feed_override_enabled == true);
}

TEST_CASE("M72 takes back a tool length and a G92 offset that came later") {
  // G43.1 is gone: Z stays where it is, so the move in X keeps machine Z 0
  CHECK(last_point("M70\nG43.1 Z5\nM72\nG0 X1 Z2\n")[2] == 2);
  CHECK(last_point("M70\nG92 X5\nM72\nG0 X1\n")[0] == 1);
  // G92 X5 at 0 makes X1 the machine's -4; G92.2 between is undone
  CHECK(last_point("G92 X5\nM70\nG92.2\nM72\nG0 X1\n")[0] == -4);
}

TEST_CASE("each call level has a modal state of its own, which M73 restores at the return") {
  CHECK(only_code("M72\n") == Code::modal_state_missing);
  CHECK(only_code("M70\nM71\nM72\n") == Code::modal_state_missing);
  CHECK(only_code("O100 sub\nM72\nO100 endsub\nM70\nO100 call\n") == Code::modal_state_missing);
  CHECK(last_point("O100 sub\nM73\nG91 G20\nO100 endsub\nO100 call\nG0 X1\nX1\n")[0] == 1);
  CHECK(last_point("O100 sub\nM73\nG91\nM71\nO100 endsub\nO100 call\nG0 X1\nX1\n")[0] == 2);
}
