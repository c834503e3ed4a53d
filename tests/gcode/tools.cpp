#include <doctest/doctest.h>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// T1 is 10 mm long, T2 has an offset in every axis.
InterpretOptions with_tools() {
  InterpretOptions options;
  ToolTable table;
  table.tools.push_back({1, 1, {0, 0, 10}, 6});
  table.tools.push_back({2, 2, {1, 2, 3, 4, 5, 6, 7, 8, 9}, 8, 11, 12, 3});
  options.tools = table;
  return options;
}

AxisValues point(const std::string& text) { return last_point(text, with_tools()); }
Code code_of(const std::string& text) { return only_code(text, with_tools()); }

}  // namespace

TEST_CASE("G43 takes the offset of the tool in the spindle or of H, in every axis") {
  CHECK(point("T1 M6\nG43\nG0 Z0\n")[2] == 10);
  CHECK(point("T1 M6\nG43 H2\nG0 X0 Y0 Z0 A0 B0 C0 U0 V0 W0\n") == AxisValues{1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(point("T2 M6\nG43 H1\nG0 Z0\n")[2] == 10);
  CHECK(point("T2 M6\nG43 H0\nG0 Z0\n")[2] == 3);
  CHECK(point("G43\nG0 Z0\n")[2] == 0);
  CHECK(point("T1 M6 G43\nG49\nG0 Z0\n")[2] == 0);
  // in inches: the same 10 mm
  CHECK(point("G20 T1 M6 G43\nG0 Z1\n")[2] == doctest::Approx(35.4));
}

TEST_CASE("G43.1 replaces the offsets of its words, G43.2 adds a tool or its words") {
  CHECK(point("T2 M6 G43\nG43.1 Z7\nG0 X0 Z0\n")[2] == 7);
  CHECK(point("T2 M6 G43\nG43.1 Z7\nG0 X0 Z0\n")[0] == 1);
  CHECK(point("G43 H1\nG43.2 H2\nG43.2 H2\nG0 Z0\n")[2] == 16);
  CHECK(point("G43 H1\nG43.2 Z-0.5\nG0 Z0\n")[2] == 9.5);
  CHECK(code_of("G43.2\n") == Code::tool_offset_unclear);
  CHECK(code_of("G43.2 H1 Z1\n") == Code::tool_offset_unclear);
}

TEST_CASE("G43.1 beside a motion gives its words to both, with a warning") {
  const Outcome outcome = run("G43.1 X1 G0 Y2\n", with_tools());
  CHECK(outcome.codes() == std::vector<Code>{Code::axis_words_shared});
  // the offset is (1, 2): program (1, 2) is machine (2, 4)
  CHECK(outcome.moves().back().end[1] == 4);
  CHECK(run("G0 X5\nG43.1 X1\n", with_tools()).moves().size() == 1);
}

TEST_CASE("a tool length leaves the machine where it stands") {
  // at Z20 without a length; with T1 the program reads 10
  CHECK(point("G0 Z20\nG43 H1\nG0 X#5422\n")[0] == 10);
  CHECK(point("G0 Z20\nG43 H1\nG0 X1\n")[2] == 20);
}

TEST_CASE("parameters 5400 to 5413 tell the tool in the spindle, in mm whatever the units") {
  const std::string load =
      "T2 M6\nG20\n#1=#5400 #2=#5401 #3=#5409 #4=#5410 #5=#5411 #6=#5412 #7=#5413\nG21\n";
  CHECK(point(load + "G0 X#1 Y#2 Z#3 A#4 B#5 C#6 U#7\n") == AxisValues{2, 1, 9, 8, 11, 12, 3});
  // selected is not loaded; T0 empties the spindle
  CHECK(point("T2\nG0 X#5400\n")[0] == 0);
  CHECK(point("T2 M6\nT0 M6\nG0 X[#5400+#5401]\n")[0] == 0);
}

TEST_CASE("M61 gives the tool in the spindle another number without a change") {
  const Outcome outcome = run("T1 M6\nM61 Q2\nG43\nG0 Z0\n", with_tools());
  CHECK(outcome.trace ==
        std::vector<std::string>{
            "SELECT_TOOL 1", "STOP_SPINDLE_TURNING 0", "CHANGE_TOOL 1", "CHANGE_TOOL_NUMBER 2",
            "STRAIGHT_TRAVERSE 0.000000 0.000000 3.000000 0.000000 0.000000 0.000000 0.000000 "
            "0.000000 0.000000",
            "PROGRAM_END"});
  CHECK(code_of("M61\n") == Code::word_missing);
  CHECK(code_of("M61 Q-1\n") == Code::word_out_of_range);
}

TEST_CASE("a tool that the table does not have is refused, without a table every tool is taken") {
  for (const char* text : {"T3\n", "G43 H3\n", "G43.2 H3\n", "M61 Q3\n", "G10 L1 P3 Z1\n"}) {
    CAPTURE(text);
    CHECK(code_of(text) == Code::tool_unknown);
  }
  CHECK_FALSE(run("T3 M6\n").diagnostics.has_errors());
  CHECK(only_code("T3 M6\nG43\n") == Code::tool_length_unknown);
  CHECK(last_point("G10 L1 P3 Z7\nT3 M6 G43\nG0 Z0\n")[2] == 7);
}

TEST_CASE("G10 L1 writes the tool table") {
  CHECK(point("G10 L1 P1 Z7.5\nG43 H1\nG0 Z0\n")[2] == 7.5);
  // a length that is in force stays until the next G43
  CHECK(point("T1 M6 G43\nG10 L1 P1 Z7.5\nG0 Z0\n")[2] == 10);
  // R is a radius; I J Q are angles and orientation
  CHECK(point("T1 M6\nG10 L1 P1 R4 I1 J2 Q9\nG0 X#5410 Y#5411 Z#5412 A#5413\n") == AxisValues{8, 1, 2, 9});
  CHECK(code_of("G10 L1 P1\n") == Code::word_missing);
  CHECK(code_of("G10 L1 P0 Z1\n") == Code::word_out_of_range);
  CHECK(code_of("G10 L1 P1 Q10\n") == Code::word_out_of_range);
}

TEST_CASE("G10 L10 lets the present point read its words as soon as the tool is taken again") {
  // machine Z30 + 3 of T2; that it reads 1 needs a length of 32
  CHECK(point("T2 M6 G43\nG0 Z30\nG10 L10 P2 Z1\nG43\nG0 X#5422\nG0 Z0\n")[2] == 32);
  // under 90 degrees and G92: work zero (10, 5), here program (4, 2) after G92 moved zero by (1, 0)
  const std::string turned = "G10 L2 P1 X10 Y5 R90\nT1 M6 G43\nG0 X5 Y2\nG92 X4\nG10 L10 P1 X1 Y1\nG43\n";
  const AxisValues read = point(turned + "#1=#5420 #2=#5421\nG49 G92.1\nG10 L2 P1 X0 Y0 R0\nG0 X#1 Y#2\n");
  CHECK(read[0] == doctest::Approx(1));
  CHECK(read[1] == doctest::Approx(1));
}

TEST_CASE("G10 L11 measures in G59.3 without G92") {
  // G59.3 lies at Z100, here machine Z130: for 5 the tool is 25 long, whatever G54 and G92 say
  CHECK(point("G10 L2 P9 Z100\nG0 Z130\nG92 Z3\nG10 L11 P1 Z5\nG43 H1\nG92.1\nG0 Z0\n")[2] == 25);
}

TEST_CASE("G10 L0 is refused with a tool in the spindle") {
  CHECK_FALSE(run("G10 L0\n", with_tools()).diagnostics.has_errors());
  CHECK(code_of("T1 M6\nG10 L0\n") == Code::tool_table_busy);
}
