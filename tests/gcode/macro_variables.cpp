#include <doctest/doctest.h>

#include "macro_support.h"

/// System variables of macro B: positions, offsets, modal codes, alarm and stop.
using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// The value of a variable behind some lines: Y of the last move.
double variable_behind(const std::string& lines, const std::string& variable,
                       const InterpretOptions& options = of_fanuc()) {
  const std::vector<LineOrArc> moves =
      run(lines + "#199=" + variable + "\nG90 G21 G49 G54 G0 G80 W#199\n", options).moves();
  return moves.empty() ? -777 : moves.back().end[8];
}

}  // namespace

TEST_CASE("local and common variables begin vacant, each call of a program anew") {
  for (const char* variable : {"#1", "#33", "#100", "#199", "#500", "#999", "#0"}) {
    CAPTURE(variable);
    CHECK(macro_xs(std::string("IF [") + variable + " EQ #0] GOTO 5\nG0 X1\nN5 M30\n").empty());
  }
}

TEST_CASE("positions are read in the units in force") {
  const std::string moved = "G21 G90\n#5221=10\n#5222=20\nG54 G0 X1 Y2 Z3\n";
  CHECK(variable_behind(moved, "#5001") == 1);
  CHECK(variable_behind(moved, "#5003") == 3);
  CHECK(variable_behind(moved, "#5021") == 11);
  CHECK(variable_behind(moved, "#5022") == 22);
  CHECK(variable_behind(moved, "#5041") == 1);
  CHECK(variable_behind(moved + "G20\n", "#5021*25.4") == doctest::Approx(11));
}

TEST_CASE("the work position includes a tool's length, the end of the block does not") {
  InterpretOptions options = of_fanuc();
  Tool tool;
  tool.number = tool.pocket = 1;
  tool.offset[2] = 50;
  options.tools.emplace();
  options.tools->tools.push_back(tool);
  const std::string moved = "G21 G90 T1 M6\nG43 H1 G0 Z5\n";
  CHECK(variable_behind(moved, "#5003", options) == 5);
  CHECK(variable_behind(moved, "#5023", options) == 55);
  CHECK(variable_behind(moved, "#5043", options) == 55);
  CHECK(variable_behind(moved, "#5083", options) == 50);
  CHECK(variable_behind(moved, "#2001", options) == 50);
  // a new length holds from the next G43 on
  CHECK(variable_behind(moved + "#2001=60\n", "#5083", options) == 50);
  CHECK(variable_behind(moved + "#2001=60\nG43 H1 Z5\n", "#5083", options) == 60);
  CHECK(macro_error("#2002=5\n", options) == MacroError{Code::tool_unknown, 1});
}

TEST_CASE("a haas has the diameters of tools from #2401 on") {
  CHECK(variable_behind("G20 G90\n#2401=0.5\n", "#2401", of_haas()) == doctest::Approx(0.5));
  CHECK(macro_error("G0 X#2401\n", of_fanuc()) == MacroError{Code::system_variable, 1});
}

TEST_CASE("a work offset that a program sets is in force on the next line, in the units in force") {
  CHECK(last_point("G21 G90 G54\n#5221=10\nG0 X1\n", of_fanuc())[0] == 11);
  CHECK(last_point("G20 G90 G54\n#5221=10\nG0 X1\n", of_fanuc())[0] == doctest::Approx(11 * 25.4));
  CHECK(last_point("G21 G90 G54\n#5241=10\nG0 X1\nG55 X1\n", of_fanuc())[0] == 11);
  CHECK(variable_behind("G20\n#5241=2\n", "#5241") == 2);
  CHECK(variable_behind("", "#5201") == 0);
}

TEST_CASE("modal variables tell the codes in force") {
  const auto modal = [](const std::string& line, const std::string& variable) {
    return variable_behind(line + "\n", variable);
  };
  CHECK(modal("G0 X0", "#4001") == 0);
  CHECK(modal("G1 F100 X0", "#4001") == 1);
  CHECK(modal("G18", "#4002") == 18);
  CHECK(modal("G91", "#4003") == 91);
  CHECK(modal("G95", "#4005") == 95);
  CHECK(modal("G20", "#4006") == 20);
  CHECK(modal("G40", "#4007") == 40);
  CHECK(modal("G49", "#4008") == 49);
  CHECK(modal("G80", "#4009") == 80);
  CHECK(modal("G98", "#4010") == 98);
  CHECK(modal("G97 S100", "#4013") == 97);
  CHECK(modal("G56", "#4014") == 56);
  CHECK(modal("G94\nF120", "#4109") == 120);
  CHECK(modal("S1500", "#4119") == 1500);
  CHECK(modal("T7", "#4120") == 7);
}

