#include <doctest/doctest.h>

#include <cmath>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

TEST_CASE("zeros have the signs that rs274 gives them") {
  CHECK(evaluated("[ATAN[ROUND[-0.4]]/[-1]]") == 180);
  CHECK(evaluated("[ATAN[ABS[-0]]/[-1]]") == -180);
  CHECK(evaluated("[ATAN[-5 MOD 5]/[-1]]") == -180);
  CHECK(evaluated("[ATAN[5 MOD 5]/[-1]]") == 180);
  CHECK(evaluated("[ATAN[SIN[-0]]/[-1]]") == -180);
}

TEST_CASE("operators run from left to right: 2**3**2 = 64, and a sign belongs to its number: -2**2 = 4") {
  CHECK(evaluated("[2**3**2]") == 64);
  CHECK(evaluated("[-2**2]") == 4);
  CHECK(evaluated("[10-3-2]") == 5);
  CHECK(evaluated("[24/4/2]") == 3);
}

TEST_CASE("power binds before product, product before sum, sum before comparison, comparison before logic") {
  CHECK(evaluated("[1+2*3**2]") == 19);
  CHECK(evaluated("[1+1 EQ 2]") == 1);
  CHECK(evaluated("[2 LT 1 OR 3 GT 2]") == 1);
  CHECK(evaluated("[1 AND 0 OR 1]") == 1);
  CHECK(evaluated("[[1+2]*[3-1]]") == 6);
}

TEST_CASE("MOD is never negative: -7 MOD 4 = 1, 7 MOD -4 = 3") {
  CHECK(evaluated("[-7 MOD 4]") == 1);
  CHECK(evaluated("[7 MOD -4]") == 3);
  CHECK(evaluated("[-7 MOD -4]") == 1);
  CHECK(evaluated("[-8 MOD 4]") == 0);
  CHECK(evaluated("[1.5 MOD 0.4]") == doctest::Approx(0.3).epsilon(1e-14));
  CHECK(evaluated("[1e]") == -777);
  // the remainder is exact, as that of std::fmod
  CHECK(evaluated("[1000000.1 MOD 0.7]") == std::fmod(1000000.1, 0.7));
}

TEST_CASE("EQ holds within 1e-4, the other comparisons are exact") {
  CHECK(evaluated("[1 EQ 1.00005]") == 1);
  CHECK(evaluated("[1 EQ 1.00011]") == 0);
  CHECK(evaluated("[1 NE 1.00005]") == 0);
  CHECK(evaluated("[1 LT 1.00005]") == 1);
  CHECK(evaluated("[1 GE 1.00005]") == 0);
  CHECK(evaluated("[1 LE 1]") == 1);
  CHECK(evaluated("[1 GT 1]") == 0);
}

TEST_CASE("logic takes every value but 0 as true") {
  CHECK(evaluated("[0.5 AND -0.5]") == 1);
  CHECK(evaluated("[0 XOR 2]") == 1);
  CHECK(evaluated("[3 XOR 2]") == 0);
  CHECK(evaluated("[0 OR 0]") == 0);
}

TEST_CASE("ROUND goes away from zero, FIX down, FUP up") {
  CHECK(evaluated(" ROUND[-2.5]") == -3);
  CHECK(evaluated(" ROUND[2.5]") == 3);
  CHECK(evaluated(" FIX[-2.5]") == -3);
  CHECK(evaluated(" FIX[2.8]") == 2);
  CHECK(evaluated(" FUP[2.1]") == 3);
  CHECK(evaluated(" FUP[-2.8]") == -2);
  CHECK(evaluated(" ABS[-4]") == 4);
}

TEST_CASE("trigonometry is in degrees and exact at quarter turns") {
  CHECK(evaluated(" SIN[30]") == doctest::Approx(0.5).epsilon(1e-15));
  CHECK(evaluated(" SIN[180]") == 0);
  CHECK(evaluated(" COS[-90]") == 0);
  CHECK(evaluated(" COS[3600]") == 1);
  CHECK(evaluated(" TAN[45]") == doctest::Approx(1).epsilon(1e-15));
  CHECK(evaluated(" ASIN[1]") == doctest::Approx(90).epsilon(1e-15));
  CHECK(evaluated(" ACOS[0.5]") == doctest::Approx(60).epsilon(1e-15));
  CHECK(evaluated(" ATAN[1]/[-1]") == doctest::Approx(135).epsilon(1e-15));
  CHECK(evaluated(" ATAN[0]/[-2]") == 180);
  CHECK(evaluated(" ATAN[-3]/[0]") == -90);
  for (double angle = -720; angle <= 720; angle += 17.5) {
    const std::string text = "[" + std::to_string(angle) + "]";
    CHECK(evaluated(" SIN" + text) ==
          doctest::Approx(std::sin(angle * std::acos(-1.0) / 180)).epsilon(1e-13));
  }
}

