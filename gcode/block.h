#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "gcode/block_kind.h"
#include "gcode/wait_mode.h"
#include "machine/base/axes.h"
#include "machine/base/diagnostic.h"

/// What a control program means: one Block per canonical machining call, in mm, degrees and seconds, in
/// machine coordinates of the controlled point (offsets, units, planes, tool length applied). No modal state
/// is left.
namespace kadr::gcode {

enum class Plane : std::uint8_t { xy, zx, yz };
enum class FeedMode : std::uint8_t { units_per_minute, inverse_time, units_per_revolution };
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

/// A control point of a spline: machine coordinates in X and Y, mm, and its weight.
struct SplinePoint {
  double x_mm = 0;
  double y_mm = 0;
  double weight = 1;
};

struct InputWait {
  int number = 0;
  bool analog = false;
  WaitMode mode = WaitMode::immediate;
  double timeout_s = 0;
};

/// When G38 ends and whether it must.
struct ProbeRule {
  bool away = false;      ///< G38.4 G38.5: ends as contact is lost
  bool must_trip = true;  ///< G38.2 G38.4: reaching `end` is an error
  bool tripped = true;    ///< whether the stock plane was met (or left)
};

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
  /// Angle about Z by which the planes zx and yz are turned out of the machine's: 0 but under a rotated work
  /// system. The centre is then the point abreast of `end`.
  double plane_rotation_deg = 0;
  double center_first_mm = 0;  ///< machine coordinates in the plane's first and second axis
  double center_second_mm = 0;
  int turns = 0;  ///< > 0 counter-clockwise; 1: up to one turn

  // spline: B-spline of that order over clamped uniform knots; the first point is the start, the last the end
  std::vector<SplinePoint> control_points;
  int order = 0;  ///< 3: quadratic (G5.1), 4: cubic (G5)

  double pitch_u_rev =
      0;  ///< feed that follows the spindle: mm or deg per turn along length_u; 0: it does not
  ProbeRule probe;
  AxisValues contact{};  ///< probe: machine coordinates where the move ends
  InputWait wait;
  bool on = false;                 ///< digital_output
  bool with_motion = false;        ///< output changes as the next motion begins, not at once
  double surface_speed_m_min = 0;  ///< spindle_mode, spindle_speed: under G96, 0: the speed is in rpm
  double maximum_rpm = 0;          ///< spindle_mode: D of G96, 0: none

  // the rest
  double dwell_s = 0;
  double value = 0;
  int number = 0;
  FeedMode feed_mode = FeedMode::units_per_minute;
  std::string text;
};

}  // namespace kadr::gcode
