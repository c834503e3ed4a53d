#include <doctest/doctest.h>

#include "macro_support.h"

/// Expressions of macro B. Values by hand, from the rules of FANUC's and Haas's manuals.
using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

TEST_CASE("the right side of a setting of macro B needs no brackets, and may have them") {
  CHECK(macro_value("3-1") == 2);
  CHECK(macro_value("[3-1]") == 2);
  CHECK(macro_value("2+3*4") == 14);
  CHECK(macro_value("[2+3]*4") == 20);
  CHECK(macro_value("10-4-3") == 3);
  CHECK(macro_value("12/3/2") == 2);
  CHECK(macro_value("-3+5") == 2);
  CHECK(macro_value("2*-3") == -6);
  CHECK(macro_value("1+2 (remark)") == 3);
  CHECK(macro_xs("#1=2\n#2=#1+3*SIN[30]\nG0 X#2\n") == std::vector<double>{3.5});
}

TEST_CASE("AND multiplies, OR and XOR add, on bits, and comparisons come last") {
  CHECK(macro_value("12 AND 10") == 8);
  CHECK(macro_value("12 OR 10") == 14);
  CHECK(macro_value("12 XOR 10") == 6);
  // 1 + (3 AND 2) = 3, as 3 AND 2 is a product
  CHECK(macro_value("1+3 AND 2") == 3);
  // (1 + 2) OR 4: OR is a sum, from left to right
  CHECK(macro_value("1+2 OR 4") == 7);
  CHECK(macro_xs("IF [1+1 EQ 2] GOTO 5\nG0 X1\nN5 G0 X2\n") == std::vector<double>{2});
  CHECK(macro_xs("IF [[1 EQ 1] AND [2 EQ 3]] GOTO 5\nG0 X1\nN5 G0 X2\n") == std::vector<double>{1, 2});
  CHECK(only_code("#1=3000000000. AND 1\n", of_fanuc()) == Code::function_domain);
}

TEST_CASE("MOD takes whole numbers and has the sign of the dividend") {
  CHECK(macro_value("7 MOD 3") == 1);
  CHECK(macro_value("-7 MOD 3") == -1);
  CHECK(macro_value("7.6 MOD 3.2") == 2);  // 8 MOD 3
  CHECK(only_code("#1=1 MOD 0\n", of_fanuc()) == Code::division_by_zero);
}

TEST_CASE("FIX goes towards zero and FUP away from it, ROUND to the nearest") {
  CHECK(macro_value("FIX[1.2]") == 1);
  CHECK(macro_value("FIX[-1.2]") == -1);
  CHECK(macro_value("FUP[1.2]") == 2);
  CHECK(macro_value("FUP[-1.2]") == -2);
  CHECK(macro_value("ROUND[1.5]") == 2);
  CHECK(macro_value("ROUND[-1.5]") == -2);
}

TEST_CASE("ROUND in a word goes to the least increment of its letter") {
  CHECK(macro_xs("G21 G0 X[ROUND[1.23456]]\n") == std::vector<double>{1.235});
  CHECK(macro_xs("G21 #1=ROUND[1.23456]\nG0 X#1\n") == std::vector<double>{1});
  CHECK(macro_xs("G20 G0 X[ROUND[1.23456]]\n")[0] == doctest::Approx(1.2346 * 25.4).epsilon(1e-12));
  CHECK(macro_xs("G21\nIF [ROUND[1.4] EQ 1] GOTO 5\nG0 X1\nN5 G0 X-ROUND[2.0006]\n") ==
        std::vector<double>{-2.001});
}

TEST_CASE("functions of macro B") {
  const auto near = [](double value) { return doctest::Approx(value).epsilon(1e-12); };
  CHECK(macro_value("SIN[30]") == near(0.5));
  CHECK(macro_value("COS[60]") == near(0.5));
  CHECK(macro_value("TAN[45]") == near(1));
  CHECK(macro_value("ACOS[0.5]") == near(60));
  CHECK(macro_value("SQRT[9]") == 3);
  CHECK(macro_value("SQR[9]") == 3);
  CHECK(macro_value("ABS[-4]") == 4);
  CHECK(macro_value("LN[EXP[2]]") == near(2));
  CHECK(macro_value("POW[2,10]") == 1024);
  CHECK(macro_value("POW[#0+2,[1+2]]") == 8);
  CHECK(only_code("#1=BIN[5]\n", of_fanuc()) == Code::word_not_run);
  CHECK(only_code("#1=POW[5]\n", of_fanuc()) == Code::argument_missing);
  CHECK(only_code("#1=EXISTS[#5]\n", of_fanuc()) == Code::unknown_name);
  CHECK(only_code("#1=2**3\n", of_fanuc()) == Code::number_missing);
  CHECK(only_code("#<a>=3\n", of_fanuc()) == Code::name_bad);
}

