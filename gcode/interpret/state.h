#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "gcode/block.h"
#include "gcode/dialect/codes.h"
#include "gcode/dialect/dialect.h"
#include "gcode/gcode.h"
#include "gcode/read/ini_file.h"
#include "gcode/read/names.h"
#include "gcode/read/tool_table.h"
#include "machine/base/axes.h"
#include "machine/owner_codes.h"

namespace kadr::gcode {

inline constexpr double kMillimetresPerInch = 25.4;
inline constexpr int kWorkSystems = kPlainWorkSystems;

/// The motion code in force.
enum class Motion : std::uint8_t {
  none,
  traverse,
  feed,
  arc_clockwise,
  arc_counterclockwise,
  cubic_spline,      ///< G5
  quadratic_spline,  ///< G5.1
  nurbs,             ///< G5.2 until G5.3
  thread,            ///< G33
  rigid_tap,         ///< G33.1
  probe,             ///< G38.2 to G38.5, which one: State::probe_code
  thread_cycle,      ///< G76
  cycle,             ///< G73 G74 G81 to G86 G89, which one: CycleWords::code
};
constexpr bool is_arc(Motion motion) {
  return motion == Motion::arc_clockwise || motion == Motion::arc_counterclockwise;
}

/// Numbers of the parameters with a fixed meaning. Lengths in mm whatever the units in force.
namespace parameter {
inline constexpr int kFirst = 1;
inline constexpr int kLast = 5601;
inline constexpr int kOwnFirst = 31;  ///< .. kOwnLast: mean what the program makes of them, in every call
inline constexpr int kOwnLast = 5000;
/// .. kMachineLast, where the machine stands, machine coordinates in the units in force; read-only
inline constexpr int kMachine = 5021;
inline constexpr int kMachineLast = 5029;
/// .. kAppliedLast, the tool offset in force, in the units in force; read-only
inline constexpr int kApplied = 5081;
inline constexpr int kAppliedLast = 5089;
inline constexpr int kG28 = 5161;  ///< .. 5169
inline constexpr int kG30 = 5181;  ///< .. 5189
/// .. 5069, where the last probing tripped, program coordinates and units of then
inline constexpr int kProbe = 5061;
inline constexpr int kDebug = 5599;  ///< 0: (DEBUG, ...) is silent; 1 at start
inline constexpr int kProbeTripped = 5070;
inline constexpr int kInput = 5399;       ///< what the last M66 read
inline constexpr int kG92Active = 5210;   ///< 1 while the G92 offset holds
inline constexpr int kG92 = 5211;         ///< .. 5219
inline constexpr int kWorkSystem = 5220;  ///< 1 .. 9: G54 .. G59.3
inline constexpr int kWorkOffset = 5221;  ///< .. 5229, then 20 further for each system
inline constexpr int kWorkOffsetStride = 20;
inline constexpr int kWorkRotation = 5230;  ///< of G54 in degrees, then 20 further for each system
// of the tool in the spindle, as its table says; read-only up to kToolLast
inline constexpr int kToolNumber = 5400;
inline constexpr int kToolOffset = 5401;  ///< .. 5409
inline constexpr int kToolDiameter = 5410;
inline constexpr int kToolFrontAngle = 5411;
inline constexpr int kToolBackAngle = 5412;
inline constexpr int kToolOrientation = 5413;
inline constexpr int kToolLast = kToolOrientation;
/// .. kPositionLast, program coordinates in the units in force; read-only
inline constexpr int kPosition = 5420;
inline constexpr int kPositionLast = 5428;

/// True for parameters that are part of the interpreter's state and can't be set.
constexpr bool is_read_only(int index) {
  return index == kWorkSystem || (index >= kToolNumber && index <= kToolLast) ||
         (index >= kPosition && index <= kPositionLast) || (index >= kMachine && index <= kMachineLast) ||
         (index >= kApplied && index <= kAppliedLast);
}
}  // namespace parameter

enum class Turning : std::uint8_t { stopped, clockwise, counterclockwise };

/// G96: the spindle's speed follows the distance of the tool from X0.
struct SurfaceSpeed {
  bool on = false;
  double speed_m_min = 0;
  double maximum_rpm = 0;  ///< D; 0: none
};

/// Values that canned cycles keep from line to line: numbers as written, in the units of their line, as
/// RS-274/NGC keeps them.
struct CycleWords {
  int code = 0;              ///< ten times the G number of the cycle in force
  bool in_sequence = false;  ///< no other motion has come since the sequence of cycles began
  double initial_level = 0;  ///< where the sequence began, along the plane's normal: G98 returns there
  double last_level = 0;     ///< where the last cycle ended
  double retract = 0;        ///< R
  double bottom = 0;         ///< Z, in G18 Y, in G19 X
  double peck = 0;           ///< Q
  double tap_peck = 0;       ///< Q of a tap, in dialects that have it; 0: in one go
  double dwell_s = 0;        ///< P
};

/// State that can't be trusted after a line with an error, so that one mistake is reported once.
struct Uncertain {
  std::uint32_t axes = 0;  ///< bit per program axis: position unknown
  bool feed = false;
  bool motion = false;
  bool parameters = false;
  bool cycle = false;  ///< words that a cycle keeps
};

/// The modes that M70 and M73 save and M72 restores. The motion code is not one of them.
struct ModalState {
  bool inches = false, incremental = false, arc_centers_absolute = false;
  bool retract_to_start = false, diameter_mode = false, constant_surface_speed = false;
  bool feed_override = true, speed_override = true, feed_hold = true;
  bool mist = false, flood = false;
  Plane plane = Plane::xy;
  FeedMode feed_mode = FeedMode::units_per_minute;
  PathMode path_mode = PathMode::continuous;
  double path_tolerance = 0;  ///< as written
  double feed_number = 0;     ///< F as written
  double spindle_rpm = 0;
  Turning turning = Turning::stopped;
  int work_system = 1;
  int compensation_code = code::g40;
  bool tool_length = false;  ///< G43 .. G43.2 with an offset other than 0
  bool g92_active = false;
};

inline constexpr int kLocals = 30;       ///< #1 to #30 belong to a call
inline constexpr int kMacroLocals = 33;  ///< of macro B #1 to #33

/// State of one call of a subroutine; the main program is the first.
struct CallLevel {
  std::array<double, kMacroLocals> numbered{};     ///< #1 .. of the caller, restored at the return
  bool own_numbered = true;                        ///< false: M98, which shares the caller's
  std::optional<ModalState> modal;                 ///< kept by M70 or M73
  bool restores_modal = false;                     ///< M73: restored at the return
  std::optional<machine::CodeName> code;           ///< of the machine's owner, that made the call
  std::unordered_map<std::int32_t, double> named;  ///< local named parameters by number of the name
};

/// Everything that a line of a program depends on besides its own words.
struct State {
  AxisValues position{};     ///< controlled point as programmed, machine coordinates, mm and deg
  AxisValues tool_shift{};   ///< of the tool's centre from there under cutter compensation
  AxisValues work_offset{};  ///< of the work system in force
  AxisValues g92_offset{};   ///< in force
  AxisValues tool_offset{};  ///< G43 in force
  int work_system = 1;       ///< 1 .. 9
  double rotation_deg = 0;   ///< of the work system in force, about Z
  double rotation_cos = 1, rotation_sin = 0;

