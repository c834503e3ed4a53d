#include <doctest/doctest.h>

#include "gcode/read/program.h"
#include "macro_support.h"

/// Programs of macro B in normal form, and printed back from their tree.
using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

std::string macro_form(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  std::string out;
  format_program(sources, sources.add(SourceText("part.nc", text)), diagnostics, out, {}, Dialect::haas);
  return out;
}

std::string macro_printed_back(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  Report report(diagnostics);
  Names names;
  const std::uint32_t file = sources.add(SourceText("part.nc", text));
  Program program(sources, file, {}, names, report, Dialect::haas);
  std::string out;
  while (const Line* line = program.next()) append_source(out, *line);
  return out;
}

std::string macro_line(Random& random) {
  static const char* const kPieces[] = {
      "IF",    "[#1 EQ #0]", "GOTO", " 20",         "#5",        "THEN",     "WHILE",    "DO",
      "END",   "1",          "3",    "N10",         " ",         "#1=",      "#[#2+1]=", "+",
      "-",     "*",          "MOD",  "AND",         "/",         "X",        "X-#1",     "[",
      "]",     "(c)",        ";c",   "ATAN[1]/[2]", "ATAN[1,2]", "POW[2,3]", "FIX[#3]",  "G65",
      "P9010", "A1.",        "I2",   "J3",          "O12",       "%"};
  std::string line;
  for (std::uint64_t i = random.below(9); i > 0; --i) {
    line += kPieces[random.below(std::size(kPieces))];
    if (random.chance(0.2)) line += ' ';
  }
  return line;
}

}  // namespace

TEST_CASE("the normal form of macro B") {
  CHECK(macro_form(
            "if[#1eq#0]goto 0020\nn20while[#1lt5]do1\n#1=#1+1\nx#1 g1 (c)\nend 1\nGOTO#5\ngoto[#1+10]\n") ==
        "IF [#1 EQ #0] GOTO 20\nN20 WHILE [#1 LT 5] DO1\n  #1=#1 + 1\n  G1 X#1 (c)\nEND1\nGOTO #5\nGOTO [#1 "
        "+ 10]\n");
  CHECK(macro_form("IF[#1 EQ 1]THEN#2=atan[1,2]\nIF[1 EQ 1]THENX5 G0\n") ==
        "IF [#1 EQ 1] THEN #2=ATAN[1,2]\nIF [1 EQ 1] THEN X5 G0\n");
  // the order of arguments tells the sets of I J K
  CHECK(macro_form("g65 p10 k1 i2 a3 (c) j4\n") == "G65 P10 K1 I2 A3 J4 (c)\n");
  CHECK(macro_form("#3000 = 1 (text)\n") == "#3000=1 (text)\n");
}

TEST_CASE("lines of macro B print back byte for byte, and their form is final") {
  Random random(seed());
  for (std::uint64_t i = 0; i < count(3000); ++i) {
    std::string text;
    for (std::uint64_t k = random.below(5); k > 0; --k)
      text += macro_line(random) + (random.chance(0.2) ? "\r\n" : "\n");
    CAPTURE(text);
    REQUIRE(macro_printed_back(text) == text);
    const std::string once = macro_form(text);
    CAPTURE(once);
    REQUIRE(macro_form(once) == once);
  }
}