TEST_CASE("roots, powers, exponentials and logarithms") {
  CHECK(evaluated(" SQRT[2]") == std::sqrt(2.0));
  CHECK(evaluated(" EXP[1]") == doctest::Approx(2.718281828459045).epsilon(1e-15));
  CHECK(evaluated(" LN[EXP[2]]") == doctest::Approx(2).epsilon(1e-15));
  CHECK(evaluated("[2**0.5]") == doctest::Approx(std::sqrt(2.0)).epsilon(1e-14));
  CHECK(evaluated("[-2**3]") == -8);
  CHECK(evaluated("[2**-2]") == 0.25);
  CHECK(evaluated("[0**0]") == 1);
}

TEST_CASE("signs, parameters and functions nest") {
  CHECK(evaluated("--5") == 5);
  CHECK(evaluated("-[5]") == -5);
  CHECK(evaluated("-+5") == -5);
  CHECK(evaluated("[1 + -2 * 3]") == -5);
  CHECK(last_point("#1=2 #2=9\nG0 X##1 Y#[#1] Z#SQRT[4] A-#1\n") == AxisValues{9, 9, 9, -2});
}

TEST_CASE("a long chain of operators needs no stack") {
  std::string sum = "[0";
  for (int i = 0; i < 50000; ++i) sum += "+1";
  CHECK(evaluated(sum + "]") == 50000);
}

TEST_CASE("what has no value is refused with its own code") {
  CHECK(only_code("G0 X[1/0]\n") == Code::division_by_zero);
  CHECK(only_code("G0 X[5 MOD 0]\n") == Code::division_by_zero);
  for (const std::string text : {"SQRT[-1]", "LN[0]", "ACOS[1.0000001]", "ASIN[-2]", "EXP[1000]",
                                 "[-8**[1/3]]", "[0**-1]", "TAN[90]", "[10**1000.5]"}) {
    CAPTURE(text);
    CHECK(only_code("G0 X " + text + "\n") == Code::function_domain);
  }
  CHECK(only_code("G0 X[10**300*10**300]\n") == Code::value_too_large);
  CHECK(only_code("G0 X[" + std::string(400, '9') + "]\n") == Code::value_too_large);
  CHECK(only_code("G0 X1000000001\n") == Code::value_too_large);
  CHECK(only_code("G0 X" + std::string(101, '[') + "1" + std::string(101, ']') + "\n") ==
        Code::expression_too_deep);
}

TEST_CASE("settings of a line take effect after the line, the last one of a parameter wins") {
  const Outcome outcome = run("#1=5 #1=6 G0 X#1\nX#1\n#2=#1\n#[1+1]=3 Y[#2]\nY#2\n");
  REQUIRE(outcome.moves().size() == 4);
  CHECK(outcome.moves()[0].end[0] == 0);
  CHECK(outcome.moves()[1].end[0] == 6);
  CHECK(outcome.moves()[2].end[1] == 6);
  CHECK(outcome.moves()[3].end[1] == 3);
}

TEST_CASE("predefined parameters tell position, work system, offsets, reference points and tool") {
  CHECK(last_point("G0 X5 Y2\nG92 X1\nX#5420 Y[#5421*2]\nZ#5420\n") == AxisValues{5, 4, 1});
  CHECK(last_point("G55\nG0 X#5220\n")[0] == 2);
  CHECK(last_point("G10 L2 P2 X7\nG0 Y#5241\n")[1] == 7);
  CHECK(last_point("G0 X5\nG28.1\nX6\nX#5161\n")[0] == 5);
  CHECK(last_point("T4 M6\nG0 X#5400\n")[0] == 4);
  // of the tool in the spindle, not of the length in force
  CHECK(last_point("G43.1 Z5\nG0 X#5403\n")[0] == 0);
  CHECK(only_code("#5421=1\n") == Code::parameter_read_only);
  CHECK(only_code("#5220=2\n") == Code::parameter_read_only);
  CHECK(only_code("#5602=1\n") == Code::parameter_range);
  CHECK(only_code("#0=1\n") == Code::parameter_range);
  CHECK(only_code("G0 X#1.1\n") == Code::parameter_range);
}