  Motion motion = Motion::none;
  Motion group_1 = Motion::none;  ///< the last of G0 to G3: what G80 gives back in some dialects
  Plane plane = Plane::xy;
  bool inches = false;
  bool incremental = false;           ///< G91
  bool arc_centers_absolute = false;  ///< G90.1
  FeedMode feed_mode = FeedMode::units_per_minute;
  double feed_number = 0;         ///< F as written, 0 after each G94 and G95; under G93 that of the last move
  double feed_linear_mm_min = 0;  ///< F as it holds for lengths
  double feed_rotary_deg_min = 0;  ///< F as it holds for angles: never scaled
  double feed_linear_mm_rev = 0;   ///< F under G95, for lengths
  double feed_rotary_deg_rev = 0;  ///< F under G95, for angles
  bool feed_given = false;         ///< some F has been seen since the start or the last G94 or G95
  bool feed_cleared = false;       ///< the last G94 or G95 has cancelled an F in force
  PathMode path_mode = PathMode::continuous;
  double path_tolerance = 0;  ///< G64 P as written
  double path_tolerance_mm = 0;
  bool feed_override = true;
  bool speed_override = true;

  bool retract_to_start = false;        ///< G98: cycles return to where they began, not to R (G99, at start)
  bool diameter_mode = false;           ///< G7
  int compensation_code = code::g40;    ///< G40, G41 or G42
  bool constant_surface_speed = false;  ///< G96

  double spindle_rpm = 0;  ///< S as written, under G96 a surface speed
  Turning turning = Turning::stopped;
  SurfaceSpeed surface;
  bool feed_hold = true;  ///< M53: the hold input is obeyed
  bool mist = false, flood = false;
  int tool_selected = 0;
  ToolTable tools;  ///< as G10 L1 L10 L11 have changed it
  CycleWords cycle;
  int probe_code = 0;
  int tool_in_spindle = 0;
  int pocket_of(int tool) const {
    const Tool* entry = tools.find(tool);
    return entry ? entry->pocket : 0;
  }
  bool straight_move_due = false;  ///< no arc may follow G40

