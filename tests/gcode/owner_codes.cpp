#include <doctest/doctest.h>

#include <string>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

// Codes of the machine's owner, and values that the machine gives: [codes], --ignore, --ini, --hal.

namespace {

InterpretOptions ignoring(const std::vector<const char*>& codes) {
  InterpretOptions options;
  for (const char* code : codes) options.ignored.push_back(*machine::parse_code_name(code));
  return options;
}

InterpretOptions owning(const machine::OwnerCode& own) {
  InterpretOptions options;
  options.codes.own = {own};
  return options;
}

machine::OwnerCode owner_code(const char* code) {
  machine::OwnerCode own;
  own.code = *machine::parse_code_name(code);
  return own;
}

machine::OwnerCode calling(const char* code, const char* sub) {
  machine::OwnerCode own = owner_code(code);
  own.call = sub;
  return own;
}

InterpretOptions with_ini(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  InterpretOptions options;
  options.ini = read_ini_file(sources, sources.add(SourceText("m.ini", text)), diagnostics);
  CHECK(diagnostics.list().empty());
  return options;
}

}  // namespace

TEST_CASE("names of codes are read as programs write them, and others are refused") {
  CHECK(machine::code_text(*machine::parse_code_name("m031")) == "M31");
  CHECK(machine::code_text(*machine::parse_code_name("g12.1")) == "G12.1");
  CHECK(machine::code_text(*machine::parse_code_name("G187")) == "G187");
  for (const char* text : {"", "M", "T5", "M-1", "M1.5", "G1.23", "G1.", "M31 ", "M100000", "31"}) {
    CAPTURE(text);
    CHECK(!machine::parse_code_name(text));
  }
}

TEST_CASE("a code that is passed over takes the words along that nothing else reads") {
  const Outcome outcome =
      run("G1 F100 X1 M42 P4\nM42 S255 P1\nM3 S500 M42\nX3 M31\nM2\n", ignoring({"M42", "M31"}));
  CHECK(!outcome.diagnostics.has_errors());
  REQUIRE(outcome.moves().size() == 2);
  CHECK(outcome.moves()[0].end[0] == 1);
  CHECK(outcome.moves()[1].end[0] == 3);
  // S255 stands alone with M42 and is its own; S500 belongs to M3
  REQUIRE(outcome.all<SpindleSpeed>().size() == 1);
  CHECK(outcome.all<SpindleSpeed>()[0].s_word == 500);
  CHECK(outcome.all<SpindleClockwise>().size() == 1);
}

TEST_CASE("each code that is passed over is told once, with its count") {
  const Outcome outcome = run("M31\nG0 X1 M31\nM42\nM31 P3\nM2\n", ignoring({"M42", "M31"}));
  CHECK(outcome.codes() == std::vector<Code>{Code::code_passed_over, Code::code_passed_over});
  CHECK(outcome.diagnostics.warnings() == 2);
  CHECK(outcome.rendered.find("3 times in this program; on line 4 with P3") != std::string::npos);
}

TEST_CASE("axis words belong to the motion in force beside an M code, and to a G code that stands alone") {
  const Outcome m = run("G0 X1\nX5 M31\nM2\n", ignoring({"M31"}));
  CHECK(m.moves().back().end[0] == 5);
  const Outcome g = run("G0 X1\nG187 X5\nG187 G0 Y2\nM2\n", ignoring({"G187"}));
  CHECK(!g.diagnostics.has_errors());
  REQUIRE(g.moves().size() == 2);
  CHECK(g.moves().back().end[0] == 1);
  CHECK(g.moves().back().end[1] == 2);
}

TEST_CASE("a code that kadr runs can't be passed over") {
  CHECK(only_code("G0 X1\nM2\n", ignoring({"M8"})) == Code::owner_code_taken);
  CHECK(only_code("G0 X1\nM2\n", ignoring({"G1"})) == Code::owner_code_taken);
  CHECK(only_code("G0 X1\nM2\n", owning(calling("M8", "coolant"))) == Code::owner_code_taken);
}

TEST_CASE("a code of the owner takes its time and switches its output") {
  machine::OwnerCode own = owner_code("M10");
  own.time_s = 1.5;
  own.output = 3;
  const Outcome at_rest = run("G0 X1\nM10 P7\nG0 X2\nM2\n", owning(own));
  CHECK(at_rest.diagnostics.list().empty());
  REQUIRE(at_rest.all<DigitalOutput>().size() == 1);
  CHECK(at_rest.all<DigitalOutput>()[0].number == 3);
  CHECK(at_rest.all<DigitalOutput>()[0].on);
  CHECK(!at_rest.all<DigitalOutput>()[0].with_motion);
  REQUIRE(at_rest.all<Dwell>().size() == 1);
  CHECK(at_rest.all<Dwell>()[0].time_s == 1.5);

  own.time_s = 0;
  own.on = own.stop = false;
  const Outcome moving = run("G0 X1\nM10\nG0 X2\nM2\n", owning(own));
  REQUIRE(moving.all<DigitalOutput>().size() == 1);
  CHECK(!moving.all<DigitalOutput>()[0].on);
  CHECK(moving.all<DigitalOutput>()[0].with_motion);
  CHECK(moving.all<Dwell>().empty());
}

