#pragma once
#include "machine/base/vocabulary.h"
#include "machine/choices.h"

/// The machine's choices as machine files, logs and the command line spell them.
/// (Methods of interpolation: machine/step_method.h.)
namespace kadr::machine {

inline constexpr Vocabulary<StartUnits, 2> kStartUnits{{
    {StartUnits::mm, "mm", "millimetres"},
    {StartUnits::inch, "inch", "inches"},
}};
static_assert(kStartUnits.complete());

inline constexpr Vocabulary<AxisKind, 2> kAxisKinds{{
    {AxisKind::linear, "linear", "moves in mm"},
    {AxisKind::rotary, "rotary", "turns in degrees"},
}};
static_assert(kAxisKinds.complete());

inline constexpr Vocabulary<IntegratorKind, 3> kIntegrators{{
    {IntegratorKind::smooth, "smooth",
     "CVODE over a smoothed command plus the exact response to the steps; stepper motors: Taylor series"},
    {IntegratorKind::reference, "reference", "SUNDIALS CVODE from pulse to pulse"},
    {IntegratorKind::oracle, "oracle", "closed form; linear motors only"},
}};
static_assert(kIntegrators.complete());

inline constexpr Vocabulary<TickFeed, 2> kTickFeeds{{
    {TickFeed::linear, "linear", "the feed runs linearly over a control tick"},
    {TickFeed::constant, "constant", "the feed is constant in a control tick"},
}};
static_assert(kTickFeeds.complete());

inline constexpr Vocabulary<AxisLimitRule, 2> kAxisLimitRules{{
    {AxisLimitRule::enforce, "enforce", "plans keep the limits of every axis"},
    {AxisLimitRule::report, "report",
     "plans keep the limits of the path alone; an axis beyond its own raises an alarm"},
}};
static_assert(kAxisLimitRules.complete());

inline constexpr Vocabulary<OnAlarm, 2> kOnAlarms{{
    {OnAlarm::report, "report", "an alarm is logged, the run goes on"},
    {OnAlarm::stop, "stop", "the first alarm ends the run"},
}};
static_assert(kOnAlarms.complete());

inline constexpr Vocabulary<SchedulerKind, 2> kSchedulers{{
    {SchedulerKind::chained, "chained", "a ramp runs over as many blocks as it needs"},
    {SchedulerKind::blockwise, "blockwise", "a ramp begins and ends within one block"},
}};
static_assert(kSchedulers.complete());

inline constexpr Vocabulary<RapidShape, 5> kRapidShapes{{
    {RapidShape::scurve, "scurve", "planned as any other move"},
    {RapidShape::t_zero, "t-zero", "ramps or the time between them last whole periods of the link"},
    {RapidShape::zv, "zv", "the fastest move and its copy half a period later"},
    {RapidShape::zvd, "zvd", "three copies; hardly sensitive to the frequency"},
    {RapidShape::automatic, "auto",
     "t-zero where it is cheap and the frequency well known, else zv, else zvd"},
}};
static_assert(kRapidShapes.complete());

inline constexpr Vocabulary<RampLaw, 2> kRampLaws{{
    {RampLaw::jerk_limited, "jerk_limited", "constant jerk"},
    {RampLaw::quintic, "quintic", "speed by a polynomial of fifth degree"},
}};
static_assert(kRampLaws.complete());

inline constexpr Vocabulary<BlockTicks, 2> kBlockTicks{{
    {BlockTicks::exact, "exact", "speeds are lowered until a block takes whole ticks"},
    {BlockTicks::kl, "kl", "all speeds of a block times one factor (paper 003)"},
}};
static_assert(kBlockTicks.complete());

inline constexpr Vocabulary<OverrideMode, 3> kOverrideModes{{
    {OverrideMode::corrected_plus, "corrected+", "lowers only what is above the override"},
    {OverrideMode::corrected, "corrected", "as corrected+, and never faster than the plan (paper 003)"},
    {OverrideMode::proportional, "proportional", "the planned feed times the override; limits are not kept"},
}};
static_assert(kOverrideModes.complete());

inline constexpr Vocabulary<LimiterKind, 4> kLimiters{{
    {LimiterKind::off, "off", "no limiter"},
    {LimiterKind::threshold, "threshold", "lowers the feed as soon as an axis exceeds its limit"},
    {LimiterKind::paper, "paper", "smooth transition as printed in paper 003"},
    {LimiterKind::matched, "matched", "smooth transition whose ends match"},
}};
static_assert(kLimiters.complete());

inline constexpr Vocabulary<LockedFeed, 2> kLockedFeeds{{
    {LockedFeed::full, "full", "100 %"},
    {LockedFeed::freeze, "freeze", "the override in force when the lock began"},
}};
static_assert(kLockedFeeds.complete());

}  // namespace kadr::machine
