#include <doctest/doctest.h>

#include "gcode/dialect/dialect_codes.h"
#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

InterpretOptions of(Dialect dialect) {
  InterpretOptions options;
  options.dialect = dialect;
  return options;
}

/// Seconds of the only dwell of a program, -1 if there are none or several.
double dwell_s(const std::string& text, Dialect dialect) {
  const std::vector<Dwell> dwells = run(text, of(dialect)).all<Dwell>();
  return dwells.size() == 1 ? dwells[0].time_s : -1;
}

}  // namespace

TEST_CASE("each dialect has its name") {
  for (const auto& dialect : kDialects) CHECK(kDialects.find(dialect.word) == dialect.value);
  CHECK(kDialects.list() == "linuxcnc, grbl, mach3, marlin, reprap, fanuc, haas");
  CHECK_FALSE(kDialects.find("heidenhain"));
}

TEST_CASE("G4 P is seconds in linuxcnc and grbl, milliseconds in marlin and fanuc") {
  CHECK(dwell_s("G4 P500\n", Dialect::linuxcnc) == 500);
  CHECK(dwell_s("G4 P500\n", Dialect::grbl) == 500);
  CHECK(dwell_s("G4 P500\n", Dialect::marlin) == 0.5);
  CHECK(dwell_s("G4 P500\n", Dialect::fanuc) == 0.5);
  CHECK(dwell_s("G4 S2\n", Dialect::marlin) == 2);
  CHECK(dwell_s("G4 P500 S2\n", Dialect::marlin) == 2);
  CHECK(dwell_s("G4 X2.5\n", Dialect::fanuc) == 2.5);
  CHECK(dwell_s("G4 U2.5\n", Dialect::fanuc) == 2.5);
}

TEST_CASE("S of a marlin dwell is no spindle speed, X of a fanuc dwell no motion") {
  CHECK(run("G4 S2\n", of(Dialect::marlin)).trace ==
        std::vector<std::string>{"DWELL 2.000000", "PROGRAM_END"});
  CHECK(run("G0 X1\nG4 X2\n", of(Dialect::fanuc)).moves().size() == 1);
  CHECK(only_code("G4 S2\n") == Code::word_missing);
}

TEST_CASE("G70 and G71 are inches and millimetres in fanuc only") {
  CHECK(last_point("G70 G0 X1\n", of(Dialect::fanuc))[0] == 25.4);
  CHECK(last_point("G70\nG71 G0 X1\n", of(Dialect::fanuc))[0] == 1);
  CHECK(only_code("G70\n") == Code::word_not_run);
}

TEST_CASE("a dialect means codes of LinuxCNC by its own") {
  CHECK(dialect_code(Dialect::fanuc, 'G', 700)->meant == code::g20);
  CHECK(dialect_code(Dialect::fanuc, 'G', 710)->meant == code::g21);
  CHECK(dialect_code(Dialect::fanuc, 'M', 700) == nullptr);
  CHECK(dialect_code(Dialect::grbl, 'G', 700) == nullptr);
}

TEST_CASE("P of a fanuc M98 tells repeats and program, unless L tells the repeats") {
  CHECK(subprogram_call(Dialect::fanuc, 30004).number == 4);
  CHECK(subprogram_call(Dialect::fanuc, 30004).repeats == 3);
  CHECK(subprogram_call(Dialect::fanuc, 1234).number == 1234);
  CHECK(subprogram_call(Dialect::fanuc, 1234).repeats == 1);
  CHECK(subprogram_call(Dialect::linuxcnc, 30004).number == 30004);
  const std::string sub = "M2\nO4\nG91 G0 X1\nM99\n";
  CHECK(last_point("M98 P30004\n" + sub, of(Dialect::fanuc))[0] == 3);
  CHECK(last_point("M98 P4 L2\n" + sub, of(Dialect::fanuc))[0] == 2);
}

