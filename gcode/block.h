#pragma once
#include <cstdint>
#include <string>

#include "machine/base/axes.h"
#include "machine/base/diagnostic.h"

/// What a control program means: one Block per canonical machining call, in mm, degrees and seconds, in
/// machine coordinates of the controlled point (offsets, units, planes, tool length applied). No modal state
/// is left.
namespace kadr::gcode {

enum class BlockKind : std::uint8_t {
  traverse,           ///< G0: straight at the rapid rate
  feed,               ///< G1
  arc,                ///< G2 G3, helix
  dwell,              ///< G4
  set_feed_rate,      ///< value: mm/min or deg/min, 1/min under G93
  set_feed_mode,      ///< feed_mode
  set_path_mode,      ///< path_mode, path_tolerance_mm
  spindle_speed,      ///< value: rpm
  spindle_clockwise,  ///< value: rpm
  spindle_counterclockwise,
  spindle_stop,
  mist_on,
  mist_off,
  flood_on,
  flood_off,
  select_tool,  ///< number
  change_tool,  ///< number
  message,      ///< text
  program_stop,
  optional_stop,
  program_end,
  feed_override,   ///< number: 1 enabled, 0 disabled (M48 M49 M50)
  speed_override,  ///< number: 1 enabled, 0 disabled (M48 M49 M51)
  comment,         ///< text; printed as a note only
};

enum class Plane : std::uint8_t { xy, zx, yz };
enum class FeedMode : std::uint8_t { units_per_minute, inverse_time };
enum class PathMode : std::uint8_t { exact_path, exact_stop, continuous };

/// Axes of a plane as indices into AxisValues: first, second (counter-clockwise from first to second),
/// normal.
struct PlaneAxes {
  int first, second, normal;
};
constexpr PlaneAxes plane_axes(Plane p) {
  return p == Plane::xy ? PlaneAxes{0, 1, 2} : p == Plane::zx ? PlaneAxes{2, 0, 1} : PlaneAxes{1, 2, 0};
}

/// What F measures for one move (NIST rule): X Y Z length if one of them moves, else U V W, else A B C in
/// degrees.
enum class FeedLength : std::uint8_t { xyz, uvw, rotary };

struct Block {
  BlockKind kind = BlockKind::comment;
  Span span;  ///< the line's words that made this block

  // motion: traverse, feed, arc
  AxisValues end{};  ///< mm, deg; machine coordinates; every axis, moved or not
  FeedLength feed_length = FeedLength::xyz;
  double length_u = 0;    ///< length that F measures, mm or deg (arc: along the helix)
  double feed_u_s = 0;    ///< programmed feed in mm/s or deg/s along length_u; 0 for a traverse
  double duration_s = 0;  ///< inverse time (G93): seconds for the whole move; 0 otherwise
  PathMode path_mode = PathMode::exact_path;
  double path_tolerance_mm = 0;  ///< G64 P
  bool feed_override_enabled = true;

  // arc
  Plane plane = Plane::xy;
  double center_first_mm = 0;  ///< machine coordinates in the plane's first and second axis
  double center_second_mm = 0;
  int turns = 0;  ///< > 0 counter-clockwise; 1: up to one turn

  // the rest
  double dwell_s = 0;
  double value = 0;
  int number = 0;
  FeedMode feed_mode = FeedMode::units_per_minute;
  std::string text;
};

}  // namespace kadr::gcode
