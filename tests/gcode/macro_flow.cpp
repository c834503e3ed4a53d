#include <doctest/doctest.h>

#include "macro_support.h"

/// IF, GOTO, WHILE, DO and END of macro B.
using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

using Xs = std::vector<double>;

TEST_CASE("IF .. GOTO and GOTO back make a loop") {
  CHECK(macro_xs(
            "%\nO0001\nG21 G90\n#1=3\nN10\nIF [#1 EQ 0] GOTO 20\nG0 X#1\n#1=#1-1\nGOTO 10\nN20\nM30\n%\n") ==
        Xs{3, 2, 1});
}

TEST_CASE("GOTO takes a number, a variable or an expression, forwards and back") {
  CHECK(macro_xs("GOTO 20\nN10 G0 X1\nM30\nN20 G0 X2\nGOTO 10\n") == Xs{2, 1});
  CHECK(macro_xs("#1=20\nGOTO #1\nN10 G0 X1\nM30\nN20 G0 X2\nGOTO [#1-10]\n") == Xs{2, 1});
  CHECK(macro_xs("#1=20\nIF[1 EQ 1]GOTO#1\nN10 G0 X1\nN0020 G0 X2\n") == Xs{2});
  CHECK(macro_xs("if [ 1 eq 1 ] g o t o 2 0\ng0 x1\nn20 g0 x2\n") == Xs{2});
}

TEST_CASE("GOTO leads behind M30, where alarms stand") {
  CHECK(macro_error("IF [#1 EQ #0] GOTO 990\nG0 X1\nM30\nN990 #3000=1 (NO VALUE)\n") ==
        MacroError{Code::program_aborts, 4});
}

TEST_CASE("IF .. THEN runs the rest of its line") {
  CHECK(macro_xs("IF [#1 EQ #0] THEN #1=7\nIF [#1 NE 7] THEN #1=8\nG0 X#1\n") == Xs{7});
  CHECK(macro_xs("IF [1 EQ 1] THEN G0 X4\nIF [1 EQ 2] THEN G0 X5\n", of_haas()) == Xs{4});
  CHECK(macro_error("IF [#1 EQ #0] THEN #3000=1 (A)\n") == MacroError{Code::program_aborts, 1});
  CHECK(macro_error("IF [1 EQ 1] THEN G0 X4\n", of_fanuc()) == MacroError{Code::macro_statement, 1});
}

TEST_CASE("WHILE runs while its condition holds, also not at all") {
  CHECK(macro_xs("#1=1\nWHILE [#1 LE 3] DO1\nG0 X#1\n#1=#1+1\nEND1\nX9\n") == Xs{1, 2, 3, 9});
  CHECK(macro_xs("WHILE [1 EQ 2] DO2\nG0 X1\nEND2\nG0 X9\n") == Xs{9});
}

TEST_CASE("loops nest with different numbers, and a number may be used again") {
  CHECK(macro_xs(
            "#1=0\nWHILE[#1 LT 2]DO1\n#2=0\nWHILE[#2 LT 2]DO2\nG0 X[10*#1+#2]\n#2=#2+1\nEND2\n#1=#1+1\nEND1\n"
            "DO1\nGOTO 5\nEND1\nN5 X99\n") == Xs{0, 1, 10, 11, 99});
  CHECK(macro_error("DO1\nDO1\nEND1\nEND1\n") == MacroError{Code::macro_loop, 2});
  CHECK(macro_error("DO1\nDO2\nEND1\n") == MacroError{Code::macro_loop, 3});
  CHECK(macro_error("WHILE [1 EQ 1] DO3\nM30\n") == MacroError{Code::macro_loop, 1});
  CHECK(macro_error("G0 X1\nEND2\n") == MacroError{Code::macro_loop, 2});
}

TEST_CASE("GOTO leads out of a loop and round in it, not into it") {
  CHECK(macro_xs("#1=0\nDO1\n#1=#1+1\nIF [#1 GT 3] GOTO 8\nIF [#1 EQ 2] GOTO 7\nG0 X#1\nN7 END1\nN8 X50\n") ==
        Xs{1, 3, 50});
  CHECK(macro_error("GOTO 7\nDO1\nN7 G0 X1\nEND1\n") == MacroError{Code::jump_into_loop, 1});
  CHECK(macro_error("#1=7\nGOTO #1\nDO1\nN7 G0 X1\nEND1\n") == MacroError{Code::jump_into_loop, 2});
}

