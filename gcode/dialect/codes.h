#pragma once
#include <cstdint>

/// The G and M codes, those that kadr runs, and those that exclude each other on a line.
namespace kadr::gcode {

/// The codes that kadr runs, by the names they have in a program. G codes count in tenths: G92.1 is 921.
namespace code {
inline constexpr int g0 = 0, g1 = 10, g2 = 20, g3 = 30, g4 = 40, g5 = 50, g5_1 = 51, g5_2 = 52, g5_3 = 53,
                     g7 = 70, g8 = 80, g10 = 100, g17 = 170, g18 = 180, g19 = 190, g20 = 200, g21 = 210,
                     g28 = 280, g28_1 = 281, g30 = 300, g30_1 = 301, g33 = 330, g33_1 = 331, g38_2 = 382,
                     g38_3 = 383, g38_4 = 384, g38_5 = 385, g40 = 400, g41 = 410, g41_1 = 411, g42 = 420,
                     g42_1 = 421, g43 = 430, g43_1 = 431, g43_2 = 432, g49 = 490, g52 = 520, g53 = 530,
                     g54 = 540, g55 = 550, g56 = 560, g57 = 570, g58 = 580, g59 = 590, g59_1 = 591,
                     g59_2 = 592, g59_3 = 593, g61 = 610, g61_1 = 611, g64 = 640, g73 = 730, g74 = 740,
                     g76 = 760, g80 = 800, g81 = 810, g82 = 820, g83 = 830, g84 = 840, g85 = 850, g86 = 860,
                     g89 = 890, g90 = 900, g90_1 = 901, g91 = 910, g91_1 = 911, g92 = 920, g92_1 = 921,
                     g92_2 = 922, g92_3 = 923, g93 = 930, g94 = 940, g95 = 950, g96 = 960, g97 = 970,
                     g98 = 980, g99 = 990;
inline constexpr int m0 = 0, m1 = 1, m2 = 2, m3 = 3, m4 = 4, m5 = 5, m6 = 6, m7 = 7, m8 = 8, m9 = 9, m19 = 19,
                     m30 = 30, m48 = 48, m49 = 49, m50 = 50, m51 = 51, m52 = 52, m53 = 53, m60 = 60, m61 = 61,
                     m62 = 62, m63 = 63, m64 = 64, m65 = 65, m66 = 66, m67 = 67, m68 = 68, m70 = 70, m71 = 71,
                     m72 = 72, m73 = 73, m98 = 98, m99 = 99;
}  // namespace code

/// Codes that a dialect alone has (gcode/dialect/dialect_codes.h), those of macro B among them.
namespace code {
inline constexpr int g31 = 310, g54_1 = 541, g66_1 = 661, g67 = 670, m97 = 97;
}

/// Modal groups of G codes (RS-274/NGC numbers them 0 to 13); one code of a group per line.
enum class GGroup : std::uint8_t {
  nonmodal,           ///< G4 G10 G28 G30 G52 G53 G92: hold for their line only
  motion,             ///< G0 to G3, splines, probing, threads, cycles, G80
  plane,              ///< G17 G18 G19
  distance,           ///< G90 G91
  arc_distance,       ///< G90.1 G91.1
  feed_mode,          ///< G93 G94 G95
  units,              ///< G20 G21
  compensation,       ///< G40 G41 G42 G41.1 G42.1
  tool_length,        ///< G43 G43.1 G43.2 G49
  coordinate_system,  ///< G54 .. G59.3
  path,               ///< G61 G61.1 G64
  retract,            ///< G98 G99
  spindle_mode,       ///< G96 G97
  diameter,           ///< G7 G8
  g92_state,          ///< G92.1 G92.2 G92.3
};
inline constexpr int kGGroups = 15;

enum class MGroup : std::uint8_t {
  stop,         ///< M0 M1 M2 M30 M60
  inputs,       ///< M62 to M68
  tool_change,  ///< M6 M61
  spindle,      ///< M3 M4 M5
  coolant,      ///< M7 M8 M9
  overrides,    ///< M48 M49 M50 M51 M53
  modal_state,  ///< M70 to M73
  call,         ///< M98 M99
};
inline constexpr int kMGroups = 8;

enum class Standing : std::uint8_t {
  unknown,  ///< not a code of the dialect
  not_run,  ///< a code of the dialect that kadr does not run
  runs,
};

/// A G code as ten times its number: G92.1 is 921.
struct GCode {
  Standing standing = Standing::unknown;
  GGroup group = GGroup::nonmodal;
};
struct MCode {
  Standing standing = Standing::unknown;
  MGroup group = MGroup::stop;
};

GCode g_code(int tenths);
MCode m_code(int number);

/// Effect of an M code on an output.
struct OutputCode {
  int number;
  bool analog;       ///< E is the output and Q its value; otherwise P is the output
  bool on;           ///< digital: the new state of the output
  bool with_motion;  ///< as the next motion begins, not at once
};
inline constexpr OutputCode kOutputCodes[] = {
    {.number = code::m62, .analog = false, .on = true, .with_motion = true},
    {.number = code::m63, .analog = false, .on = false, .with_motion = true},
    {.number = code::m64, .analog = false, .on = true, .with_motion = false},
    {.number = code::m65, .analog = false, .on = false, .with_motion = false},
    {.number = code::m67, .analog = true, .on = false, .with_motion = true},
    {.number = code::m68, .analog = true, .on = false, .with_motion = false},
};
/// Null if the code switches no output.
const OutputCode* output_code(int number);

/// True for the non-modal codes that take the axis words of a line for themselves.
bool takes_axis_words(int tenths);

}  // namespace kadr::gcode
