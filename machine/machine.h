#pragma once
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "machine/base/axes.h"
#include "machine/base/count.h"
#include "machine/base/diagnostic.h"

/// The machine: facts that are true before a program is loaded. Read by all, changed by none.
/// Units: `_u` is the axis's own unit, mm for a linear and degrees for a rotary axis.
namespace kadr::machine {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

enum class AxisKind : std::uint8_t { linear, rotary };
enum class MotorModel : std::uint8_t { rigid, spring, stepper };
enum class IntegratorKind : std::uint8_t { smooth, reference, oracle };
enum class TickFeed : std::uint8_t { linear, constant };
enum class AxisLimitRule : std::uint8_t { enforce, report };
enum class OnAlarm : std::uint8_t { report, stop };
enum class SchedulerKind : std::uint8_t { chained, blockwise };
enum class PlanMethod : std::uint8_t { scheduler, tube, certified, jerk_limited };
/// How a G0 gets from rest to rest where a flexible link swings (paper 001).
enum class RapidShape : std::uint8_t { scurve, t_zero, zv, zvd, automatic };
/// Which pulses a segment gives, and when: half-crossings at their moments, or a method of paper 002 at one
/// clock slot a step, for study.
enum class StepMethod : std::uint8_t {
  crossing,
  classic,
  half_step,
  diagonal,
  extra_points,
  octant_midpoint,
  dda,
  dda_preloaded,
  dda_sequential,
  dda_simultaneous,
  progression,
  chords,
  ptp,
};
enum class RampLaw : std::uint8_t { jerk_limited, quintic };
enum class BlockTicks : std::uint8_t { exact, kl };
enum class OverrideMode : std::uint8_t { corrected_plus, corrected, proportional };
enum class LimiterKind : std::uint8_t { off, threshold, paper, matched };
enum class LockedFeed : std::uint8_t { full, freeze };

/// Two masses on one axis (paper 001, eq. 5-6). SI: kg, N/m, N s/m; for a rotary axis kg m^2, N m/rad, N m
/// s/rad.
struct TwoMassModel {
  MotorModel motor = MotorModel::rigid;
  double base_mass = 0;        ///< m0: motor and carriage, > 0
  double link_mass = 0;        ///< m1: flexible part, > 0
  double link_stiffness = 0;   ///< k, > 0
  double link_damping = 0;     ///< c, >= 0
  double base_friction = 0;    ///< b0, viscous, >= 0
  double motor_stiffness = 0;  ///< Km of `spring`, > 0
  double motor_damping = 0;    ///< bm, >= 0
  double holding_force = 0;    ///< F_hold of `stepper`, > 0
  double tooth_pitch_u = 0;    ///< `stepper`: motion per electrical period (four full steps), mm or deg, > 0
  bool operator==(const TwoMassModel&) const = default;
};

struct AxisModel {
  char letter = 'X';
  AxisKind kind = AxisKind::linear;
  double step_u = 0;  ///< one motor step, > 0
  double soft_min_u = -kInfinity;
  double soft_max_u = kInfinity;
  double home_u = 0;        ///< machine position at program start
  double max_feed_u_s = 0;  ///< also the rapid rate
  double max_accel_u_s2 = 0;
  double max_jerk_u_s3 = kInfinity;       ///< inf: trapezoidal profile
  double junction_accel_u_s2 = 0;         ///< allowed acceleration step at a corner (over one tau)
  double junction_jerk_u_s3 = kInfinity;  ///< allowed jerk at a corner (over one tau)
  bool has_plant = false;                 ///< false: not modelled, moves as `rigid` without a link
  TwoMassModel plant;
  bool operator==(const AxisModel&) const = default;
};

struct ClockModel {
  std::int64_t base_hz = 10'000'000;  ///< a multiple of 1 MHz
  Ticks control_tick{10'000};         ///< tau in base ticks, <= 65536
  double tau_s() const { return static_cast<double>(control_tick.value) / static_cast<double>(base_hz); }
  bool operator==(const ClockModel&) const = default;
};

/// Limits along the tool path of X Y Z, in mm; axis limits hold besides.
struct PathLimits {
  double max_feed_mm_s = kInfinity;
  double max_accel_mm_s2 = kInfinity;
  double max_jerk_mm_s3 = kInfinity;
  double centripetal_accel_mm_s2 = kInfinity;
  double arc_end_tolerance_mm = 0.01;  ///< radius difference accepted between an arc's start and end
  double arc_end_tolerance_relative = 0.001;
  bool operator==(const PathLimits&) const = default;
};

struct PlannerSettings {
  bool whole_ticks = true;  ///< motion ends on a control tick (paper 003, eq. 2)
  AxisLimitRule axis_limits = AxisLimitRule::enforce;
  TickFeed tick_feed = TickFeed::linear;
  double tool_change_s = 0;                          ///< dwell that M6 costs
  SchedulerKind scheduler = SchedulerKind::chained;  ///< ramps over many blocks, or block by block
  BlockTicks block_ticks = BlockTicks::exact;        ///< blockwise: how a block gets its whole control ticks
  RampLaw law = RampLaw::jerk_limited;               ///< shape of a planned ramp
  PlanMethod method = PlanMethod::scheduler;         ///< or a time law of paper 000
  double node_mm = 1;                                ///< time laws: longest path between two nodes, > 0
  int tube_levels = 100;                             ///< tube: speeds tried at a node, 3 to 1000
  RapidShape rapid_law = RapidShape::scurve;         ///< scurve: a rapid is planned as any other move
  double rapid_frequency_pct = 1;                    ///< automatic: links' frequencies are known to +- this
  /// Whether plans keep the jerk limits of axes and path: the laws of paper 000 know none.
  bool keeps_jerk() const { return method == PlanMethod::scheduler || method == PlanMethod::jerk_limited; }
  bool operator==(const PlannerSettings&) const = default;
};

/// What an operator's percent does to the feed, and what an axis that is asked for too much does to it (paper
/// 003, sections 3 to 5).
struct OverrideSettings {
  OverrideMode mode = OverrideMode::corrected_plus;
  LockedFeed locked = LockedFeed::full;      ///< threads and taps: 100 %, or the percent of their beginning
  LockedFeed disabled = LockedFeed::freeze;  ///< between M49 (M50 P0) and M48: the same choice
  LimiterKind limiter = LimiterKind::off;
  bool predictive = false;      ///< the limiter looks one control tick ahead, in place of one back
  double limiter_band_u_s = 3;  ///< delta of eq. 13-16: half the range in which it sets in smoothly, > 0
  bool operator==(const OverrideSettings&) const = default;
};

/// How the feed answers a spindle that carries too much. The product of this percent and the operator's is in
/// force.
struct SpindleReaction {
  double high_load_pct = 110;  ///< above it for high_ms, and again every down_ms: down_pct less
  double high_ms = 20;
  double down_pct = 10;
  double down_ms = 100;
  double low_load_pct = 90;  ///< below it for low_ms, and again every up_ms: up_pct more, to 100 %
  double low_ms = 500;
  double up_pct = 5;
  double up_ms = 200;
  double least_pct = 30;  ///< never below
  bool operator==(const SpindleReaction&) const = default;
};

struct PlantSettings {
  IntegratorKind integrator = IntegratorKind::smooth;
  double tolerance_um = 1e-8;
  bool operator==(const PlantSettings&) const = default;
};

struct LogSettings {
  bool ticks = true;            ///< KADR_TICKS
  bool steps = true;            ///< KADR_STEPS
  int block_ticks = 32;         ///< control ticks per exact message, 16..64
  double viewer_rate_hz = 100;  ///< KADR_FEED, KADR_AXIS_*; 0 switches them off
  bool energy = false;          ///< joules of the motors, of each block and of the run
  bool operator==(const LogSettings&) const = default;
};

/// Material that a probe meets: all that lies below (or above) a plane across one linear axis.
struct StockModel {
  char axis = 'Z';
  double position_mm = 0;  ///< machine coordinates of the probe's tip
  bool below = true;
  bool operator==(const StockModel&) const = default;
};

/// A technology point wherever an output changes with the motion: "M62 P1" (on), "M63 P1" (off), "M67 E0".
struct TechnologyRule {
  bool analog = false;
  int number = 0;
  bool on = true;      ///< of a digital output
  double max_u_s = 0;  ///< highest feed there, mm/s or deg/s along what F measures, > 0
  bool operator==(const TechnologyRule&) const = default;
};

struct MachineModel {
  std::string name;
  ClockModel clock;
  std::vector<AxisModel> axis;  ///< [machine axes], 1..9, in the order of the file
  PathLimits path;
  PlannerSettings planner;
  StepMethod interpolator = StepMethod::crossing;
  OverrideSettings feed_override;
  SpindleReaction spindle;
  PlantSettings plant;
  LogSettings log;
  OnAlarm on_alarm = OnAlarm::report;
  std::optional<StockModel> stock;
  std::vector<TechnologyRule> technology;  ///< [rules], in the order of the file
  AxisValues home2{};                      ///< G30 position, machine coordinates

