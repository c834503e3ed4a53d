#pragma once
#include "machine/file/key.h"
#include "machine/machine.h"
#include "machine/motor.h"
#include "machine/words.h"

/// The keys of a machine file, each declared once: from here they are read, printed and documented
/// (`kadr machine keys`, docs/machine_keys.md).
namespace kadr::machine {

// Bounds of the settings, in the unit of the key. The outer ends are far beyond any machine: they guard
// products and squares of the values against overflow, and make step counts exact (1e8 / 1e-7 = 1e15 steps < 2^53).
inline constexpr Bounds kFeedBounds{1e-6, 1e9};
inline constexpr Bounds kAccelBounds{1e-6, 1e12};
inline constexpr Bounds kJerkBounds{1e-6, 1e15, true};
inline constexpr Bounds kStepBounds{1e-7, 1e6};
inline constexpr Bounds kStepsPerBounds{1e-6, 1e7};
inline constexpr Bounds kPositionBounds{-1e8, 1e8};
inline constexpr Bounds kRangeBounds{-1e8, 1e8, true};
inline constexpr Bounds kMassBounds{1e-9, 1e9};
inline constexpr Bounds kStiffnessBounds{1e-9, 1e15};
inline constexpr Bounds kDampingBounds{0, 1e12};
inline constexpr Bounds kForceBounds{1e-9, 1e12};
inline constexpr Bounds kPitchBounds{1e-6, 1e6};
inline constexpr Bounds kPathFeedBounds{1e-6, 1e9, true};
inline constexpr Bounds kPathAccelBounds{1e-6, 1e12, true};
inline constexpr Bounds kTime_ms{1, 1e6};
inline constexpr Bounds kPercent{0, 100};

// keys that are no plain member: they are read by hand, and documented here
inline constexpr PlainKey kFormat{"format", "1", "required", "edition of the machine file's format"};
inline constexpr PlainKey kName{"name", "1 to 100 bytes on one line", "required", "name of the machine"};
inline constexpr PlainKey kProgramUnits{"units", "\"mm\" or \"inch\"", "mm, with a warning",
                                        "what lengths mean in a program that says neither G20 nor G21"};
inline constexpr PlainKey kProgramStartup{
    "startup", "G codes that set modes, F, S", "\"\"",
    "words that hold before a program's first line: \"G18 G7\" of a lathe"};
inline constexpr PlainKey kAxisName{"name", "X Y Z A B C U V W", "required",
                                    "the letter by which programs call the axis"};
inline constexpr PlainKey kRangeDocument{"range_{u}", "[lowest, highest]", "required by linear axes",
                                         "soft limits, machine coordinates; -inf, inf: none"};
inline constexpr PlainKey kApproach{
    "approach", "[groups of axis letters]", "all but Z, then Z; upwards Z first",
    "--from-line: the axes of a group move together, one group after the other: [\"XY\", \"Z\"]"};
inline constexpr PlainKey kStockAxis{"axis", "X Y Z U V W", "\"Z\"",
                                     "the linear axis along which a probe meets the material"};
inline constexpr PlainKey kTechnologyOn{"on", "M62 P, M63 P, M67 E", "required",
                                        "the code that changes an output, with its number: \"M62 P1\""};

inline constexpr auto kOnAlarm =
    key("on_alarm", &MachineModel::on_alarm, kOnAlarms, "overrun of a limit, or lost steps");

/// [clock] as written; the model counts in ticks.
struct ClockKeys {
  double rate_hz = 10e6;
  double control_period_us = 1000;
};
inline constexpr auto kRate = key("rate_hz", &ClockKeys::rate_hz, Bounds{1e6, 1e9, false, true},
                                  "base clock: step pulses are stamped in its ticks; a multiple of 1 MHz");
inline constexpr auto kControlPeriod =
    key("control_period_us", &ClockKeys::control_period_us, Bounds{1e-3, 65536},
        "the feed is computed once per control period; a whole number of ticks, up to 65536");

inline constexpr auto kPathKeys =
    keys_of(key("arc_end_tolerance_mm", &PathLimits::arc_end_tolerance_mm, Bounds{0, 1e6},
                "radius at the start and at the end of an arc may differ by this"),
            key("arc_end_tolerance_relative", &PathLimits::arc_end_tolerance_relative, Bounds{0, 1},
                "and by this fraction of the radius"));

inline constexpr auto kFeedKeys =
    keys_of(key("max_mm_s", &PathLimits::max_feed_mm_s, kPathFeedBounds, "highest feed"),
            key("max_acceleration_mm_s2", &PathLimits::max_accel_mm_s2, kPathAccelBounds,
                "highest acceleration along the path"),
            key("max_jerk_mm_s3", &PathLimits::max_jerk_mm_s3, kJerkBounds,
                "highest jerk along the path; inf: acceleration may jump"),
            key("centripetal_acceleration_mm_s2", &PathLimits::centripetal_accel_mm_s2, kPathAccelBounds,
                "bounds the feed on arcs: feed = sqrt(this * radius)"));

inline constexpr auto kPlannerKeys = keys_of(
    key("whole_ticks", &PlannerSettings::whole_ticks,
        "a motion from rest to rest lasts a whole number of control periods"),
    key("axis_limits", &PlannerSettings::axis_limits, kAxisLimitRules, "whether plans keep the axes' limits"),
    key("tick_feed", &PlannerSettings::tick_feed, kTickFeeds, "feed inside a control period"),
    key("tool_change_s", &PlannerSettings::tool_change_s, Bounds{0, 1e6}, "time that M6 takes"),
    key("scheduler", &PlannerSettings::scheduler, kSchedulers, "how far a ramp may reach"),
    key("block_ticks", &PlannerSettings::block_ticks, kBlockTicks,
        "blockwise: how a block gets its whole control periods"),
    key("law", &PlannerSettings::law, kRampLaws, "shape of a planned ramp"),
    key("method", &PlannerSettings::method, kMachinePlanMethods, "how the feed is planned"),
    key("node_mm", &PlannerSettings::node_mm, Bounds{1e-3, 1e3}, "time laws: longest path between two nodes"),
    key("tube_levels", &PlannerSettings::tube_levels, Bounds{3, 1000}, "tube: speeds tried at a node"),
    key("rapid_law", &PlannerSettings::rapid_law, kRapidShapes, "how a G0 of a flexible axis is planned"),
    key("rapid_frequency_pct", &PlannerSettings::rapid_frequency_pct, Bounds{0, 50},
        "rapid_law = \"auto\": the links' frequencies are known to +- this"));

inline constexpr auto kInterpolatorMethod =
    key("method", &MachineModel::interpolator, kMachineMethods, "which pulses a segment gives, and when");

inline constexpr auto kOverrideKeys = keys_of(
    key("mode", &OverrideSettings::mode, kOverrideModes, "what the operator's override does to the feed"),
    key("locked", &OverrideSettings::locked, kLockedFeeds, "feed of threads and taps"),
    key("disabled", &OverrideSettings::disabled, kLockedFeeds, "feed between M49 and M48"),
    key("limiter", &OverrideSettings::limiter, kLimiters,
        "proportional mode: what an axis beyond its limit does to the feed"),
    key("predictive", &OverrideSettings::predictive, "the limiter looks one control period ahead"),
    key("limiter_band_mm_s", &OverrideSettings::limiter_band_u_s, Bounds{1e-3, 1e4},
        "half the range in which the smooth limiters set in"));

inline constexpr auto kSpindleKeys =
    keys_of(key("high_load_pct", &SpindleReaction::high_load_pct, Bounds{1, 1000},
                "above this for high_ms, and again every down_ms: down_pct less"),
            key("high_ms", &SpindleReaction::high_ms, kTime_ms, "how long the load must be high"),
            key("down_pct", &SpindleReaction::down_pct, kPercent, "what the override loses each time"),
            key("down_ms", &SpindleReaction::down_ms, kTime_ms, "from one loss to the next"),
            key("low_load_pct", &SpindleReaction::low_load_pct, Bounds{0, 1000},
                "below this for low_ms, and again every up_ms: up_pct more, to 100 %"),
            key("low_ms", &SpindleReaction::low_ms, kTime_ms, "how long the load must be low"),
            key("up_pct", &SpindleReaction::up_pct, kPercent, "what the override gains each time"),
            key("up_ms", &SpindleReaction::up_ms, kTime_ms, "from one gain to the next"),
            key("least_pct", &SpindleReaction::least_pct, Bounds{1, 100},
                "the load never takes the override below this"));

inline constexpr auto kIntegrator =
    key("integrator", &PlantSettings::integrator, kIntegrators, "how the motion of the masses is computed");
inline constexpr auto kTolerance =
    key("tolerance_um", &PlantSettings::tolerance_um, Bounds{1e-12, 1e3}, "of the integration");

inline constexpr PlainKey kCodesIgnored{"ignore", "[\"M31\", ...]", "none",
                                        "codes that are passed over with the words that belong to them"};
inline constexpr PlainKey kOwnerCall{
    "call", "a name", "none",
    "subroutine that runs in place of the code, and reads the words of its line as #<p>, #<q>, ..."};
inline constexpr auto kOwnerKeys = keys_of(
    key("time_s", &OwnerCode::time_s, Bounds{0, 1e6},
        "time that the code takes; of M6 the same as planner.tool_change_s"),
    key("output", &OwnerCode::output, Bounds{0, 63}, "digital output that it switches").default_is("none"),
    key("on", &OwnerCode::on, "the new state of the output"),
    key("stop", &OwnerCode::stop,
        "whether the motion stops; otherwise the output is switched as the next motion begins"));

inline constexpr auto kTechnologyLimit =
    key("max_mm_s", &TechnologyRule::max_u_s, Bounds{1e-3, 1e6}, "highest feed where the output changes")
        .required();

inline constexpr auto kStockPosition =
    key("position_mm", &StockModel::position_mm, kPositionBounds,
        "where the material begins, machine coordinates of the probe's tip")
        .required();
inline constexpr auto kStockBelow =
    key("below", &StockModel::below, "whether the material lies below that position, or above");

inline constexpr auto kLogKeys =
    keys_of(key("ticks", &LogSettings::ticks, "exact data of every control period (KADR_TICKS)"),
            key("steps", &LogSettings::steps, "every step pulse (KADR_STEPS)"),
            key("energy", &LogSettings::energy, "joules of the motors, of each block and of the run"),
            key("block_ticks", &LogSettings::block_ticks, Bounds{16, 64}, "control periods per message"));
/// Its highest value is the control rate: viewer values come from control ticks.
inline constexpr auto kViewerRate =
    key("viewer_rate_hz", &LogSettings::viewer_rate_hz, Bounds{0, 1e9},
        "channels for live viewers, up to the control rate; 0 switches them off");

inline constexpr auto kAxisKindKey =
    key("kind", &AxisModel::kind, kAxisKinds, "X Y Z are linear, A B C rotary, U V W either")
        .default_is("by the letter");
inline constexpr auto kStep =
    key("step_{u}", &AxisModel::step_u, kStepBounds, "one motor step; or steps_per_mm, steps_per_deg")
        .required();
inline constexpr auto kHome = key("home_{u}", &AxisModel::home_u, kPositionBounds,
                                  "where the machine stands when a program begins (and G28 goes)");
/// The machine keeps G30's positions, of all axes together.
struct SecondHome {
  double home2_u = 0;
};
inline constexpr auto kHome2 =
    key("home2_{u}", &SecondHome::home2_u, kPositionBounds, "where G30 goes").default_is("home");
inline constexpr auto kMaxFeed =
    key("max_{u}_s", &AxisModel::max_feed_u_s, kFeedBounds, "highest speed, also the rapid rate").required();
inline constexpr auto kMaxAccel =
    key("max_acceleration_{u}_s2", &AxisModel::max_accel_u_s2, kAccelBounds, "highest acceleration")
        .required();
inline constexpr auto kMaxJerk =
    key("max_jerk_{u}_s3", &AxisModel::max_jerk_u_s3, kJerkBounds, "highest jerk; inf: acceleration may jump")
        .required();
inline constexpr auto kJunctionAccel =
    key("junction_acceleration_{u}_s2", &AxisModel::junction_accel_u_s2, kAccelBounds,
        "at a corner the axis may change its speed by this in one control period")
        .default_is("max_acceleration");
inline constexpr auto kJunctionJerk =
    key("junction_jerk_{u}_s3", &AxisModel::junction_jerk_u_s3, kJerkBounds,
        "at a corner the axis may change its acceleration by this in one control period");
/// Those behind `max_{u}_s`, in the order of the file. The defaults of the second table depend on the first.
inline constexpr auto kAxisLimitKeys = keys_of(kMaxAccel, kMaxJerk);
inline constexpr auto kJunctionKeys = keys_of(kJunctionAccel, kJunctionJerk);

inline constexpr auto kMotor =
    key("model", &TwoMassModel::motor, kMotorModels,
        "the motor; keys of other motors are ignored; \"rigid\" without a link follows its steps exactly")
        .required();
inline constexpr auto kPlantKeys = keys_of(
    key("base_mass_{mass}", &TwoMassModel::base_mass_kg, kMassBounds, "motor and carriage")
        .required(Need::link),
    key("link_mass_{mass}", &TwoMassModel::link_mass_kg, kMassBounds, "flexible part with the tool")
        .required(Need::link),
    key("link_stiffness_{stiffness}", &TwoMassModel::link_stiffness_N_per_m, kStiffnessBounds,
        "spring between the two; frequency = sqrt(stiffness / mass) / 2 pi")
        .required(Need::link),
    key("link_damping_{damping}", &TwoMassModel::link_damping_Ns_per_m, kDampingBounds,
        "damper between the two; ratio = damping / (2 sqrt(stiffness mass))")
        .required(Need::link),
    key("base_friction_{damping}", &TwoMassModel::base_friction_Ns_per_m, kDampingBounds,
        "viscous friction of the guide"),
    key("motor_stiffness_{stiffness}", &TwoMassModel::motor_stiffness_N_per_m, kStiffnessBounds,
        "spring of the motor")
        .required(Need::motor),
    key("motor_damping_{damping}", &TwoMassModel::motor_damping_Ns_per_m, kDampingBounds,
        "damping of the motor")
        .required(Need::motor),
    key("holding_force_{force}", &TwoMassModel::holding_force_N, kForceBounds, "largest force of the motor")
        .required(Need::motor),
    key("tooth_pitch_{u}", &TwoMassModel::tooth_pitch_u, kPitchBounds,
        "motion per electrical period: four full steps")
        .required(Need::motor));

}  // namespace kadr::machine
