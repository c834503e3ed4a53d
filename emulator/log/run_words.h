#pragma once
#include <cstdint>

#include "machine/base/vocabulary.h"

/// Words of the log's events and of its summary.
namespace kadr::log {

/// `motion` of the block that leads to where a program is entered: none of the program's blocks.
inline constexpr std::string_view kApproachMotion = "approach";

/// Subject of an event. Those up to `stop` are of the program.
enum class EventKind : std::uint8_t {
  dwell,
  spindle,
  sync,
  coolant,
  tool,
  lock,
  output,
  wait,
  probe,
  message,
  stop,
  alarm,
  alarm_end,
  residual,
  input,
  feed_override,
  rapid_override,
  spindle_override,
  hold,
  resume,
  spindle_load,
  emergency_stop,
};
inline constexpr Vocabulary<EventKind, 22> kEventKinds{{
    {EventKind::dwell, "dwell", "the program waits"},
    {EventKind::spindle, "spindle", "the spindle starts, stops or changes its speed"},
    {EventKind::sync, "sync", "the feed begins or ceases to follow the spindle"},
    {EventKind::coolant, "coolant", "mist or flood on or off"},
    {EventKind::tool, "tool", "a tool is selected, changed or named"},
    {EventKind::lock, "lock", "M48, M49, M50, M51"},
    {EventKind::output, "output", "a digital or analog output changes"},
    {EventKind::wait, "wait", "M66 has read an input, or waited for it"},
    {EventKind::probe, "probe", "a probing move has ended"},
    {EventKind::message, "message", "a message to the operator"},
    {EventKind::stop, "stop", "the program stops or ends"},
    {EventKind::alarm, "alarm", "a limit is exceeded, or the run can't continue"},
    {EventKind::alarm_end, "alarm end", "the limit is kept again; value: the worst"},
    {EventKind::residual, "residual", "vibration of an axis after a stop"},
    {EventKind::input, "input", "the scenario sets an input"},
    {EventKind::feed_override, "override", "the operator's feed override"},
    {EventKind::rapid_override, "rapid_override", "the operator's rapid override"},
    {EventKind::spindle_override, "spindle_override", "feed override for the spindle's load"},
    {EventKind::hold, "hold", "feed hold"},
    {EventKind::resume, "resume", "feed hold ends"},
    {EventKind::spindle_load, "spindle_load", "the spindle's load"},
    {EventKind::emergency_stop, "emergency_stop", "emergency stop"},
}};
static_assert(kEventKinds.complete());

/// Whether the program itself makes such an event, at a position of its path, under any override.
constexpr bool is_of_program(EventKind kind) { return kind <= EventKind::stop; }

/// How a run ended.
enum class Outcome : std::uint8_t {
  complete,
  alarm,
  interrupted,
  plant_error,
  stopped_by_until,
  emergency_stop,
  held,
};
inline constexpr Vocabulary<Outcome, 7> kOutcomes{{
    {Outcome::complete, "complete", "the program ran to its end"},
    {Outcome::alarm, "alarm", "an alarm ended the run (on_alarm = \"stop\")"},
    {Outcome::interrupted, "interrupted", "a signal ended the run"},
    {Outcome::plant_error, "plant error", "the plant's equations could not be solved"},
    {Outcome::stopped_by_until, "stopped by --until", "the requested time was reached"},
    {Outcome::emergency_stop, "emergency stop", "at rest after an emergency stop"},
    {Outcome::held, "held", "held, and no step of the operator ends the hold"},
}};
static_assert(kOutcomes.complete());

/// Why a control tick made less of the path than planned at 100 %.
enum class LostReason : std::uint8_t { feed_override, hold, deferral, limiter, spindle_load };
inline constexpr Vocabulary<LostReason, 5> kLostReasons{{
    {LostReason::feed_override, "override", "the operator's override"},
    {LostReason::hold, "hold", "feed hold"},
    {LostReason::deferral, "deferral", "an override waits for the motion before it"},
    {LostReason::limiter, "limiter", "the axis limiter"},
    {LostReason::spindle_load, "spindle load", "feed override for the spindle's load"},
}};
static_assert(kLostReasons.complete());

}  // namespace kadr::log