TEST_CASE("a sequence number that GOTO names stands once in its program") {
  CHECK(macro_error("GOTO 5\nN6 G0 X1\n") == MacroError{Code::sequence_number_missing, 1});
  CHECK(macro_error("#1=5.5\nGOTO #1\nN5 G0 X1\n") == MacroError{Code::sequence_number_missing, 2});
  CHECK(macro_error("GOTO #1\nN5 G0 X1\n") == MacroError{Code::sequence_number_missing, 1});
  CHECK(macro_error("N5 G0 X1\nGOTO 5\nN5 G0 X2\n") == MacroError{Code::sequence_number_twice, 2});
  // one that nothing names may repeat, and each program of the file has its own
  CHECK(macro_xs("O1\nN1 G0 X1\nN1 X2\nGOTO 5\nX3\nN5 M98 P2\nM30\nO2\nGOTO 5\nX4\nN5 X5\nM99\n") ==
        Xs{1, 2, 5});
}

TEST_CASE("what does not end ends at a bound") {
  InterpretOptions options = of_fanuc();
  options.bounds.loop_passes = 100;
  CHECK(macro_error("N1\nGOTO 1\n", options) == MacroError{Code::loop_too_long, 2});
  CHECK(macro_error("DO1\nEND1\n", options) == MacroError{Code::loop_too_long, 1});
  CHECK(macro_error("N1 G0 X1\nM99 P1\n", options) == MacroError{Code::loop_too_long, 2});
  options.bounds.lines = 50;
  CHECK(macro_error("DO1\nEND1\n", options) == MacroError{Code::too_many_lines, 1});
  options.bounds.call_depth = 9;
  CHECK(macro_error("O1\nG65 P1\n", options) == MacroError{Code::calls_too_deep, 2});
}

TEST_CASE("after an error a loop is run through once, and its follow-ups are not told") {
  CHECK(macro_error("G0 X1 X2\nN1 G0 Y1\n#1=#1+1\nIF [#1 LT 3] GOTO 1\nWHILE [1 EQ 1] DO1\nEND1\n") ==
        MacroError{Code::word_repeated, 1});
  CHECK(macro_error("#1=1/0\nIF [#1 EQ 5] GOTO 9\nG0 X#1\nN9 M30\n") ==
        MacroError{Code::division_by_zero, 1});
}

TEST_CASE("statements of macro B that can't be read") {
  for (const char* text :
       {"IF #1 EQ 0 GOTO 5\nN5\n", "IF [#1 EQ 0]\n", "IF [#1 EQ 0] THEN\n", "WHILE [#1 EQ 0]\n", "DO4\n",
        "END\n", "DO12\n", "GOTO\n", "GOTO 1.5\n", "G0 X1 GOTO 5\nN5\n"}) {
    CAPTURE(text);
    CHECK(macro_error(text) == MacroError{Code::macro_statement, 1});
  }
  CHECK(macro_error("IF [#1 EQ 0] GOTO 5 X1\nN5\n") == MacroError{Code::text_after_o_word, 1});
  CHECK(macro_error("ELSE\n") == MacroError{Code::word_not_run, 1});
  CHECK(macro_error("DPRNT[X#1[53]]\n") == MacroError{Code::word_not_run, 1});
}

TEST_CASE("O words run beside macro B, where a vacant condition does not hold") {
  CHECK(macro_xs("o1 if [#1]\nG0 X1\no1 else\nG0 X2\no1 endif\no2 repeat [#1]\nX3\no2 endrepeat\n") == Xs{2});
  CHECK(macro_xs("IF [#1] GOTO 5\nG0 X1\nN5 M30\n") == Xs{1});
}

TEST_CASE("a macro under linuxcnc is told once, with the dialect that runs it") {
  const Outcome outcome = run("#1=3\nN10 IF [#1 EQ 0] GOTO 20\nG0 X#1\n#1=#1-1\nGOTO 10\nN20 M30\n");
  REQUIRE(outcome.codes() == std::vector<Code>{Code::kind_other});
  CHECK(outcome.rendered.find("--dialect fanuc") != std::string::npos);
}

TEST_CASE("a program without jumps is not bounded by the number of its lines") {
  InterpretOptions options = of_fanuc();
  options.bounds.lines = 5;
  std::string text = "O1 (GOTO)\n";
  for (int i = 1; i <= 10; ++i) text += "N" + std::to_string(i) + " G0 X" + std::to_string(i) + " M8\n";
  CHECK(macro_xs(text + "M30\n", options).size() == 10);
  CHECK(macro_error(text + "GOTO 11\nN11 M30\n", options).code == Code::too_many_lines);
}
