#pragma once
#include <cstdint>
#include <string_view>

#include "gcode/dialect/codes.h"
#include "gcode/dialect/dialect.h"

namespace kadr::gcode {

/// What a dialect makes of a code that LinuxCNC reads otherwise or not at all.
enum class CodeReading : std::uint8_t {
  runs,          ///< as the code `meant`
  ends_nothing,  ///< ends something that kadr never begins: has no effect, as on the machine
  told,          ///< accepted without effect, told once for a program
  refused,
};

/// A code of a dialect; G codes in tenths.
struct DialectCode {
  char letter = 0;
  int first = 0;
  int last = 0;  ///< of a range
  CodeReading reading = CodeReading::refused;
  int meant = 0;  ///< runs
  std::string_view letters =
      {};  ///< words of the line that belong to the code and have no effect; "*": all of them
  std::string_view what = {};           ///< told and refused: what the code does on the machine
  std::string_view lathe_letters = {};  ///< beside one of these words it is a code of lathes, and refused
  int given_p = 0;                      ///< the line has this P, as if written
};

/// The row of a code; null: as LinuxCNC reads it.
/// @param letter  G or M
/// @param number  of G ten times the number
const DialectCode* dialect_code(Dialect dialect, char letter, int number);

/// Whether the dialect has a code of LinuxCNC: grbl runs a part of them.
bool has_code(Dialect dialect, char letter, int number);

/// A code that runs where a dialect means it: G31 and G54.1.
GCode code_of_dialects(int tenths);

}  // namespace kadr::gcode
