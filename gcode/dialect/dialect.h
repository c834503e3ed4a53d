#pragma once
#include <cstdint>
#include <span>

#include "machine/base/vocabulary.h"

namespace kadr::gcode {

/// The controller whose reading applies where controllers differ.
enum class Dialect : std::uint8_t { linuxcnc, grbl, mach3, marlin, fanuc, haas };

inline constexpr Vocabulary<Dialect, 6> kDialects{{
    {Dialect::linuxcnc, "linuxcnc", "LinuxCNC 2.9; the codes of docs/gcode.md"},
    {Dialect::grbl, "grbl", "Grbl 1.1; reads all of its codes as LinuxCNC does"},
    {Dialect::mach3, "mach3", "Mach3: P of G4 in milliseconds"},
    {Dialect::marlin, "marlin", "Marlin: P of G4 in milliseconds, G5 as a cubic spline"},
    {Dialect::fanuc, "fanuc", "FANUC: P of G4 in milliseconds, G70 and G71 as G20 and G21, M98 with repeats"},
    {Dialect::haas, "haas", "Haas: P of G4 in milliseconds"},
}};
static_assert(kDialects.complete());

/// A word of G4 and the seconds that 1 of it means.
struct DwellWord {
  char letter;
  double unit_s;
};

/// Macro B: variables, IF, GOTO, WHILE and G65 as FANUC has them, and where a dialect differs from it.
struct MacroRules {
  bool on = false;
  bool angles_to_360 = false;         ///< ATAN[y]/[x] from 0 to 360, ASIN from 270 over 360 to 90
  bool returns_to_number = false;     ///< M99 P leads to a line of the calling program, not of its own
  bool local_subs = false;            ///< M97 P calls lines of its own program
  bool then_runs_words = false;       ///< words may follow THEN, not only a setting
  bool diameters_in_offsets = false;  ///< #2401 .. #2600 are diameters of tools
};

/// What a dialect reads otherwise than LinuxCNC, whose rules the defaults are. A field is one difference.
struct DialectRules {
  std::span<const DwellWord> dwell_words;  ///< of G4; if a line has several words, the first of these counts
  bool offset_outside_plane_ignored = false;  ///< of an arc: K on an arc of the XY plane is read and not used
  bool cubic_g5_from_zero = false;            ///< an omitted word of G5 is 0
  bool repeats_in_p = false;                  ///< the digits of M98 P before the last four are repeats
  bool call_shares_line = false;              ///< M98 and M99 beside other words
  bool finds_subs_of_other_files = true;      ///< a subroutine in any file that was read can be called
  MacroRules macros = {};
};
const DialectRules& rules_of(Dialect dialect);

/// The meaning of a code of the dialect in RS-274/NGC: G70 and G71 of fanuc are G20 and G21.
/// @param letter  G or M
/// @param number  of G ten times the number
int meant_code(Dialect dialect, char letter, int number);

/// The program called by P of M98.
struct SubprogramCall {
  std::int64_t number = 0;
  std::uint64_t repeats = 1;
};
/// DialectRules::repeats_in_p: P30004 runs O4 three times.
SubprogramCall subprogram_call(Dialect dialect, std::int64_t p);

}  // namespace kadr::gcode
