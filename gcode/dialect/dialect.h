#pragma once
#include <cstdint>
#include <span>

#include "machine/base/vocabulary.h"

namespace kadr::gcode {

/// Which controller's reading of codes that differ.
enum class Dialect : std::uint8_t { linuxcnc, grbl, marlin, fanuc };

inline constexpr Vocabulary<Dialect, 4> kDialects{{
    {Dialect::linuxcnc, "linuxcnc", "LinuxCNC 2.9; the codes of docs/gcode.md"},
    {Dialect::grbl, "grbl", "Grbl 1.1; reads all of its codes as LinuxCNC does"},
    {Dialect::marlin, "marlin", "Marlin: P of G4 in milliseconds, G5 as a cubic spline"},
    {Dialect::fanuc, "fanuc", "FANUC: P of G4 in milliseconds, G70 and G71 as G20 and G21, M98 with repeats"},
}};
static_assert(kDialects.complete());

// what differs, and nothing else; Marlin's G5 stands with the other splines

/// A word of G4 and the seconds that 1 of it means.
struct DwellWord {
  char letter;
  double unit_s;
};
/// Of several words on a line the first of these holds.
std::span<const DwellWord> dwell_words(Dialect dialect);

/// What a code of the dialect means in RS-274/NGC: G70 and G71 of fanuc are G20 and G21.
/// @param letter  G or M
/// @param number  of G ten times the number
int meant_code(Dialect dialect, char letter, int number);

/// What P of M98 calls.
struct SubprogramCall {
  std::int64_t number = 0;
  std::uint64_t repeats = 1;
};
/// fanuc: the last four digits of P are the program, those before them the repeats: P30004 runs O4 three
/// times.
SubprogramCall subprogram_call(Dialect dialect, std::int64_t p);

}  // namespace kadr::gcode
