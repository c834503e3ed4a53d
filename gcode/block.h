#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gcode/block_kind.h"
#include "gcode/wait_mode.h"
#include "machine/base/axes.h"
#include "machine/base/diagnostic.h"

/// The meaning of a control program: one Block per canonical machining call, in mm, degrees and seconds, in machine
/// coordinates of the controlled point (offsets, units, planes, tool length applied). No modal state is left.
///
/// A new kind of block is an enumerator and a word in block_kind.h, a struct and its place in Action here. What
/// has to treat it (canonical trace, log, path) then does not compile until it does.
namespace kadr::gcode {

enum class Plane : std::uint8_t { xy, zx, yz };
enum class FeedMode : std::uint8_t { units_per_minute, inverse_time, units_per_revolution };
enum class PathMode : std::uint8_t { exact_path, exact_stop, continuous };

/// Axes of a plane as indices into AxisValues: first, second (counter-clockwise from first to second), normal.
struct PlaneAxes {
  int first, second, normal;
};
constexpr PlaneAxes plane_axes(Plane p) {
  return p == Plane::xy ? PlaneAxes{0, 1, 2} : p == Plane::zx ? PlaneAxes{2, 0, 1} : PlaneAxes{1, 2, 0};
}

/// Length measured by F for one move (NIST rule): X Y Z length if one of them moves, else U V W, else A B C in degrees.
enum class FeedLength : std::uint8_t { xyz, uvw, rotary };

// --- moves ---

/// Common to all moves. The small members come first and a double last, so that nothing of a derived struct lies in
/// padding at the end: g++ 12 at -O3 overwrites it where a function's result initializes the base.
struct Move {
  AxisValues end{};  ///< mm, deg; machine coordinates; every axis, moved or not
  FeedLength feed_length = FeedLength::xyz;
  PathMode path_mode = PathMode::exact_path;
  bool feed_override_enabled = true;
  double length_u = 0;    ///< length that F measures, mm or deg (arc: along the helix)
  double feed_u_s = 0;    ///< programmed feed in mm/s or deg/s along length_u; 0 for a traverse
  double duration_s = 0;  ///< inverse time (G93): seconds for the whole move; 0 otherwise
  /// feed that follows the spindle: mm or deg per turn along length_u; 0: it does not
  double pitch_u_rev = 0;
  double path_tolerance_mm = 0;  ///< G64 P
};
static_assert(offsetof(Move, path_tolerance_mm) + sizeof(double) == sizeof(Move));

/// Straight at the rapid rate.
struct Traverse : Move {
  static constexpr BlockKind kKind = BlockKind::traverse;
};

/// Straight at the programmed feed.
struct Feed : Move {
  static constexpr BlockKind kKind = BlockKind::feed;
};

/// Arc or helix.
struct Arc : Move {
  static constexpr BlockKind kKind = BlockKind::arc;
  Plane plane = Plane::xy;
  /// Angle about Z by which the planes zx and yz are turned out of the machine's: 0 except under a rotated work
  /// system. The centre is then the point level with `end`.
  double plane_rotation_deg = 0;
  double center_first_mm = 0;  ///< machine coordinates in the plane's first and second axis
  double center_second_mm = 0;
  int turns = 0;  ///< > 0 counter-clockwise; 1: up to one turn
};

/// A control point of a spline: machine coordinates in X and Y, mm, and its weight.
struct SplinePoint {
  double x_mm = 0;
  double y_mm = 0;
  double weight = 1;
};

/// B-spline in XY over clamped uniform knots; the first control point is the start, the last the end.
struct Spline : Move {
  static constexpr BlockKind kKind = BlockKind::spline;
  std::vector<SplinePoint> control_points = {};
  int order = 0;  ///< 3: quadratic (G5.1), 4: cubic (G5)
};

/// Straight towards `end` until the probe changes. length_u is the part up to `contact`.
struct Probe : Move {
  static constexpr BlockKind kKind = BlockKind::probe;
  bool away = false;      ///< G38.4 G38.5: ends when contact is lost
  bool must_trip = true;  ///< G38.2 G38.4: reaching `end` is an error
  bool tripped = true;    ///< whether the stock plane was met (or left)
  AxisValues contact{};   ///< machine coordinates where the move ends
};

/// To `end` in step with the spindle, and back to where it began.
struct RigidTap : Move {
  static constexpr BlockKind kKind = BlockKind::rigid_tap;
  double retract_ratio = 1;  ///< speed back over speed down (I of G33.1)
};

/// To `end` at the rapid rate, where a program is entered (Reading::from_line): from the machine's home, one way
/// after the other, at rest between them. No move of the program.
struct Approach : Move {
  static constexpr BlockKind kKind = BlockKind::approach;
  /// The axes that move together: {"XY", "Z"}. Those that stand there already are left out.
  std::vector<std::string> ways = {};
};

// --- everything else ---

struct Dwell {
  static constexpr BlockKind kKind = BlockKind::dwell;
  double time_s = 0;
  bool by_machine = false;  ///< what a code takes on this machine, not a word of the program
};

struct SetFeedRate {
  static constexpr BlockKind kKind = BlockKind::set_feed_rate;
  double rate = 0;  ///< mm/min or deg/min; under G93 1/min, under G95 mm or deg per turn
};

struct SetFeedMode {
  static constexpr BlockKind kKind = BlockKind::set_feed_mode;
  FeedMode mode = FeedMode::units_per_minute;
};

struct SetPathMode {
  static constexpr BlockKind kKind = BlockKind::set_path_mode;
  PathMode mode = PathMode::exact_path;
  double tolerance_mm = 0;  ///< G64 P
};

struct SpindleSpeed {
  static constexpr BlockKind kKind = BlockKind::spindle_speed;
  double s_word = 0;               ///< S as written: rpm, under G96 m/min or feet/min
  double surface_speed_m_min = 0;  ///< under G96; 0: s_word is in rpm
};

struct SpindleClockwise {
  static constexpr BlockKind kKind = BlockKind::spindle_clockwise;
  double speed_rpm = 0;  ///< under G96 that of this position
};

struct SpindleCounterclockwise {
  static constexpr BlockKind kKind = BlockKind::spindle_counterclockwise;
  double speed_rpm = 0;  ///< under G96 that of this position
};

/// M19: where the spindle stops.
struct SpindleOrientation {
  double angle_deg = 0;
  int direction = -1;  ///< P: 0 the shorter way, 1 clockwise, 2 counter-clockwise; -1: neither R nor P given
};

struct SpindleStop {
  static constexpr BlockKind kKind = BlockKind::spindle_stop;
  std::optional<SpindleOrientation> orientation;
};

struct MistOn {
  static constexpr BlockKind kKind = BlockKind::mist_on;
};
struct MistOff {
  static constexpr BlockKind kKind = BlockKind::mist_off;
};
struct FloodOn {
  static constexpr BlockKind kKind = BlockKind::flood_on;
};
struct FloodOff {
  static constexpr BlockKind kKind = BlockKind::flood_off;
};

/// The moves from here on follow the spindle's angle.
struct SyncStart {
  static constexpr BlockKind kKind = BlockKind::sync_start;
  double pitch_mm_rev = 0;
};
struct SyncStop {
  static constexpr BlockKind kKind = BlockKind::sync_stop;
};

/// G96; both 0: G97.
struct SpindleMode {
  static constexpr BlockKind kKind = BlockKind::spindle_mode;
  double surface_speed_m_min = 0;
  double maximum_rpm = 0;  ///< D of G96; 0: none
};

struct SelectTool {
  static constexpr BlockKind kKind = BlockKind::select_tool;
  int tool = 0;
};
struct ChangeTool {
  static constexpr BlockKind kKind = BlockKind::change_tool;
  int tool = 0;
};
/// M61: no change, a new number for the tool in the spindle.
struct SetToolNumber {
  static constexpr BlockKind kKind = BlockKind::set_tool_number;
  int tool = 0;
};

struct DigitalOutput {
  static constexpr BlockKind kKind = BlockKind::digital_output;
  int number = 0;
  bool on = false;
  bool with_motion = false;  ///< changes as the next motion begins, not at once
};

struct AnalogOutput {
  static constexpr BlockKind kKind = BlockKind::analog_output;
  int number = 0;
  double value = 0;
  bool with_motion = false;  ///< changes as the next motion begins, not at once
};

struct InputWait {
  static constexpr BlockKind kKind = BlockKind::wait_input;
  int number = 0;
  bool analog = false;
  WaitMode mode = WaitMode::immediate;
  double timeout_s = 0;
};

struct Message {
  static constexpr BlockKind kKind = BlockKind::message;
  std::string text;
};

struct ProgramStop {
  static constexpr BlockKind kKind = BlockKind::program_stop;
};
struct OptionalStop {
  static constexpr BlockKind kKind = BlockKind::optional_stop;
};
struct ProgramEnd {
  static constexpr BlockKind kKind = BlockKind::program_end;
  bool by_percent = false;  ///< a closing %, which is no canonical call
};

struct FeedOverride {
  static constexpr BlockKind kKind = BlockKind::feed_override;
  bool enabled = true;
};
struct SpeedOverride {
  static constexpr BlockKind kKind = BlockKind::speed_override;
  bool enabled = true;
};

/// Highest speed where the next move begins.
struct SpeedPoint {
  static constexpr BlockKind kKind = BlockKind::speed_point;
  double max_u_s = 0;  ///< mm/s or deg/s along what F measures
};

struct Comment {
  static constexpr BlockKind kKind = BlockKind::comment;
  std::string text;
};

// --- the block ---

using Action = std::variant<Traverse, Feed, Arc, Spline, Probe, RigidTap, Approach,                // moves
                            Dwell, SetFeedRate, SetFeedMode, SetPathMode,                          //
                            SpindleSpeed, SpindleClockwise, SpindleCounterclockwise, SpindleStop,  //
                            MistOn, MistOff, FloodOn, FloodOff, SyncStart, SyncStop, SpindleMode,  //
                            SelectTool, ChangeTool, SetToolNumber, DigitalOutput, AnalogOutput, InputWait,  //
                            Message, ProgramStop, OptionalStop, ProgramEnd, FeedOverride, SpeedOverride,    //
                            SpeedPoint, Comment>;

template <class A>
concept MoveAction = std::derived_from<A, Move>;
template <class A>
concept NoMove = !std::derived_from<A, Move>;

template <class... Actions>
constexpr std::array<BlockKind, sizeof...(Actions)> kinds_of(const std::variant<Actions...>*) {
  return {Actions::kKind...};
}
/// [alternatives of Action]
inline constexpr auto kActionKinds = kinds_of(static_cast<const Action*>(nullptr));

constexpr bool each_kind_has_its_action() {
  if (kActionKinds.size() != kBlockKinds.size()) return false;
  for (std::size_t i = 0; i < kActionKinds.size(); ++i)
    if (kActionKinds[i] != kBlockKinds.words[i].value) return false;
  return true;
}
static_assert(each_kind_has_its_action(), "Action lists one struct per BlockKind, in the same order");

/// Made once by the interpreter; nobody writes into it later.
struct Block {
  Span span;  ///< the words of the line that made this block
  Action action;

  BlockKind kind() const { return kActionKinds[action.index()]; }
};

/// The move that a block is, null if it is none.
const Move* move_of(const Block& block);
Move* move_of(Block& block);
inline bool is_move(const Block& block) { return move_of(block) != nullptr; }
/// Whether a block is one of these: `is<Dwell, InputWait>(block)`.
template <class... Actions>
bool is(const Block& block) {
  return (std::holds_alternative<Actions>(block.action) || ...);
}

}  // namespace kadr::gcode