TEST_CASE("a dwell is in the unit of its controller, in cycles too") {
  const std::string hole = "F100 S100 M3 G0 Z5\nG82 X1 Z-1 R1 P500\n";
  CHECK(dwell_s(hole, Dialect::linuxcnc) == 500);
  CHECK(dwell_s(hole, Dialect::mach3) == 0.5);
  CHECK(dwell_s(hole, Dialect::fanuc) == 0.5);
  CHECK(dwell_s(hole, Dialect::haas) == 0.5);
  CHECK(dwell_s("F100 S100 M3 G0 Z5\nG82 X1 Z-1 R1 P1.5\n", Dialect::haas) == 1.5);
  CHECK(dwell_s("G4 P2.\n", Dialect::haas) == 2);
}

TEST_CASE("codes without effect are told once each, with their count") {
  const Outcome outcome = run("M104 S200\nM106 S9\nM104 S210\nG1 X5 F600\n", of(Dialect::marlin));
  CHECK(outcome.codes() == std::vector<Code>{Code::word_told, Code::word_told});
  CHECK(outcome.rendered.find("2 times in this program") != std::string::npos);
  // S of M104 is a temperature
  CHECK(outcome.all<SpindleSpeed>().empty());
}

TEST_CASE("G0 of marlin moves at F, or at its own feed before the first F") {
  CHECK(run("G0 X10 F600\n", of(Dialect::marlin)).moves()[0].feed_u_s == 10);
  CHECK(run("G0 X10\n", of(Dialect::marlin)).moves()[0].feed_u_s == 25);
  CHECK(run("G0 X10\n", of(Dialect::reprap)).moves()[0].feed_u_s == 50);
}

TEST_CASE("a peck tap goes down Q by Q, each time back to R") {
  // from R2 to -4 by 2.5: bottoms -0.5, -3 and -4
  const Outcome outcome = run("F100 S100 M3 G0 Z5\nG99 G84 X0 Z-4 R2 Q2.5\n", of(Dialect::fanuc));
  REQUIRE_FALSE(outcome.diagnostics.has_errors());
  std::vector<double> levels;
  for (const LineOrArc& move : outcome.moves())
    if (move.kind == BlockKind::feed) levels.push_back(move.end[2]);
  CHECK(levels == std::vector<double>{-0.5, 2, -3, 2, -4, 2});
}

TEST_CASE("further work systems have offsets of their own") {
  CHECK(last_point("G54.1 P3\nG10 L20 P3 X5\nG54\nG54.1 P3\nG0 X1\n", of(Dialect::fanuc))[0] == 6);
  InterpretOptions options = of(Dialect::haas);
  options.work_offsets = {{kPlainWorkSystems + 20, {7}}};
  CHECK(last_point("G129 G0 X1\n", options)[0] == 8);
  CHECK(only_code("G154 P100\n", of(Dialect::haas)) == Code::word_out_of_range);
  CHECK(only_code("G154\n", of(Dialect::haas)) == Code::word_missing);
}

TEST_CASE(",R touches both moves, ,C cuts as much off each") {
  // a corner of 90 degrees at (10, 0): the circle of radius 2 touches at (8, 0) and (10, 2), its centre is (8, 2)
  const Outcome outcome = run("F60 G1 X10 ,R2\nY10 ,C1\nX0\n", of(Dialect::fanuc));
  REQUIRE_FALSE(outcome.diagnostics.has_errors());
  const auto moves = outcome.moves();
  REQUIRE(moves.size() == 5);
  CHECK(moves[0].end[0] == doctest::Approx(8).epsilon(1e-12));
  CHECK(moves[1].kind == BlockKind::arc);
  CHECK(moves[1].center_first_mm == doctest::Approx(8).epsilon(1e-12));
  CHECK(moves[1].center_second_mm == doctest::Approx(2).epsilon(1e-12));
  CHECK(moves[1].turns == 1);
  CHECK(moves[1].length_u == doctest::Approx(3.14159265358979).epsilon(1e-12));
  CHECK(moves[1].feed_u_s == 1);
  CHECK(moves[2].end[1] == doctest::Approx(9).epsilon(1e-12));
  CHECK(moves[3].end[0] == doctest::Approx(9).epsilon(1e-12));
  CHECK(moves[3].end[1] == doctest::Approx(10).epsilon(1e-12));
  CHECK(moves[4].end[0] == doctest::Approx(0).epsilon(1e-12));
  CHECK(moves[4].length_u == doctest::Approx(9).epsilon(1e-12));
}