  std::vector<AxisValues> further_offsets;  ///< of G54.1 P1 and on, as far as one was set
  std::vector<double> parameters = std::vector<double>(parameter::kLast + 1, 0.0);
  std::vector<bool> parameters_set = std::vector<bool>(parameter::kLast + 1);  ///< by the program
  Names names;                         ///< of parameters and of labels of O words
  std::vector<double> global_named;    ///< [names], by number of the name
  std::vector<bool> global_named_set;  ///< [names]
  std::vector<CallLevel> levels = std::vector<CallLevel>(1);
  double returned_value = 0;  ///< of the last subroutine
  bool value_returned = false;
  Uncertain uncertain;
  MacroRules macros;             ///< of the dialect
  const IniFile* ini = nullptr;  ///< of the machine; null: none is given

  /// Parameters from #1 on that belong to a call.
  int locals() const { return macros.on ? kMacroLocals : kLocals; }
  /// G41 or G42 is in force, even with a radius of 0.
  bool compensating() const { return compensation_code != code::g40; }
  int call_level() const { return static_cast<int>(levels.size()) - 1; }
  double length_factor() const { return inches ? kMillimetresPerInch : 1.0; }
  /// A value of an axis word in mm or deg.
  double to_base_units(int axis, double value) const {
    return is_rotary_letter(kAxisLetters[static_cast<std::size_t>(axis)]) ? value : value * length_factor();
  }
  double to_program_units(int axis, double value) const {
    return is_rotary_letter(kAxisLetters[static_cast<std::size_t>(axis)]) ? value : value / length_factor();
  }
  /// Program coordinates in mm and deg -> machine coordinates:
  ///   machine = work + R(rotation) · (program + g92) + tool,  R turns X and Y about Z
  AxisValues to_machine(const AxisValues& program) const;
  AxisValues to_program(const AxisValues& machine) const;
  /// R(rotation) of a vector, and R(-rotation).
  AxisValues rotated(AxisValues vector) const;
  AxisValues rotated_back(AxisValues vector) const;
  void set_rotation(double degrees);
  /// Brings a work system's offset and rotation into force: 1 .. 9, 10 and on for G54.1 P1 and on.
  void use_work_system(int system);
  AxisValues work_zero(int system) const;
  void set_work_zero(int system, const AxisValues& zero);
  /// The tool of a number; 0 means the one in the spindle. Null if the table does not have it.
  const Tool* find_tool(int number) const { return tools.find(number == 0 ? tool_in_spindle : number); }
  /// The same for one axis; X and Y only where rotation_deg is 0.
  double axis_to_machine(std::size_t a, double program) const {
    return (program + g92_offset[a]) + (work_offset[a] + tool_offset[a]);
  }
  double axis_to_program(std::size_t a, double machine) const {
    return machine - work_offset[a] - tool_offset[a] - g92_offset[a];
  }
  /// Real position of the controlled point: off `position` under cutter compensation.
  AxisValues tool_point() const;
  /// Program coordinate in program units, as in parameters 5420.. and messages.
  double program_position(int axis) const {
    return to_program_units(axis, to_program(tool_point())[static_cast<std::size_t>(axis)]);
  }
};

/// The G code of the motion in force, in tenths; G80 for none.
int motion_code(const State& state);
/// G17, G18 or G19, in tenths.
constexpr int plane_code(Plane plane) {
  return plane == Plane::xy ? code::g17 : plane == Plane::zx ? code::g18 : code::g19;
}

/// Value of a numbered parameter; positions and tool data are those of now.
/// @pre parameter::kFirst <= index <= parameter::kLast
double read_parameter(const State& state, int index);

/// Value of a named parameter that is not predefined, null if it was never set in this scope.
const double* find_named(const State& state, std::int32_t name);
void set_named(State& state, std::int32_t name, double value);

/// First of the nine offset parameters of a work system.
constexpr int work_offset_parameter(int system) {
  return parameter::kWorkOffset + (system - 1) * parameter::kWorkOffsetStride;
}
constexpr int work_rotation_parameter(int system) {
  return parameter::kWorkRotation + (system - 1) * parameter::kWorkOffsetStride;
}

/// Nine consecutive parameters from `first` on.
AxisValues read_axis_parameters(const State& state, int first);
void write_axis_parameters(State& state, int first, const AxisValues& values);

}  // namespace kadr::gcode
