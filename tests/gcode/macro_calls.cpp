#include <doctest/doctest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "macro_support.h"

/// G65, G66, M97, M98 and M99 of macro B.
using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

using Points = std::vector<double>;

TEST_CASE("the words of G65 are #1 to #26 of the macro") {
  // A B C I J K D E F H M Q R S T U V W X Y Z
  const std::string call =
      "G65 P9010 A1 B2 C3 I4 J5 K6 D7 E8 F9 H11 M13 Q17 R18 S19 T20 U21 V22 W23 X24 Y25 Z26\n";
  std::string macro = "M30\nO9010\nG0 X0\n";
  Points expected{0};
  for (int variable = 1; variable <= 26; ++variable) {
    macro += "X#" + std::to_string(variable) + "\n";
    // #10 #12 #14 #15 #16 belong to no letter
    const bool vacant = variable == 10 || variable == 12 || (variable >= 14 && variable <= 16);
    if (!vacant) expected.push_back(variable);
  }
  CHECK(macro_xs(call + macro + "M99\n") == expected);
}

TEST_CASE("I J K come in sets, and the later of two words counts") {
  const std::string macro = "M30\nO1\nG0 X0\nX#4\nX#5\nX#6\nX#7\nX#8\nX#9\nX#10\nM99\n";
  CHECK(macro_xs("G65 P1 I1 J2 K3 I4 J5 K6 I7\n" + macro) == Points{0, 1, 2, 3, 4, 5, 6, 7});
  CHECK(macro_xs("G65 P1 I1 I2 J3\n" + macro) == Points{0, 1, 2, 3});
  CHECK(macro_xs("G65 P1 K1 I2\n" + macro) == Points{0, 1, 2});
  // FANUC's own example: I-3 is #4, I4 and D5 are #7, and D counts
  CHECK(macro_xs("G65 A1.0 B2.0 I-3.0 I4.0 D5.0 P1\n" + macro) == Points{0, -3, 5});
  std::string eleven = "G65 P1";
  for (int i = 0; i < 11; ++i) eleven += " K1";
  CHECK(macro_error(eleven + "\n" + macro) == MacroError{Code::macro_argument, 1});
}

TEST_CASE("each macro call has variables of its own, and gives the caller's back") {
  CHECK(macro_xs("#1=5 #33=6\nG65 P1 A7\nG0 X#1\nX#33\nM30\n"
                 "O1\nG0 X#1\nX#33\n#1=8 #33=9\nX#33\nM99\n") == Points{7, 9, 5, 6});
  // common variables are those of all
  CHECK(macro_xs("#100=5\nG65 P1\nG0 X#100\nM30\nO1\n#100=#100+1\nM99\n") == Points{6});
  // M98 shares the caller's
  CHECK(macro_xs("#1=5\nM98 P1\nG0 X#1\nM30\nO1\n#1=#1+1\nM99\n") == Points{6});
}

TEST_CASE("L repeats a macro, with the arguments as given") {
  CHECK(macro_xs("G65 P1 A1 L3\nM30\nO1\nG0 X#1\n#1=#1+1\nX#1\nM99\n") == Points{1, 2, 1, 2, 1, 2});
  CHECK(macro_xs("G65 P1 L0\nG0 X3\nM30\nO1\nG0 X9\nM99\n") == Points{3});
}

TEST_CASE("arguments are expressions, and a vacant one stays vacant") {
  CHECK(macro_xs("#5=3\nG65 P[1+1] A[#5*2] B-#5 C#6\nM30\nO2\nG0 X#1\nX#2\nX#3\nM99\n") == Points{6, -3});
}

TEST_CASE("a line of G65 holds nothing else") {
  const std::string macro = "M30\nO1\nM99\n";
  CHECK(macro_error("G65 P1 G1 X5\n" + macro) == MacroError{Code::macro_argument, 1});
  CHECK(macro_error("G65 P1 #3=5\n" + macro) == MacroError{Code::macro_argument, 1});
  CHECK(macro_error("G65 A1\n" + macro) == MacroError{Code::word_missing, 1});
  CHECK(macro_error("G65 P1.5\n" + macro) == MacroError{Code::word_not_whole, 1});
  CHECK(macro_error("G65 P77\n" + macro) == MacroError{Code::sub_not_found, 1});
}

TEST_CASE("G66 calls its macro behind each move, until G67") {
  const std::string macro = "O1\nG0 Y#1\nM99\n";
  const Outcome outcome =
      run("G0 X1\nG66 P1 A5\nX2\n\n(no move)\nS100\nX3 M8\nG67\nX4\nM30\n" + macro, of_fanuc());
  CHECK_FALSE(outcome.diagnostics.has_errors());
  Points xs, ys;
  for (const LineOrArc& move : outcome.moves()) {
    xs.push_back(move.end[0]);
    ys.push_back(move.end[1]);
  }
  CHECK(xs == Points{1, 2, 2, 3, 3, 4});
  CHECK(ys == Points{0, 0, 5, 5, 5, 5});
  // the moves of the macro call nothing
  CHECK(macro_xs("G66 P1 A5\nG0 X2\nG67\nM30\nO1\nG0 X7\nX8\nM99\n") == Points{2, 7, 8});
  CHECK(only_code("G66.1 P1\nM30\nO1\nM99\n", of_fanuc()) == Code::word_not_run);
  // L
  CHECK(macro_xs("G66 P1 L2\nG0 X2\nG67\nM30\nO1\nG0 X7\nM99\n") == Points{2, 7, 7});
}

