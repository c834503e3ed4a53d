#include <doctest/doctest.h>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// As the commands read a program: the machine has not said its units.
InterpretOptions unsaid() {
  InterpretOptions options;
  options.units_said = false;
  return options;
}

std::vector<Code> codes_of(const std::string& text, const InterpretOptions& options = {}) {
  return run(text, options).codes();
}

std::vector<std::string> messages_of(const std::string& text, const InterpretOptions& options = {}) {
  std::vector<std::string> texts;
  for (const Message& message : run(text, options).all<Message>()) texts.push_back(message.text);
  return texts;
}

std::string formatted(const std::string& text, Diagnostics& diagnostics) {
  SourceSet sources;
  std::string out;
  format_program(sources, sources.add(SourceText("part.ngc", text)), diagnostics, out);
  return out;
}

const std::vector<Code> kNothing{};

}  // namespace

TEST_CASE("a program that gives a length before G20 and G21 is told once, what said its units is not") {
  for (const char* text : {"G0 X1\nX2\nM2\n", "G92 X1\nM2\n", "G10 L2 P1 Z-3\nM2\n", "F9 G2 I5\nM2\n",
                           "G91\nG0 U2\nM2\n", "G0 @5 ^3\nM2\n", "G0 X1\nG21 X2\nM2\n", "G64 P0.1\nM2\n",
                           "G41.1 D2\nG40\nM2\n", "G10 L1 P3 R1\nM2\n"}) {
    CAPTURE(text);
    CHECK(codes_of(text, unsaid()) == std::vector<Code>{Code::units_unsaid});
    CHECK(codes_of(text) == kNothing);
  }
  // 0 is the same in both, angles have no such unit, and a line may say it
  for (const char* text : {"G28 Z0\nG0 X0 Y0\nM2\n", "G0 A90\nM2\n", "G0 X1 G20\nM2\n", "G21\nG0 X1\nM2\n",
                           "M3 S9000\nM5\nM2\n", "G10 L2 P1 R30\nM2\n", "G4 P0.1\nM2\n"}) {
    CAPTURE(text);
    CHECK(codes_of(text, unsaid()) == kNothing);
  }
  // an error comes first
  CHECK(codes_of("G0 X1\nG87\nM2\n", unsaid()) == std::vector<Code>{Code::word_not_run});
}

TEST_CASE("the units of the start hold until the program says others") {
  InterpretOptions options;
  options.inches = true;
  CHECK(last_point("G0 X1\n", options)[0] == doctest::Approx(25.4));
  CHECK(last_point("G21 G0 X1\n", options)[0] == doctest::Approx(1));
}

TEST_CASE("startup holds before the first line and leaves no block") {
  InterpretOptions options;
  options.startup = "G18 G7 G91 G54 F300 S500";
  const Outcome outcome = run("%\nG1 X10 Z1\nG2 X0 Z2 K1\nM3\n%\n", options);
  CHECK(outcome.codes() == std::vector<Code>{Code::spindle_left_running});
  REQUIRE(outcome.moves().size() == 2);
  CHECK(outcome.moves()[0].end[0] == doctest::Approx(5));
  CHECK(outcome.moves()[1].plane == Plane::zx);
  CHECK(outcome.all<SpindleClockwise>().at(0).speed_rpm == doctest::Approx(500));
  CHECK(outcome.blocks.front().span.line == 2);
  // LinuxCNC's usual line, with its naive cam tolerance
  options.startup = "G17 G20 G40 G49 G64 P0.001 Q0.001 G80 G90 G92.1 G94 G97 G98";
  options.units_said = false;
  CHECK(codes_of("G0 X1\nM2\n", options) == std::vector<Code>{Code::word_without_effect});
  CHECK(last_point("G0 X1\n", options)[0] == doctest::Approx(25.4));
}

TEST_CASE("what startup can't say is refused at its place") {
  for (const char* text :
       {"X5", "M3", "G28", "G4 P1", "T1", "#1=2", "O1 sub", "(MSG, a)", "G41.1 D5", "G43", "G33", "%"}) {
    InterpretOptions options;
    options.startup = text;
    const Outcome outcome = run("M2\n", options);
    CAPTURE(text);
    REQUIRE(outcome.diagnostics.has_errors());
    CHECK(outcome.codes().front() == Code::startup_word);
    CHECK(outcome.rendered.find("startup:1:1") != std::string::npos);
  }
}