TEST_CASE("ATAN of two values goes round to 360 degrees on a fanuc and to 180 on a haas") {
  const auto near = [](double value) { return doctest::Approx(value).epsilon(1e-12); };
  for (const char* text : {"ATAN[-1]/[-1]", "ATAN[-1,-1]"}) {
    CHECK(macro_value(text, of_fanuc()) == near(225));
    CHECK(macro_value(text, of_haas()) == near(-135));
  }
  CHECK(macro_value("ATAN[0]/[-1]") == 180);
  CHECK(macro_value("ATAN[1]/[-1]") == near(135));
  CHECK(macro_value("ATAN[-1]") == near(-45));
  CHECK(macro_value("ATAN[1]/2") == near(22.5));
  CHECK(macro_value("ASIN[-0.5]", of_fanuc()) == near(330));
  CHECK(macro_value("ASIN[-0.5]", of_haas()) == near(-30));
}

TEST_CASE("a word with a vacant value does not stand there") {
  CHECK(last_point("G0 X1 Y2\nG0 X5 Y#1\n", of_fanuc()) == AxisValues{5, 2});
  CHECK(last_point("G0 X1 Y2\nG0 X5 Y-#1\n", of_fanuc()) == AxisValues{5, 2});
  CHECK(last_point("G0 X1 Y2\n#1=0\nG0 X5 Y#1\n", of_fanuc()) == AxisValues{5, 0});
  // an expression calculates: vacant counts as 0
  CHECK(last_point("G0 X1 Y2\nG0 X5 Y[#1+3]\n", of_fanuc()) == AxisValues{5, 3});
  CHECK(macro_xs("G0 X1\nX#1\n") == std::vector<double>{1});
}

TEST_CASE("a vacant variable is passed on by a setting, and counts as 0 where something is calculated") {
  const std::string told = "IF [#2 EQ #0] GOTO 5\nG0 X1\nGOTO 6\nN5 G0 X2\nN6 M30\n";
  CHECK(macro_xs("#2=#1\n" + told) == std::vector<double>{2});
  CHECK(macro_xs("#2=#1*3\n" + told) == std::vector<double>{1});
  CHECK(macro_xs("#2=#1+#1\n" + told) == std::vector<double>{1});
  CHECK(macro_xs("#2=5\n#2=#0\n" + told) == std::vector<double>{2});
}

TEST_CASE("EQ and NE tell vacant from 0, the other comparisons do not") {
  const auto holds = [](const std::string& condition, const std::string& before = "") {
    return macro_xs(before + "IF [" + condition + "] GOTO 5\nG0 X1\nN5 G0 X2\n").size() == 1;
  };
  CHECK(holds("#1 EQ #0"));
  CHECK_FALSE(holds("#1 EQ 0"));
  CHECK(holds("#1 NE 0"));
  CHECK(holds("#1 GE #0"));
  CHECK(holds("#1 LE 0"));
  CHECK_FALSE(holds("#1 GT 0"));
  CHECK_FALSE(holds("#1 LT 0"));
  CHECK_FALSE(holds("#1 EQ #0", "#1=0\n"));
  CHECK(holds("#1 EQ 0", "#1=0\n"));
  CHECK_FALSE(holds("#1 NE 0", "#1=0\n"));
  CHECK(holds("#1 GE #0", "#1=0\n"));
  // no tolerance: 0.00001 is not 0
  CHECK_FALSE(holds("#1 EQ 0", "#1=0.00001\n"));
}

TEST_CASE("variables are chosen by expressions, and stand behind any letter") {
  CHECK(macro_xs("#1=4\n#[#1+2]=9\nG0 X#6\n") == std::vector<double>{9});
  CHECK(macro_xs("#1=4\n#5=7\nG0 X#[#1+1]\n") == std::vector<double>{7});
  CHECK(macro_xs("#1=4\nG0 X[#1+5.]\nX#1\nX-#1\nX-[#1*2]\n") == std::vector<double>{9, 4, -4, -8});
  CHECK(macro_xs("#1=1\n#2=20\nG#1 F#2 X5\n") == std::vector<double>{5});
  CHECK(run("#3=3\nM#3 S100\nG0 X1\n", of_fanuc()).all<SpindleClockwise>().size() == 1);
}

TEST_CASE("settings of one line act one after the other, before a word of the next line") {
  CHECK(macro_xs("#1=1 #2=#1+1\nG0 X#2\n") == std::vector<double>{2});
}