TEST_CASE("#3000 stops with its text, #3006 waits with its text") {
  const Outcome alarm = run("G0 X1\n#3000=12 (TOOL TOO SHORT)\nG0 X2\n", of_fanuc());
  REQUIRE(alarm.codes() == std::vector<Code>{Code::program_aborts});
  CHECK(alarm.rendered.find("alarm 12, TOOL TOO SHORT") != std::string::npos);
  CHECK(alarm.moves().size() == 1);
  const Outcome stop = run("#3006=1 (TURN THE PART)\nM30\n", of_fanuc());
  CHECK_FALSE(stop.diagnostics.has_errors());
  REQUIRE(stop.all<Message>().size() == 1);
  CHECK(stop.all<Message>()[0].text == "TURN THE PART");
  CHECK(stop.all<ProgramStop>().size() == 1);
}

TEST_CASE("#1100 and on are outputs, #3003 and #3004 are told") {
  const std::vector<DigitalOutput> outputs = run("#1103=1\n#1103=0\n", of_fanuc()).all<DigitalOutput>();
  REQUIRE(outputs.size() == 2);
  CHECK(outputs[0].number == 3);
  CHECK(outputs[0].on);
  CHECK_FALSE(outputs[1].on);
  CHECK(only_code("#3003=1\n", of_fanuc()) == Code::word_without_effect);
  CHECK(only_code("#3004=7\n", of_fanuc()) == Code::word_without_effect);
}

TEST_CASE("#1000 to #1031 are the inputs of the machine, read where the line is run") {
  InterpretOptions options = of_fanuc();
  int asked = 0;
  options.read_input = [&](const InputWait& wait) {
    ++asked;
    return InputReading{true, wait.number == 3 && asked > 2 ? 1.0 : 0.0};
  };
  const Outcome outcome = run("WHILE [#1003 EQ 0] DO1\nG4 P100\nEND1\nG0 X#1003\n", options);
  CHECK_FALSE(outcome.diagnostics.has_errors());
  CHECK(outcome.all<Dwell>().size() == 2);
  CHECK(outcome.all<InputWait>().size() == 4);
  CHECK(outcome.moves().back().end[0] == 1);
  // without a machine an input reads 0
  CHECK(macro_xs("G0 X[#1031+5]\n") == std::vector<double>{5});
}

TEST_CASE("what only tells can't be set, and what kadr does not have is named") {
  for (const char* setting :
       {"#0=1\n", "#5001=1\n", "#5023=1\n", "#5041=1\n", "#4003=90\n", "#5201=0\n", "#1000=1\n"}) {
    CAPTURE(setting);
    CHECK(macro_error(setting) == MacroError{Code::parameter_read_only, 1});
  }
  for (const char* text : {"G0 X#1032\n", "#1=1000\nG0 X#[#1+1]\n", "G0 X#3001\n", "#3001=0\n", "G0 X#34\n",
                           "#99=1\n", "G0 X#200\n", "#499=1\n", "G0 X#3011\n", "G0 X#4111\n", "G0 X#7001\n",
                           "G0 X#100000\n", "#5400=1\n", "G0 X#5420\n"}) {
    CAPTURE(text);
    CHECK(macro_error(text).code == Code::system_variable);
  }
  CHECK(macro_error("G0 X#[-1]\n") == MacroError{Code::parameter_range, 1});
  CHECK(macro_error("G0 X#[1.5]\n") == MacroError{Code::parameter_range, 1});
  CHECK(macro_error("G0 X#[#1]\n") == MacroError{Code::parameter_range, 1});
  CHECK(macro_error("#[1.5]=1\n") == MacroError{Code::parameter_range, 1});
  CHECK(run("G0 X#3001\n", of_fanuc()).rendered.find("#3001 is a timer") != std::string::npos);
}

TEST_CASE("the zero point in force does not move while cutter compensation is on") {
  CHECK(macro_error("G21 G90 G0 X0 Y0\nG41.1 D4\nG1 F100 X10 Y10\n#5221=5\nX20\nG40\nM30\n").code ==
        Code::compensation_conflict);
}

TEST_CASE("positions are not read while cutter compensation decides them") {
  CHECK(macro_error("G21 G90 G0 X0 Y0\nG41.1 D4\nG1 F100 X10 Y10\nX20\n#1=#5001\nG40\nM30\n").code ==
        Code::compensation_conflict);
}
