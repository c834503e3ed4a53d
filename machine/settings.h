#pragma once
#include "machine/choices.h"
#include "machine/infinity.h"
#include "machine/plan_method.h"

/// The settings of a machine file for planner, override, plant and log.
/// Units: `_u` is the axis's own unit, mm for a linear and degrees for a rotary axis.
namespace kadr::machine {

/// Limits along the tool path of X Y Z, in mm; axis limits apply as well.
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
  double tool_change_s = 0;                          ///< dwell caused by M6
  SchedulerKind scheduler = SchedulerKind::chained;  ///< ramps over many blocks, or block by block
  BlockTicks block_ticks = BlockTicks::exact;        ///< blockwise: how a block gets its whole control ticks
  RampLaw law = RampLaw::jerk_limited;               ///< shape of a planned ramp
  PlanMethod method = PlanMethod::scheduler;         ///< or a time law of paper 000
  double node_mm = 1;                                ///< time laws: longest path between two nodes, > 0
  int tube_levels = 100;                             ///< tube: speeds tried at a node, 3 to 1000
  RapidShape rapid_law = RapidShape::scurve;         ///< scurve: a rapid is planned as any other move
  double rapid_frequency_pct = 1;                    ///< automatic: links' frequencies are known to +- this
  /// Whether plans keep the jerk limits of axes and path: the laws of paper 000 have none.
  bool keeps_jerk() const { return facts(method).keeps_jerk; }
  bool operator==(const PlannerSettings&) const = default;
};

/// What the operator's override does to the feed, and what an axis beyond its limit does to it (paper
/// 003, sections 3 to 5).
struct OverrideSettings {
  OverrideMode mode = OverrideMode::corrected_plus;
  LockedFeed locked = LockedFeed::full;      ///< threads and taps: 100 %, or the override at their beginning
  LockedFeed disabled = LockedFeed::freeze;  ///< between M49 (M50 P0) and M48: the same choice
  LimiterKind limiter = LimiterKind::off;
  bool predictive = false;      ///< the limiter looks one control tick ahead instead of back
  double limiter_band_u_s = 3;  ///< delta of eq. 13-16: half the range in which it sets in smoothly, > 0
  bool operator==(const OverrideSettings&) const = default;
};

/// How the feed responds to spindle load. The product of this override and the operator's is in force.
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
  bool ticks = true;             ///< KADR_TICKS
  bool steps = true;             ///< KADR_STEPS
  ControlTicks block_ticks{32};  ///< control ticks per exact message, 16..64
  double viewer_rate_hz = 100;   ///< KADR_FEED, KADR_AXIS_*; 0 switches them off
  bool energy = false;           ///< joules of the motors, of each block and of the run
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

}  // namespace kadr::machine
