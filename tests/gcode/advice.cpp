#include <doctest/doctest.h>

#include <string>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

// Warnings about what is legal: each rule once where it must speak, and where it must be silent.

namespace {

/// T1 50 mm, T2 80 mm, T3 as long as T1.
InterpretOptions tool_options() {
  InterpretOptions options;
  ToolTable table;
  for (const auto& [number, length_mm] : {std::pair{1, 50.0}, {2, 80.0}, {3, 50.0}}) {
    Tool tool;
    tool.number = tool.pocket = number;
    tool.offset[2] = length_mm;
    table.tools.push_back(tool);
  }
  options.tools = table;
  return options;
}

std::vector<Code> codes(const std::string& text) { return run(text, tool_options()).codes(); }

}  // namespace

TEST_CASE("a cut with the spindle stopped is told once, at its first move down") {
  const Outcome outcome = run("G0 Z5\nT1 M6\nM3 S100\nG1 Z-1 F100\nG0 Z5\nM6 T2\nG1 X5\nZ-1\nZ-2\nZ-3\nM2\n");
  CHECK(outcome.codes() == std::vector<Code>{Code::cut_without_spindle});
  CHECK(outcome.diagnostics.list()[0].span.line == 8);
  // M5 stops it as well
  CHECK(codes("M3 S100\nG0 Z5\nM5\nG1 Z-1 F100\nM2\n") == std::vector<Code>{Code::cut_without_spindle});
}

TEST_CASE("the spindle may stand where nothing is cut") {
  CHECK(codes("G0 Z5\nG1 Z-1 F100\nX5\nG0 Z5\nM2\n").empty());                        // a plotter
  CHECK(codes("G0 Z5\nM3 S100\nG1 Z-1 F100\nG0 Z5\nM5\nG1 X50\nZ50\nM2\n").empty());  // parking
  CHECK(codes("G1 X5 Y5 F900\nG1 Z5\nM3 S100\nG1 Z-1 F100\nG0 Z5\nM2\n").empty());    // approach by G1
  CHECK(codes("G0 Z5\nM3 S1\nG1 Z-1 F100\nM5\nM4\nG1 Z-2\nM2\n").empty());            // reversed
}

TEST_CASE("a spindle that nobody stops is told where it was started") {
  const Outcome outcome = run("M3 S100\nG0 X5\nM4\nG0 X6\n");
  CHECK(outcome.codes() == std::vector<Code>{Code::spindle_left_running});
  CHECK(outcome.diagnostics.list()[0].span.line == 3);
  for (const std::string end : {"M2\n", "M30\n", "M5\n"}) CHECK(codes("M3 S100\nG0 X5\n" + end).empty());
}

TEST_CASE("the length of another tool is told at the first move down, not where a length was named") {
  const std::string head = "T1 M6\nG43.1 Z50\nG0 Z90\nM6 T2\nG0 X5\n";
  CHECK(codes(head + "Z80\nZ70\nM2\n") == std::vector<Code>{Code::length_of_other_tool});
  CHECK(codes(head + "G1 Z80 F100\nM2\n") == std::vector<Code>{Code::length_of_other_tool});
  CHECK(codes(head + "Z99\nM2\n").empty());
  CHECK(codes(head + "G49\nZ80\nM2\n").empty());
  CHECK(codes(head + "G43.1 Z81\nZ80\nM2\n").empty());
  // the same length, an empty spindle, a tool that no table names
  CHECK(codes("T1 M6\nG43.1 Z50\nG0 Z90\nT3 M6\nZ80\nM2\n").empty());
  CHECK(codes("T1 M6\nG43.1 Z50\nG0 Z90\nT0 M6\nZ80\nM2\n").empty());
  CHECK(run("T1 M6\nG43.1 Z50\nG0 Z90\nT2 M6\nZ80\nM2\n").codes().empty());
}

TEST_CASE("G28 is told only where its first move goes down") {
  CHECK(codes("G0 Z40\nG28 Z0\nM2\n") == std::vector<Code>{Code::reference_by_below});
  CHECK(codes("G0 Z40\nG30 Z39.9\nM2\n") == std::vector<Code>{Code::reference_by_below});
  for (const std::string line : {"G91 G28 Z0", "G28", "G28 X0 Y0", "G28 Z50", "G91 G30 Z5"}) {
    CAPTURE(line);
    CHECK(codes("G0 Z40\n" + line + "\nM2\n").empty());
  }
}

TEST_CASE("a dwell is long from 100 s on, where P is in seconds") {
  CHECK(codes("G4 P100\nM2\n") == std::vector<Code>{Code::long_dwell});
  CHECK(codes("G4 P99\nM2\n").empty());
  CHECK(run("G4 P100\nM2\n").diagnostics.list()[0].help == "if milliseconds were meant, write P0.1");
}

TEST_CASE("a parameter of one's own that is read before it is set is told once") {
  CHECK(codes("#100=1\nG0 X#100 Y#101 Z[#101+#101]\nG0 X#101\nM2\n") ==
        std::vector<Code>{Code::parameter_never_set});
  // set on the line before, values of a subroutine, what the controller sets
  CHECK(codes("#31=1\nG0 X#31 Y#5 Z#5220 A#5161\nM2\n").empty());
  // a line that sets a parameter reads its old value
  CHECK(codes("#40=[#40+1]\nM2\n") == std::vector<Code>{Code::parameter_never_set});
}