  /// Index in `axis` by letter, -1 if the machine has no such axis.
  int find_axis(char letter) const;
  bool operator==(const MachineModel&) const = default;
};

/// Where a value comes from: its key as in a setting ("axis.X.max_mm_s") and "mill3.toml:42" or "command
/// line".
struct KeyOrigin {
  std::string key;
  std::string origin;
};

/// A machine file that was read, with the text its spans point to.
struct MachineFile {
  MachineModel model;
  std::string text;
  std::vector<KeyOrigin> origins =
      {};  ///< values that were given, in the order of reading; all others are defaults
};

/// Reads a machine file (TOML; docs in machine/files/mill3.toml). All mistakes of the file are told at once.
/// @param sources   the text is added here, so that diagnostics can be rendered
/// @param overrides "key=value" settings from the command line, same keys as in the file
tl::expected<MachineFile, Diagnostics> read_machine(SourceText text, SourceSet& sources,
                                                    const std::vector<std::string>& overrides = {});

/// A machine that ships with kadr: "mill3", "winder4", "rig1", "robot7"; empty text if there is none of that
/// name.
std::string_view shipped_machine(std::string_view name);
std::vector<std::string_view> shipped_machine_names();

/// Every value in force with its origin (file:line, default, command line), as TOML with comments.
std::string render_machine(const MachineFile& file);

}  // namespace kadr::machine
