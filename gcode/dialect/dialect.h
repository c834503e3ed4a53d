#pragma once
#include <cstdint>
#include <span>

#include "machine/base/vocabulary.h"

namespace kadr::gcode {

/// The controller whose reading applies where controllers differ.
enum class Dialect : std::uint8_t { linuxcnc, grbl, marlin, fanuc };

inline constexpr Vocabulary<Dialect, 4> kDialects{{
    {Dialect::linuxcnc, "linuxcnc", "LinuxCNC 2.9; the codes of docs/gcode.md"},
    {Dialect::grbl, "grbl", "Grbl 1.1; reads all of its codes as LinuxCNC does"},
    {Dialect::marlin, "marlin", "Marlin: P of G4 in milliseconds, G5 as a cubic spline"},
    {Dialect::fanuc, "fanuc", "FANUC: P of G4 in milliseconds, G70 and G71 as G20 and G21, M98 with repeats"},
}};
static_assert(kDialects.complete());

// only the differences; Marlin's G5 is with the other splines

/// A word of G4 and the seconds that 1 of it means.
struct DwellWord {
  char letter;
  double unit_s;
};
/// If a line has several words, the first of these counts.
std::span<const DwellWord> dwell_words(Dialect dialect);

/// Whether an arc's offset along the axis across its plane is read and not used, as K on an arc of the XY plane.
bool offset_outside_plane_is_ignored(Dialect dialect);

/// The meaning of a code of the dialect in RS-274/NGC: G70 and G71 of fanuc are G20 and G21.
/// @param letter  G or M
/// @param number  of G ten times the number
int meant_code(Dialect dialect, char letter, int number);

/// The program called by P of M98.
struct SubprogramCall {
  std::int64_t number = 0;
  std::uint64_t repeats = 1;
};
/// fanuc: the last four digits of P are the program, those before them the repeats: P30004 runs O4 three times.
SubprogramCall subprogram_call(Dialect dialect, std::int64_t p);

}  // namespace kadr::gcode