TEST_CASE("M98 takes repeats and number in eight digits of a fanuc, or L") {
  const std::string sub = "M30\nO1001\nG91 G0 X1\nG90\nM99\n";
  CHECK(macro_xs("M98 P21001\n" + sub) == Points{1, 2});
  CHECK(macro_xs("M98 P00031001\n" + sub) == Points{1, 2, 3});
  CHECK(macro_xs("M98 P1001 L2\n" + sub) == Points{1, 2});
  CHECK(macro_xs("M98 P1001 L2\n" + sub, of_haas()) == Points{1, 2});
}

TEST_CASE("M99 P leads a fanuc to a line of the caller, a haas to one of the same program") {
  const std::string text =
      "O1\nM98 P2\nG0 X1\nN50 G0 X2\nM30\n"
      "O2\nG0 X3\nIF [#1 EQ 1] GOTO 60\n#1=1\nM99 P50\nG0 X4\nN50 X5\nN60 M99\n";
  CHECK(macro_xs(text, of_fanuc()) == Points{3, 2});
  CHECK(macro_xs(text, of_haas()) == Points{3, 5, 1, 2});
  CHECK(macro_error("O1\nM98 P2\nM30\nO2\nM99 P7\n") == MacroError{Code::sequence_number_missing, 5});
}

TEST_CASE("M99 P in the main program is a jump, M99 alone its end") {
  CHECK(macro_xs("#1=0\nN5 #1=#1+1\nG0 X#1\nIF [#1 EQ 3] GOTO 9\nM99 P5\nN9 M30\n") == Points{1, 2, 3});
  const Outcome outcome = run("G0 X1\nM99\n", of_fanuc());
  CHECK(outcome.codes() == std::vector<Code>{Code::main_again});
}

TEST_CASE("M97 calls lines of the same program on a haas, and is unknown to a fanuc") {
  const std::string text = "G0 X1\nM97 P100 L2\nX3\nM30\nN100 X2\nM99\n";
  CHECK(macro_xs(text, of_haas()) == Points{1, 2, 2, 3});
  CHECK(only_code(text, of_fanuc()) == Code::unknown_code);
  CHECK(macro_error("M97 P7\nM30\n", of_haas()) == MacroError{Code::sequence_number_missing, 1});
  CHECK(macro_error("M97\nM30\n", of_haas()) == MacroError{Code::word_missing, 1});
}

TEST_CASE("a subprogram ends with M99 before the next one begins") {
  CHECK(macro_error("O1\nM98 P2\nM30\nO2\nG0 X1\nO3\nM99\n") == MacroError{Code::sub_without_end, 6});
  // a main program ends there
  CHECK(macro_xs("O1\nG0 X1\nO2\nX2\nM99\n") == Points{1});
}

TEST_CASE("a subprogram is looked for beside the program under the names that controllers give") {
  const auto folder = std::filesystem::temp_directory_path() / ("kadr_macro_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* name, const char* text) { std::ofstream(folder / name) << text; };
  write("O1001.nc", "%\nO1001 (DRILL)\nG0 X#1\nM99\n%\n");
  write("0002.NC", "O0002\nG0 X22\nM99\n");
  write("o00003.txt", "O3\nG0 X33\nM99\n");
  write("4.ngc", "O4\nG0 X44\nM99 P9\n");
  const std::string program = (folder / "part.nc").string();
  const auto xs_of = [&](const std::string& text, const InterpretOptions& options) {
    Points xs;
    const Outcome outcome = run(text, options, program);
    CAPTURE(outcome.rendered);
    CHECK_FALSE(outcome.diagnostics.has_errors());
    for (const LineOrArc& move : outcome.moves()) xs.push_back(move.end[0]);
    return xs;
  };
  CHECK(xs_of("G65 P1001 A11\nM98 P2\nM98 P3\nM98 P4\nG0 X1\nN9 X2\nM30\n", of_fanuc()) ==
        Points{11, 22, 33, 44, 2});
  const Outcome missing = run("M98 P77\nM30\n", of_fanuc(), program);
  REQUIRE(missing.codes() == std::vector<Code>{Code::sub_not_found});
  CHECK(missing.rendered.find("O0077.nc") != std::string::npos);
  // LinuxCNC knows one name only
  CHECK(run("M98 P1001\nM2\n", {}, program).codes() == std::vector<Code>{Code::sub_not_found});
  std::filesystem::remove_all(folder);
}
