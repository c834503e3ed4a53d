#pragma once
#include <cstdint>
#include <iterator>
#include <string>

#include "support.h"

namespace kadr::gcode::test {

/// A line of tokens that mostly make sense, in all spellings of blanks and case.
inline std::string random_line(Random& random) {
  static const char* const kTokens[] = {"G1",
                                        "g 0 1",
                                        "X",
                                        "Y-1.25",
                                        "z + .5",
                                        "F1 2 0",
                                        "#1=2",
                                        "#[1+1]=3.5",
                                        "X#1",
                                        "Y##2",
                                        "[",
                                        "]",
                                        "X[1+2*3]",
                                        "I[-#1**2]",
                                        "SIN[30]",
                                        "X-SIN[#1 - 2]",
                                        "Y ATAN[1]/[2]",
                                        "(text)",
                                        "( MSG, a )",
                                        ";rest ",
                                        "%",
                                        "/",
                                        "N10",
                                        "M3",
                                        "O100 sub",
                                        "O<a b> call [1] [#2]",
                                        "o 5 w h i l e [#<c> lt 2]",
                                        "O[#1+2] call",
                                        "O7 endif",
                                        "X#<name>",
                                        "Y[EXISTS[#<n>]]",
                                        "Z[exists [ #5 ] ]",
                                        "@5 ^30",
                                        "#<name>=1",
                                        "1.2.3",
                                        "F1,5",
                                        "\t",
                                        "  ",
                                        "X[2 m o d 3]",
                                        "\xD0\xA5",
                                        "\xFF",
                                        "(\xCF\xF0)",
                                        "e5",
                                        "="};
  std::string line;
  const std::uint64_t tokens = random.below(8);
  for (std::uint64_t i = 0; i < tokens; ++i) {
    line += kTokens[random.below(std::size(kTokens))];
    if (random.chance(0.5)) line += ' ';
  }
  return line;
}

}  // namespace kadr::gcode::test
