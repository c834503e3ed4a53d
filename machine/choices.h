#pragma once
#include <cstdint>

/// The choices that a machine file makes. (Motors: two_masses.h; methods of interpolation: step_method.h.)
namespace kadr::machine {

/// What lengths of a program mean until it says G20 or G21.
enum class StartUnits : std::uint8_t { mm, inch };
enum class AxisKind : std::uint8_t { linear, rotary };
enum class IntegratorKind : std::uint8_t { smooth, reference, oracle };
enum class TickFeed : std::uint8_t { linear, constant };
enum class AxisLimitRule : std::uint8_t { enforce, report };
enum class OnAlarm : std::uint8_t { report, stop };
enum class SchedulerKind : std::uint8_t { chained, blockwise };
/// How a G0 gets from rest to rest where a flexible link vibrates (paper 001).
enum class RapidShape : std::uint8_t { scurve, t_zero, zv, zvd, automatic };
enum class RampLaw : std::uint8_t { jerk_limited, quintic };
enum class BlockTicks : std::uint8_t { exact, kl };
enum class OverrideMode : std::uint8_t { corrected_plus, corrected, proportional };
enum class LimiterKind : std::uint8_t { off, threshold, paper, matched };
enum class LockedFeed : std::uint8_t { full, freeze };

}  // namespace kadr::machine