TEST_CASE(",R between a line and an arc touches the line and the arc") {
  // tangent moves have no corner
  const Outcome outcome = run("F60 G1 X0 Y0\nG1 X10 Y0 ,R1\nG3 X10 Y10 J5\n", of(Dialect::haas));
  REQUIRE_FALSE(outcome.diagnostics.has_errors());
  CHECK(outcome.moves().size() == 3);
  const auto moves = run("F60 G1 X10 Y0 ,R1\nG3 X0 Y10 I-10\n", of(Dialect::haas)).moves();
  REQUIRE(moves.size() == 3);
  // the centre is 1 above the line and 1 inside the arc of radius 10 about 0: x = sqrt(81 - 1)
  CHECK(moves[0].end[0] == doctest::Approx(8.94427190999916).epsilon(1e-12));
  CHECK(moves[1].center_first_mm == doctest::Approx(8.94427190999916).epsilon(1e-12));
  CHECK(moves[1].center_second_mm == doctest::Approx(1).epsilon(1e-12));
  CHECK(moves[1].end[0] == doctest::Approx(8.94427190999916 * 10 / 9).epsilon(1e-12));
  CHECK(moves[1].end[1] == doctest::Approx(10.0 / 9).epsilon(1e-12));
}

TEST_CASE("a corner that can't be made is refused, and the moves stay") {
  for (const char* text :
       {"G1 X10 ,R20\nY10\n", "G1 X10 ,R2\nG0 Y10\n", "G1 X10 ,C2\nM30\n", "G0 X10 ,R2\nG1 Y10\n",
        "G1 X10 ,C2\nG3 X0 Y10 I-10\n", "G1 X10 ,R2\nY10 Z5\n", "G1 X10 ,R2 ,C2\nY10\n"}) {
    CAPTURE(text);
    CHECK(only_code(std::string("F60\n") + text, of(Dialect::fanuc)) == Code::corner_place);
  }
}

TEST_CASE("a dialect is recognised by its words, and taken or suggested") {
  const auto taken = [](const std::string& text) {
    SourceSet sources;
    const std::uint32_t file = sources.add(SourceText("part.nc", text));
    Reading reading;
    Diagnostics diagnostics;
    recognise_dialect(sources, file, reading, diagnostics);
    CHECK(diagnostics.list().size() == 1);
    return reading.dialect;
  };
  CHECK(taken("G0 X1\n") == Dialect::linuxcnc);
  CHECK(taken("N10 IF [#1 EQ 2] GOTO 20\n") == Dialect::fanuc);
  CHECK(taken("IF [#1 EQ 2] GOTO 20\nG154 P3\n") == Dialect::haas);
  CHECK(taken("$H\nG0 X1\n") == Dialect::grbl);
  CHECK(taken("G3\nX1 R5\n") == Dialect::mach3);
  CHECK(taken("M104 S200\n") == Dialect::marlin);
  CHECK(taken("(IF [#1 EQ 2] GOTO 20)\n; M104 S1\nG0 X1 (G154 P2)\n") == Dialect::linuxcnc);
  CHECK(run("G154 P2\n").codes() == std::vector<Code>{Code::unknown_code, Code::dialect_recognised});
  InterpretOptions said;
  said.dialect_said = true;
  CHECK(run("G154 P2\n", said).codes() == std::vector<Code>{Code::unknown_code});
}

TEST_CASE("a jog of grbl is warned of, other lines for the controller are counted") {
  const Outcome outcome = run("$H\n$J=G91 X5 F100\n?\nG0 X1\n", of(Dialect::grbl));
  CHECK(outcome.diagnostics.warnings() == 1);
  CHECK(outcome.rendered.find("2 times in this program") != std::string::npos);
}