TEST_CASE("the time of an M code that kadr runs follows it") {
  machine::OwnerCode own = owner_code("M3");
  own.time_s = 200;  // no word of the program: nothing asks whether milliseconds were meant
  const Outcome outcome = run("M3 S100\nG4 P0.5\nM5\nM2\n", owning(own));
  CHECK(outcome.diagnostics.list().empty());
  REQUIRE(outcome.all<Dwell>().size() == 2);
  CHECK(outcome.all<Dwell>()[0].time_s == 200);
  CHECK(outcome.all<SpindleClockwise>().size() == 1);
}

TEST_CASE("a code that is bound to a subroutine runs it with the words of its line") {
  const std::string sub = "o<clamp> sub\nG4 P#<p>\n#<_q> = #<q>\no<clamp> endsub\n";
  const Outcome outcome =
      run(sub + "#1=7\nM150 P0.5 Q3\nG0 X[#<_q> + #1]\nM2\n", owning(calling("M150", "clamp")));
  CHECK(outcome.diagnostics.list().empty());
  REQUIRE(outcome.all<Dwell>().size() == 1);
  CHECK(outcome.all<Dwell>()[0].time_s == 0.5);
  CHECK(outcome.moves().back().end[0] == 10);
  // a word that is missing has no value in the subroutine
  CHECK(only_code(sub + "M150 P1\nM2\n", owning(calling("M150", "clamp"))) == Code::name_not_set);
  CHECK(only_code("M150\nM2\n", owning(calling("M150", "clamp"))) == Code::sub_not_found);
}

TEST_CASE("M6 in the subroutine of M6 is the tool change itself") {
  const std::string sub = "o<change> sub\nG53 G0 Z5\nM6\no<change> endsub\n";
  const Outcome outcome = run(sub + "T3 M6\nM2\n", owning(calling("M6", "change")));
  CHECK(!outcome.diagnostics.has_errors());
  REQUIRE(outcome.all<ChangeTool>().size() == 1);
  CHECK(outcome.all<ChangeTool>()[0].tool == 3);
  CHECK(outcome.moves().size() == 1);
  // of any other code there is nothing behind the subroutine
  CHECK(only_code("o<a> sub\nM150\no<a> endsub\nM150\nM2\n", owning(calling("M150", "a"))) ==
        Code::word_not_run);
}

TEST_CASE("an unknown code is told once with its count, and the help names the way") {
  const Outcome outcome = run("M101\nG0 X1\nM101\nM55 P2\nM101\nM2\n");
  CHECK(outcome.codes() == std::vector<Code>{Code::word_not_run, Code::unknown_code});
  CHECK(outcome.rendered.find("3 times in this program") != std::string::npos);
  CHECK(outcome.rendered.find("--ignore M101") != std::string::npos);
  CHECK(outcome.rendered.find("--ignore M55") != std::string::npos);
}

TEST_CASE("an INI file gives the values of its sections in capitals") {
  const InterpretOptions options = with_ini(
      "# head\n[TOOLSENSOR]\n; place\nX = 3.5\nX = 4\nZ=-10 mm\nlow = 1\nNAME = left\nLONG = "
      "1\\\n2\n[OTHER]\nX=9\n");
  CHECK(last_point("G0 X#<_ini[toolsensor]x>\n", options)[0] == 3.5);
  CHECK(last_point("G0 X#<_INI[ToolSensor]X>\n", options)[0] == 3.5);
  CHECK(last_point("G0 Z#<_ini[toolsensor]z>\n", options)[2] == -10);
  CHECK(last_point("G0 X#<_ini[OTHER]X>\n", options)[0] == 9);
  CHECK(last_point("G0 X#<_ini[TOOLSENSOR]LONG>\n", options)[0] == 12);
  CHECK(last_point("G0 X[EXISTS[#<_ini[toolsensor]x>] + 2 * EXISTS[#<_ini[toolsensor]y>]]\n", options)[0] ==
        1);
  for (const char* name :
       {"_ini[TOOLSENSOR]Y", "_ini[TOOLSENSOR]LOW", "_ini[TOOLSENSOR]NAME", "_ini[NONE]X"}) {
    CAPTURE(name);
    CHECK(only_code("G0 X#<" + std::string(name) + ">\n", options) == Code::value_not_given);
  }
  CHECK(run("G0 X#<_ini[PROBE]FEED>\n", options).rendered.find("m.ini has no [PROBE]FEED") !=
        std::string::npos);
}

TEST_CASE("a HAL pin has the value that is given, and no program sets a value of the machine") {
  InterpretOptions options;
  options.hal = {{"plasmac.cut-feed-rate", 1500}};
  CHECK(last_point("G0 X#<_hal[plasmac.cut-feed-rate]>\n", options)[0] == 1500);
  CHECK(only_code("G0 X#<_hal[other]>\n", options) == Code::value_not_given);
  CHECK(only_code("#<_hal[plasmac.cut-feed-rate]> = 1\n", options) == Code::parameter_read_only);
  CHECK(only_code("#<_ini[A]B> = 1\n", options) == Code::parameter_read_only);
}
