#pragma once
#include <cstdint>

namespace kadr::gcode {

/// The canonical machining calls that a Block can be; which of its fields each one uses.
enum class BlockKind : std::uint8_t {
  traverse,           ///< G0: straight at the rapid rate
  feed,               ///< G1
  arc,                ///< G2 G3, helix
  spline,             ///< G5 G5.1 G5.2: spline
  probe,              ///< G38.2 to G38.5: straight until the probe changes, at most to `end`
  rigid_tap,          ///< G33.1: to `end` in step with the spindle, and back to where it began `value` times
                      ///< as fast
  dwell,              ///< G4
  set_feed_rate,      ///< value: mm/min or deg/min, 1/min under G93
  set_feed_mode,      ///< feed_mode
  set_path_mode,      ///< path_mode, path_tolerance_mm
  spindle_speed,      ///< value: S as written; rpm, under G96 see surface_speed_m_min
  spindle_clockwise,  ///< value: rpm, under G96 that of this place
  spindle_counterclockwise,
  spindle_stop,  ///< on: oriented (M19), to `value` degrees the way that `number` says, -1 if neither is told
  mist_on,
  mist_off,
  flood_on,
  flood_off,
  sync_start,       ///< the moves from here on follow the spindle's angle; value: mm/rev
  sync_stop,        ///< the feed no longer follows the spindle
  spindle_mode,     ///< surface_speed_m_min, maximum_rpm (G96); both 0 (G97)
  select_tool,      ///< number
  change_tool,      ///< number
  set_tool_number,  ///< number; M61: no change, another number for the tool in the spindle
  digital_output,   ///< number, on, with_motion (M62 to M65)
  analog_output,    ///< number, value, with_motion (M67 M68)
  wait_input,       ///< wait (M66)
  message,          ///< text
  program_stop,
  optional_stop,
  program_end,     ///< number 1: by a closing %, which is no call; 0: by all else
  feed_override,   ///< number: 1 enabled, 0 disabled (M48 M49 M50)
  speed_override,  ///< number: 1 enabled, 0 disabled (M48 M49 M51)
  speed_point,     ///< value: highest speed, mm/s or deg/s along what F measures, where the next move begins
  comment,         ///< text; printed as a note only
};

}  // namespace kadr::gcode