TEST_CASE("work offsets can be given before the first line") {
  InterpretOptions options;
  options.work_offsets = {{1, {10, 20, -30}}, {7, {1}}};
  CHECK(last_point("G0 X1 Z2\n", options)[0] == doctest::Approx(11));
  CHECK(last_point("G0 X1 Z2\n", options)[2] == doctest::Approx(-28));
  CHECK(last_point("G59.1 G0 X1\n", options)[0] == doctest::Approx(2));
  CHECK(messages_of("(DEBUG,#5223)\n", options) == std::vector<std::string>{"-30.000000"});
}

TEST_CASE("#5021 to #5029 and #5081 to #5089 tell where the machine is and the tool offset in force") {
  CHECK(messages_of("G21 G0 X3 Y4\nG10 L2 P1 X1\n(DEBUG,#5021 #5022 #5421)\n") ==
        std::vector<std::string>{"3.000000 4.000000 4.000000"});
  CHECK(messages_of("G43.1 X1 Z12.5\n(DEBUG,#5081 #5083 #5089)\nG49\n(DEBUG,#5083)\n") ==
        std::vector<std::string>{"1.000000 12.500000 0.000000", "0.000000"});
  CHECK(messages_of("G0 X25.4\nG20\n(DEBUG,#5021)\n") == std::vector<std::string>{"1.000000"});
  CHECK(only_code("#5021=3\n") == Code::parameter_read_only);
  CHECK(only_code("#5089=3\n") == Code::parameter_read_only);
  CHECK(only_code("F9\nG41.1 D1\nG1 X5\n#1=#5022\n") == Code::compensation_conflict);
}

TEST_CASE("a program that aborts itself ends there with an error, one that does not come there runs") {
  const Outcome outcome = run("G0 X1\n(ABORT, tool #5400 is missing)\nG0 X5\nG87\nM2\n");
  CHECK(outcome.codes() == std::vector<Code>{Code::program_aborts});
  CHECK(outcome.rendered.find("tool 0.000000 is missing") != std::string::npos);
  CHECK(outcome.moves().size() == 1);
  CHECK(codes_of("o1 if [0]\n(abort, no)\no1 endif\nG0 X5\nM2\n") == kNothing);
  CHECK(codes_of("(py,x=1)\n;py,x=1\n(python, a remark)\n; py remark\nM2\n") ==
        std::vector<Code>{Code::comment_not_run, Code::comment_not_run});
}

TEST_CASE("nothing behind a % is dropped in silence") {
  for (const char* text :
       {"G0 X1\n%\nG0 X2\nM2\n", "%\nG0 X1\n%\nG0 X2\nM2\n", "o1 if [1]\nG0 X1\no1 endif\n%\nG0 X2\n",
        "G0 X1\nM2\n%\nG0 X3\n", "G0 X1\nM2 (100%)\nG0 X3\n", "G0 X1\n%\n%\n\n(a)\nX3\n"}) {
    CAPTURE(text);
    CHECK(codes_of(text) == std::vector<Code>{Code::words_behind_end});
  }
  for (const char* text : {"G0 X1\nM2\n%\n\n", "G0 X1\n%\n(list of tools)\n; end\n%\n", "%\nG0 X1\nM2\n",
                           "%\nG0 X1\n%\n\x1A", "o1 if [1]\nG0 X1\no1 endif\nM2\nsome text\n%\n"}) {
    CAPTURE(text);
    CHECK(codes_of(text) == kNothing);
  }
}

TEST_CASE("a program that is empty or cut off is told") {
  CHECK(codes_of("") == std::vector<Code>{Code::program_empty});
  CHECK(codes_of("%\n%\n") == kNothing);
  CHECK(codes_of("(remark)\n\n") == std::vector<Code>{Code::program_empty});
  CHECK(codes_of("%\nG0 X1\n") == std::vector<Code>{Code::program_cut});
  CHECK(codes_of("G0 X1\n") == kNothing);
}

TEST_CASE("a carriage return ends lines with a line feed only, and joins none") {
  CHECK(codes_of("G21 G0\rX1\rY2\rM2\r") == std::vector<Code>{Code::carriage_return});
  CHECK(codes_of("G21\r\nG0\rX1\r\nG87\r\n") == std::vector<Code>{Code::carriage_return});
  CHECK(codes_of("G21\r\r\nG0 X1 \r\r\nM2\r\n") == kNothing);
  CHECK(codes_of("o1 if [1]\rG0 X1\ro1 endif\r") == std::vector<Code>{Code::carriage_return});
}

