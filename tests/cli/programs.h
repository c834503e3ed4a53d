#pragma once
#include <string>

/// Control programs that the tests of the command line share.
namespace kadr::test {

/// A square of 20 mm at F600 with a dwell; stays within mill3.
inline const std::string kSquare =
    "(square)\n"
    "G21 G90 G94 G17\n"
    "G0 X10 Y10\n"
    "G1 X30 F600\n"
    "Y30\n"
    "G4 P0.5\n"
    "X10\n"
    "G1 Y10\n"
    "M2\n";

/// Six lines with one mistake each, good lines between them.
inline const std::string kSixMistakes =
    "G21 G90\n"
    "G1 X10 F600\n"
    "G2 X20 Y0 I3 J0\n"
    "G1 X2O F600\n"
    "G1 X30 Y$\n"
    "G17 G18 X1\n"
    "G1 X[1+ F100\n"
    "G999 X1\n"
    "M2\n";

/// `lines` moves back and forth of 100 mm at 100 mm/s: about 1.05 s each.
inline std::string back_and_forth(int lines) {
  std::string text = "G21 G90 G94\n";
  for (int i = 0; i < lines; ++i) text += i % 2 == 0 ? "G1 X100 F6000\n" : "G1 X0\n";
  return text + "M2\n";
}

}  // namespace kadr::test
