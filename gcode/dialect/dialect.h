#pragma once
#include <cstdint>
#include <span>
#include <string_view>

#include "machine/base/vocabulary.h"

namespace kadr::gcode {

/// The controller whose reading applies where controllers differ.
enum class Dialect : std::uint8_t { linuxcnc, grbl, mach3, marlin, reprap, fanuc, haas };

inline constexpr Vocabulary<Dialect, 7> kDialects{{
    {Dialect::linuxcnc, "linuxcnc", "LinuxCNC 2.9; the codes of docs/gcode.md"},
    {Dialect::grbl, "grbl", "Grbl 1.1, with its limits; also FluidNC and grblHAL, which have fewer"},
    {Dialect::mach3, "mach3", "Mach3 and UCCNC: dwells in milliseconds, G80 gives back G0 to G3"},
    {Dialect::marlin, "marlin", "Marlin: G0 at F, checksums, codes of printers told once"},
    {Dialect::reprap, "reprap", "RepRapFirmware: as marlin"},
    {Dialect::fanuc, "fanuc",
     "FANUC, milling: dwells in milliseconds, G80 gives back G0 to G3, G54.1, M98 with repeats"},
    {Dialect::haas, "haas", "Haas, milling: as fanuc; G154, G110 to G129"},
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

/// How a text is split into words.
struct TextRules {
  bool comment_ends_at_first =
      false;  ///< the first ) ends a comment, whatever opens in it; else the line's end does
  bool controller_lines =
      false;  ///< lines that begin with $, and lines of ? ! ~ alone, are for the controller
  bool percent_remarks = false;       ///< % with text behind it begins a remark
  bool checksums = false;             ///< N3 G1 X5*71: the bytes before * exclusive-or'ed
  bool text_codes = false;            ///< M117 and others that take the rest of the line as text
  bool corners = false;               ///< ,R and ,C behind a move
  bool bare_letters = false;          ///< G28 X: a letter without a value, as a flag
  bool expressions = true;            ///< # [ ] and O words
  std::uint32_t line_characters = 0;  ///< of a line without blanks and comments; 0: no bound

  /// Whether a line can mean something as a whole.
  constexpr bool of_lines() const {
    return controller_lines || percent_remarks || checksums || line_characters > 0;
  }
};

/// What a dialect reads otherwise than LinuxCNC, whose rules the defaults are. A field is one difference.
struct DialectRules {
  std::string_view name = "LinuxCNC";  ///< of the controller, for messages
  TextRules text = {};
  std::span<const DwellWord> dwell_words;  ///< of G4; if a line has several words, the first of these counts
  double cycle_dwell_s = 1;                ///< 1 of P in a cycle
  bool point_means_seconds = false;        ///< P with a decimal point is in seconds
  bool offset_outside_plane_ignored = false;  ///< of an arc: K on an arc of the XY plane is read and not used
  bool arc_needs_end = false;                 ///< an arc without an axis word of its plane is refused
  bool cubic_g5_from_zero = false;            ///< an omitted word of G5 is 0
  bool repeats_in_p = false;                  ///< the digits of M98 P before the last four are repeats
  bool repeats_in_k = false;                  ///< of cycles: K as well as L, and 0 drills no hole
  bool taps_peck = false;                     ///< Q of G74 and G84
  bool call_shares_line = false;              ///< M98 and M99 beside other words
  bool finds_subs_of_other_files = true;      ///< a subroutine in any file that was read can be called
  bool begins_with_rapid = false;             ///< G0 holds before the first motion code
  bool begins_in_mm = false;                  ///< without a setting of the controller
  bool begins_with_g98 = false;
  bool keeps_group_1 =
      false;  ///< cycles are a group of their own: G80 gives back G0 to G3, G31 holds for its line
  bool bare_arc_sets_mode = false;  ///< G2 without words moves nothing
  bool home_beside_motion = false;  ///< G0 G28 Z0: G0 sets the mode
  bool homes_directly = false;      ///< G28 leads to the end switches, not by a point
  bool radius_in_p = false;         ///< of G41 and G42
  bool probe_in_2000 = false;       ///< #2000 to #2005: where the last probing tripped
  double rapid_at_feed_mm_min =
      0;                    ///< G0 moves at F as G1 does, before the first F at this; 0: as fast as it can
  bool extruder = false;    ///< E moves a filament
  int further_systems = 0;  ///< work systems of G54.1 P or G154 P
  int largest_tool = 99'999;
  MacroRules macros = {};
};
const DialectRules& rules_of(Dialect dialect);

/// The program called by P of M98.
struct SubprogramCall {
  std::int64_t number = 0;
  std::uint64_t repeats = 1;
};
/// DialectRules::repeats_in_p: P30004 runs O4 three times.
SubprogramCall subprogram_call(Dialect dialect, std::int64_t p);

}  // namespace kadr::gcode