TEST_CASE("a file of another kind gives one error that says what it is") {
  const std::string wide(
      "G\0"
      "0\0 \0X\0"
      "5\0\n\0",
      12);
  CHECK(codes_of(wide) == std::vector<Code>{Code::encoding_other});
  CHECK(codes_of("\xFF\xFE" + wide) == std::vector<Code>{Code::encoding_other});
  CHECK(codes_of("M104 S200\nG28\nG1 X1 E0.5\nX2 E1\n") == std::vector<Code>{Code::kind_other});
  CHECK(codes_of("N1 G1 X=1.5\nN2 DEF REAL A\nN3 MSG(\"a\")\n") == std::vector<Code>{Code::kind_other});
  CHECK(codes_of("#1=1\nIF [#1 EQ 1] GOTO 5\nWHILE [#1 LT 5] DO 1\n") == std::vector<Code>{Code::kind_other});
  // what is right stays right
  CHECK(codes_of("M67 E0 Q1\nG0 X1\nM2\n") == kNothing);
  CHECK(codes_of("(MSG, DEF REAL CYCLE800 E1)\nG0 X1\nM2\n") == kNothing);
  CHECK(only_code("G1 F1 X1 Q2\nM67 E0 Q1\n") == Code::word_unused);
}

TEST_CASE("names are made of what LinuxCNC takes") {
  for (const char* name :
       {"_:pass", "in+out", "x/2", "deep?", "a*b", "a[b]", "a,b", "a#b", "a;b", "a!b", "a=b", "<a"}) {
    CAPTURE(name);
    const std::string parameter = std::string("#<") + name + ">";
    CHECK(last_point(parameter + " = 7\nG0 X" + parameter + "\n")[0] == 7);
  }
  CHECK(only_code("#<a(b)>=1\n") == Code::name_bad);
  CHECK(only_code("#1=#<_ini[a]b>\n") == Code::value_not_given);
}

TEST_CASE("comments may stand between the values of a call") {
  const char* text = "o<s> sub\nG0 X#1 Y#2\no<s> endsub\no<s> call [1] (of what) [2] (end)\nM2\n";
  CHECK(last_point(text)[1] == 2);
  CHECK(last_point("o<s> sub\nG0 X#1\no<s> endsub\no<s> call (c) [4]\nM2\n")[0] == 4);
  CHECK(only_code("o<s> sub\no<s> endsub\no<s> call [1] (a (b) [2]\nM2\n") == Code::comment_nested);
  CHECK(only_code("o<s> sub\no<s> endsub\no<s> call [1] (MSG,a) [2]\nM2\n") == Code::comment_not_run);
  Diagnostics diagnostics;
  CHECK(formatted("o<s> call [1](of what)[2]\n", diagnostics) == "O<s> call [1] [2] (of what)\n");
}

TEST_CASE("fmt keeps as it is what check takes as a remark behind M2") {
  for (const std::string text : {"G0 X1\nM2\nsome text here, e.g. a list of tools\n",
                                 "O1 if [1]\n  G0 X1\nO1 endif\nM30\nsome text (\n"}) {
    Diagnostics diagnostics;
    CHECK(formatted(text, diagnostics) == text);
    CHECK(diagnostics.list().empty());
    CHECK_FALSE(run(text).diagnostics.has_errors());
  }
  // a subroutine behind it is read again
  Diagnostics diagnostics;
  formatted("M2\nsome text (\nO1 sub\nG0 X1.2.3\nO1 endsub\n", diagnostics);
  CHECK(diagnostics.errors() == 1);
}

TEST_CASE("nothing follows from a loop, a branch or a call that was not run as written") {
  // the loop would have led to X30
  CHECK(
      only_code(
          "F100\nG42 D1\n#1=0\no1 do\nG1 X[#1*10]\n#1=[#1+1]\no1 while [#1 LE 3]\nG2 X40 Y0 I5 J0\nG40\n") ==
      Code::compensation_tool_unknown);
  CHECK(only_code("G87\nF100 G91\no1 repeat [3]\nG1 X10\no1 endrepeat\nG90 G2 X40 Y0 I5 J0\n") ==
        Code::word_not_run);
  CHECK(only_code(
            "G87\nF100 G91 #1=0\no1 while [#1 LT 3]\nG1 X10\n#1=[#1+1]\no1 endwhile\nG90 G2 X40 Y0 I5\n") ==
        Code::word_not_run);
  CHECK(only_code("F100 G1 X0\no1 if [#<a> GT 1]\nX30\no1 endif\nG2 X40 Y0 I5\n") == Code::name_not_set);
  CHECK(only_code("o<missing> call [5]\nX5 I3\nG1 X5\nG2 X40 Y0 I5\n") == Code::sub_not_found);
  CHECK(only_code("G87\nM98 P7 L3\nG90 G2 X40 Y0 I5\nM2\nO7\nF100 G91 G1 X10\nM99\n") == Code::word_not_run);
  // a loop that has its one pass hides nothing
  CHECK(codes_of("G87\nF100 G90 G0 X0 Y0\no1 repeat [1]\nG0 X1\no1 endrepeat\nG0 X0 Y0\nG2 X40 Y0 I5\n") ==
        std::vector<Code>{Code::word_not_run, Code::arc_end_off_circle});
}

