#pragma once
#include <array>

#include "emulator/scenario/scenario.h"
#include "machine/file/key.h"

/// The keys of a scenario file, each declared once: from here they are read, and documented in
/// scenarios/README.md.
namespace kadr::scenario {

inline constexpr machine::Bounds kWholeCount{0, 9e15, false, true};
inline constexpr machine::Bounds kSignedCount{-9e15, 9e15, false, true};
inline constexpr machine::Bounds kTime{0, 1e9};
inline constexpr machine::Bounds kLength{0, 1e9};
inline constexpr machine::Bounds kLine{1, 4e9, false, true};
inline constexpr machine::Bounds kAny{-1e12, 1e12};

using machine::NumberKey;

inline constexpr machine::PlainKey kScenarioName{"name", "a text", "required", "name of the scenario"};
inline constexpr machine::PlainKey kSummary{"summary", "a text", "", "what it shows, in a line"};
inline constexpr machine::PlainKey kProgram{"program", "a file", "required without [wind]",
                                            "a program in the scenario's folder or below"};
inline constexpr machine::PlainKey kMachine{
    "machine", "a name or file", "required",
    "a machine that ships with kadr, or a file in the scenario's folder or below"};
inline constexpr machine::PlainKey kTools{"tools", "a file", "tools have no length",
                                          "a tool table in the scenario's folder or below"};
inline constexpr machine::PlainKey kIni{
    "ini", "a file", "no #<_ini[...]> has a value",
    "LinuxCNC's INI file of the machine, in the scenario's folder or below"};
inline constexpr machine::PlainKey kIgnore{"ignore", "[\"M31\", ...]", "none",
                                           "G and M codes to pass over, besides those of the machine"};
inline constexpr machine::PlainKey kHal{"NAME", "a number", "",
                                        "value of the HAL pin NAME, for #<_hal[NAME]>"};
inline constexpr machine::PlainKey kDialect{"dialect", "one of --dialect", "\"linuxcnc\"",
                                            "codes that controllers read differently"};
inline constexpr NumberKey kScenarioFormat{
    "format", {1, 1e6, false, true}, "edition of the file's format: 1"};
inline constexpr NumberKey kMostOverride{
    "most_override_pct",
    {100, 200},
    "highest override that the run is prepared for; without it that of the steps"};
inline constexpr NumberKey kFromLine{
    "from_line", kLine,
    "line of the program at which it is entered: what comes before is run without motion"};
inline constexpr NumberKey kToLine{"to_line", kLine,
                                   "line of the program behind which it ends, the first time that it is run"};
inline constexpr std::array kScenarioTexts{kScenarioName, kSummary, kProgram, kMachine,
                                           kTools,        kDialect, kIni,     kIgnore};

// where a technology point lies, beside `on` and `max_mm_s` of the machine file
inline constexpr NumberKey kPointLine{"at_line", kLine, "where the first motion of that line begins"};
inline constexpr NumberKey kPointPath{"at_path_mm", kLength, "a length of the path"};
inline constexpr std::array kTechnologyKeys{kPointLine, kPointPath};

// when or where a step of the timeline is
inline constexpr NumberKey kAtS{"at_s", kTime, "time, a whole number of control periods"};
inline constexpr NumberKey kAtTick{"at_tick", kWholeCount, "control period"};
inline constexpr NumberKey kAtLine{"at_line", {1, 1e9, false, true}, "where motion of that line begins"};
inline constexpr NumberKey kPass{"pass", {1, 1e9, false, true}, "which time that line is passed"};
inline constexpr NumberKey kAtBlock{"at_block", {0, 1e9, false, true}, "where that block begins, from 0"};
inline constexpr NumberKey kAtPath{"at_path_mm", kLength, "a length of the path"};
inline constexpr NumberKey kAfter{"after_mm", kLength, "so far behind at_line or at_block"};
inline constexpr std::array kMomentKeys{kAtS, kAtTick, kAtLine, kPass, kAtBlock, kAtPath, kAfter};

/// What a step does: exactly one of these.
struct ActionKey {
  enum class Takes : std::uint8_t { percent, flag, input };
  std::string_view name;
  Takes takes;
  machine::Bounds bounds;  ///< of a percent or an input's number
  std::optional<cycle::OperatorAction> action;
  std::string_view sentence;
};
inline constexpr machine::Bounds kInputs{0, 63, false, true};
inline constexpr std::array kActionKeys{
    ActionKey{"override_pct",
              ActionKey::Takes::percent,
              {0, 200},
              cycle::OperatorAction::feed_override,
              "the operator's override"},
    ActionKey{"rapid_override_pct",
              ActionKey::Takes::percent,
              {0, 100},
              cycle::OperatorAction::rapid_override,
              "the operator's override of rapids"},
    ActionKey{"hold", ActionKey::Takes::flag, {}, cycle::OperatorAction::hold, "feed hold"},
    ActionKey{"resume", ActionKey::Takes::flag, {}, cycle::OperatorAction::resume, "goes on after a hold"},
    ActionKey{"spindle_load_pct",
              ActionKey::Takes::percent,
              {0, 1000},
              cycle::OperatorAction::spindle_load,
              "what the spindle carries"},
    ActionKey{"emergency_stop",
              ActionKey::Takes::flag,
              {},
              cycle::OperatorAction::emergency_stop,
              "the run ends where it is"},
    ActionKey{"input", ActionKey::Takes::input, kInputs, std::nullopt, "a digital input of M66 changes"},
    ActionKey{"analog_input", ActionKey::Takes::input, kInputs, std::nullopt,
              "an analog input of M66 changes"},
};
inline constexpr NumberKey kForS{"for_s", kTime, "spindle_load_pct: after this time as before"};
inline constexpr NumberKey kDigitalValue{"value", {0, 1, false, true}, "what the input reads"};
inline constexpr NumberKey kAnalogValue{"value", {-1e9, 1e9}, "what the input reads"};
inline constexpr std::array kActionNumbers{kForS, kDigitalValue};

inline constexpr NumberKey kTimeS{"time_s", kTime, "machine time of the whole run"};
inline constexpr NumberKey kWithin{"within_s", kTime, "allowed difference of time_s"};
inline constexpr std::array kExpectNumbers{kTimeS, kWithin};
inline constexpr machine::PlainKey kStepsHash{"steps_hash", "16 hexadecimal digits", "",
                                              "every pulse: offset and sign, by tick and axis"};
inline constexpr machine::PlainKey kAlarms{"alarms", "{ CODE = count }", "no alarm", "alarms by code"};
inline constexpr machine::PlainKey kDiagnostics{"diagnostics", "[codes]", "none",
                                                "errors and warnings, in order"};
inline constexpr std::array kExpectTexts{kStepsHash, kAlarms, kDiagnostics};

inline constexpr machine::PlainKey kSignalName{"name", "a signal", "required", "what is measured"};
inline constexpr auto kSignalKeys = machine::keys_of(
    machine::key("from_s", &SignalExpectation::from_s, kTime, "control periods that end after this time"),
    machine::key("to_s", &SignalExpectation::to_s, kTime, "up to this time"),
    machine::key("least", &SignalExpectation::least, kAny, "no value is below"),
    machine::key("most", &SignalExpectation::most, kAny, "no value is above"));

inline constexpr auto kBoundaryKeys = machine::keys_of(
    machine::key("block", &BoundaryExpectation::block, kWholeCount, "block that begins, from 0").required(),
    machine::key("control_tick", &BoundaryExpectation::control_tick, kWholeCount,
                 "control period in which it begins")
        .required(),
    machine::key("offset", &BoundaryExpectation::offset, kWholeCount, "base ticks in that control period")
        .required(),
    machine::key("feed_mm_s", &BoundaryExpectation::feed_u_s, kTime, "feed there, to 1e-4").required(),
    machine::key("planned_mm_s", &BoundaryExpectation::planned_u_s, kTime, "planned feed at 100 %, to 1e-4")
        .required(),
    machine::key("deferred_ticks", &BoundaryExpectation::deferred_ticks, kWholeCount,
                 "how long an override has been waiting")
        .required());

inline constexpr NumberKey kPulses{"pulses", kSignedCount, "counted in both directions"};
inline constexpr NumberKey kEndSteps{"end_steps", kSignedCount, "lattice node at the end, from machine zero"};
inline constexpr std::array kAxisCounts{kPulses, kEndSteps};

/// [least, most] of a length in thousandths of the axis unit.
struct RangeKey {
  std::string_view linear, rotary;
  std::optional<ValueRange> AxisExpectation::*member;
  std::string_view sentence;
};
inline constexpr std::array kAxisRanges{
    RangeKey{"vibration_um", "vibration_mdeg", &AxisExpectation::vibration, "peak of the flexible part"},
    RangeKey{"residual_um", "residual_mdeg", &AxisExpectation::residual, "after the worst stop"},
};

}  // namespace kadr::scenario
