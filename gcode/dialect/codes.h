#pragma once
#include <cstdint>

/// Which G and M codes there are, which of them kadr runs, and which may not stand together on a line.
namespace kadr::gcode {

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

/// True for the non-modal codes that take the axis words of a line for themselves.
bool takes_axis_words(int tenths);

}  // namespace kadr::gcode
