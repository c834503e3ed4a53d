#include <doctest/doctest.h>

#include "gcode/dialect/codes.h"
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
  CHECK(kDialects.list() == "linuxcnc, grbl, mach3, marlin, fanuc, haas");
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
  CHECK(meant_code(Dialect::fanuc, 'G', 700) == code::g20);
  CHECK(meant_code(Dialect::fanuc, 'G', 710) == code::g21);
  CHECK(meant_code(Dialect::fanuc, 'M', 700) == 700);
  CHECK(meant_code(Dialect::marlin, 'G', 700) == 700);
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
