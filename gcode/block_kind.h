#pragma once
#include <cstdint>

#include "machine/base/vocabulary.h"

namespace kadr::gcode {

/// The canonical machining calls that a Block can be, in the order of the alternatives of Action (block.h), which
/// says what each one carries.
enum class BlockKind : std::uint8_t {
  // moves
  traverse,
  feed,
  arc,
  spline,
  probe,
  rigid_tap,
  approach,
  // all else
  dwell,
  set_feed_rate,
  set_feed_mode,
  set_path_mode,
  spindle_speed,
  spindle_clockwise,
  spindle_counterclockwise,
  spindle_stop,
  mist_on,
  mist_off,
  flood_on,
  flood_off,
  sync_start,
  sync_stop,
  spindle_mode,
  select_tool,
  change_tool,
  set_tool_number,
  digital_output,
  analog_output,
  wait_input,
  message,
  program_stop,
  optional_stop,
  program_end,
  feed_override,
  speed_override,
  speed_point,
  comment,
};

/// What tables of a plan and of a run call each kind, and the words of a program that make it.
inline constexpr Vocabulary<BlockKind, 36> kBlockKinds{{
    {BlockKind::traverse, "rapid", "G0: straight at the rapid rate"},
    {BlockKind::feed, "line", "G1"},
    {BlockKind::arc, "arc", "G2 G3: arc or helix"},
    {BlockKind::spline, "spline", "G5 G5.1 G5.2"},
    {BlockKind::probe, "probe", "G38.2 to G38.5: straight until the probe changes"},
    {BlockKind::rigid_tap, "tap", "G33.1: to the bottom in step with the spindle, and back"},
    {BlockKind::approach, "approach", "to the place where --from-line enters the program"},
    {BlockKind::dwell, "dwell", "G4"},
    {BlockKind::set_feed_rate, "feed rate", "F"},
    {BlockKind::set_feed_mode, "feed mode", "G93 G94 G95"},
    {BlockKind::set_path_mode, "path mode", "G61 G61.1 G64"},
    {BlockKind::spindle_speed, "spindle speed", "S"},
    {BlockKind::spindle_clockwise, "spindle clockwise", "M3"},
    {BlockKind::spindle_counterclockwise, "spindle counter-clockwise", "M4"},
    {BlockKind::spindle_stop, "spindle stop", "M5 M19"},
    {BlockKind::mist_on, "mist on", "M7"},
    {BlockKind::mist_off, "mist off", "M9"},
    {BlockKind::flood_on, "flood on", "M8"},
    {BlockKind::flood_off, "flood off", "M9"},
    {BlockKind::sync_start, "sync start", "G33 G33.1 G76: moves from here on follow the spindle's angle"},
    {BlockKind::sync_stop, "sync stop", "moves no longer follow the spindle's angle"},
    {BlockKind::spindle_mode, "spindle mode", "G96 G97"},
    {BlockKind::select_tool, "select tool", "T"},
    {BlockKind::change_tool, "tool change", "M6"},
    {BlockKind::set_tool_number, "tool number", "M61: another number for the tool in the spindle"},
    {BlockKind::digital_output, "digital output", "M62 to M65"},
    {BlockKind::analog_output, "analog output", "M67 M68"},
    {BlockKind::wait_input, "wait", "M66"},
    {BlockKind::message, "message", "(MSG, ...) and (DEBUG, ...)"},
    {BlockKind::program_stop, "program stop", "M0 M60"},
    {BlockKind::optional_stop, "optional stop", "M1"},
    {BlockKind::program_end, "program end", "M2 M30, a closing %, or the end of the file"},
    {BlockKind::feed_override, "feed override", "M48 M49 M50"},
    {BlockKind::speed_override, "spindle override", "M48 M49 M51"},
    {BlockKind::speed_point, "speed point", "(TECH s_max=...)"},
    {BlockKind::comment, "comment", "(PRINT, ...): printed as a note only"},
}};
static_assert(kBlockKinds.complete());

}  // namespace kadr::gcode