TEST_CASE("a warning of which a program makes many is told once with its count") {
  const Outcome outcome = run("G21\nG0 X0 Y0\nF1\nG2 X10.02 I5\nG2 X20.045 I5\nG2 X30.06 I5\nM2\n");
  CHECK(outcome.codes() == std::vector<Code>{Code::arc_by_tolerance});
  CHECK(outcome.rendered.find("3 times in this program; at most 0.025 mm off the circle, on line 5") !=
        std::string::npos);
  const Outcome tools = run("T1 M6\nG43 H1\nT2 M6\nG43 H2\nG43 H1\nM2\n");
  CHECK(tools.codes() == std::vector<Code>{Code::tool_length_unknown});
  CHECK(tools.rendered.find("3 times in this program; tools 1, 2") != std::string::npos);
  // a radius as exact as it is written is no fault
  CHECK(codes_of("G0 X76.541 Y66.342\nF9 G3 X79.359 Y67.418 R1.508\nM2\n") == kNothing);
  CHECK(codes_of("F9 G3 X10 R4.999\nM2\n") == std::vector<Code>{Code::arc_by_tolerance});
}

TEST_CASE("an arc that ends a hair behind its start is told, one that means its turn is not") {
  CHECK(codes_of("G0 X10\nF9 G3 X10 Y-0.0001 I-10\nM2\n") == std::vector<Code>{Code::arc_full_circle});
  CHECK(codes_of("G0 X10\nF9 G2 X10 Y0.0001 I-10\nM2\n") == std::vector<Code>{Code::arc_full_circle});
  CHECK(codes_of("G0 X10\nF9 G3 I-10\nM2\n") == kNothing);
  CHECK(codes_of("G0 X10\nF9 G3 X10 Y0.0001 I-10\nM2\n") == kNothing);
  CHECK(codes_of("G0 X10\nF9 G3 X10 Y-0.0001 I-10 P2\nM2\n") == kNothing);
}

TEST_CASE("axis words beside a code that reads none are told where they move the machine") {
  for (const char* text :
       {"G0 X1\nG28.1 X5\nM2\n", "G0 X1\nG30.1 X5\nM2\n", "G0 X1\nG92.1 X5\nM2\n", "G0 X1\nG4 P1 X5\nM2\n"}) {
    CAPTURE(text);
    CHECK(codes_of(text) == std::vector<Code>{Code::axis_words_move});
  }
  CHECK(codes_of("G0 X1\nG28.1\nG0 G92.1 X5\nG4 P1\nM2\n") == kNothing);
}

TEST_CASE("K0 on an arc of the XY plane is read as grbl and Marlin do") {
  const char* text = "F9 G2 X10 I5 K0.000\nM2\n";
  CHECK(only_code(text) == Code::arc_offset_outside_plane);
  for (const Dialect dialect : {Dialect::grbl, Dialect::marlin}) {
    InterpretOptions options;
    options.dialect = dialect;
    CHECK(codes_of(text, options) == kNothing);
    CHECK(codes_of("F9 G2 X10 I5 K2\nM2\n", options) == std::vector<Code>{Code::word_without_effect});
  }
}

TEST_CASE("G7 on the line of G76 halves its depths as LinuxCNC does") {
  // rs274: 19.4 with G7 on the line, 18.8 where it held before
  const char* head = "G18 S200 M3\nG0 X20 Z5\n";
  const Outcome same = run(std::string(head) + "G7 G76 P2 Z-30 I-2 J0.4 K1.2\nM2\n");
  CHECK(same.moves()[1].end[0] == doctest::Approx(20.2));
  CHECK(same.moves()[2].end[0] == doctest::Approx(19.4));
  const Outcome before = run(std::string(head) + "G7\nG7 G76 P2 Z-30 I-2 J0.4 K1.2\nM2\n");
  CHECK(before.moves()[2].end[0] == doctest::Approx(18.8));
}
