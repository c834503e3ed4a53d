#include "emulator/log_tools/diff/diff_fields.h"

#include <algorithm>
#include <array>
#include <bit>

#include "emulator/text/units.h"
#include "machine/base/codes.h"
#include "machine/base/parse_number.h"
#include "machine/tick_motion.h"

namespace kadr::emulator {
namespace {

using Unit = FieldUnit;
using Key = ToleranceKey;

std::int64_t whole(std::int64_t v) { return v; }

std::string_view limit_word(std::int64_t number) {
  const auto reason = kLimitedBy.at(number);
  return reason ? kLimitedBy.word(*reason) : "unknown";
}

// a new field of KADR_TICKS is one line here, in tick_fields or in axis_fields
constexpr std::array kTickFields = {
    LogField<TickAt>{"feed_u_s", Unit::path_speed,
                     [](const TickAt& t) -> FieldValue { return t.block.feed_u_s[t.index]; }},
    LogField<TickAt>{"accel_u_s2", Unit::path_accel,
                     [](const TickAt& t) -> FieldValue { return t.block.accel_u_s2[t.index]; }},
    LogField<TickAt>{"path_u", Unit::path,
                     [](const TickAt& t) -> FieldValue { return t.block.path_u[t.index]; }},
    LogField<TickAt>{"override_used", Unit::none,
                     [](const TickAt& t) -> FieldValue { return t.block.override_used[t.index]; }},
    LogField<TickAt>{"override_requested", Unit::none,
                     [](const TickAt& t) -> FieldValue { return t.block.override_requested[t.index]; }},
    LogField<TickAt>{"limiter", Unit::none,
                     [](const TickAt& t) -> FieldValue { return t.block.limiter[t.index]; }},
    LogField<TickAt>{"override_note", Unit::none,
                     [](const TickAt& t) -> FieldValue { return whole(t.block.override_note[t.index]); }},
    LogField<TickAt>{"limited_by", Unit::none,
                     [](const TickAt& t) -> FieldValue { return whole(t.block.limited_by[t.index]); },
                     Key::none, limit_word},
    LogField<TickAt>{"limiting_axis", Unit::none,
                     [](const TickAt& t) -> FieldValue { return whole(t.block.limiting_axis[t.index]); }},
    LogField<TickAt>{"block", Unit::none,
                     [](const TickAt& t) -> FieldValue { return whole(t.block.block[t.index]); }},
};

constexpr std::array kAxisFields = {
    LogField<AxisAt>{"steps", Unit::none,
                     [](const AxisAt& t) -> FieldValue { return t.axis.steps[t.index]; }},
    LogField<AxisAt>{"command_u", Unit::axis,
                     [](const AxisAt& t) -> FieldValue { return t.axis.command_u[t.index]; }},
    LogField<AxisAt>{"base_u", Unit::axis,
                     [](const AxisAt& t) -> FieldValue { return t.axis.base_u[t.index]; }, Key::base},
    LogField<AxisAt>{"base_u_s", Unit::axis_speed,
                     [](const AxisAt& t) -> FieldValue { return t.axis.base_u_s[t.index]; }, Key::base_rate},
    LogField<AxisAt>{"link_u", Unit::axis,
                     [](const AxisAt& t) -> FieldValue { return t.axis.link_u[t.index]; }, Key::link},
    LogField<AxisAt>{"link_u_s", Unit::axis_speed,
                     [](const AxisAt& t) -> FieldValue { return t.axis.link_u_s[t.index]; }, Key::link_rate},
    LogField<AxisAt>{"motor_force", Unit::force,
                     [](const AxisAt& t) -> FieldValue { return t.axis.motor_force_N[t.index]; }, Key::force},
};

constexpr std::array kEventFields = {
    LogField<EventRecord>{"tick", Unit::none,
                          [](const EventRecord& e) -> FieldValue { return e.tick.value; }},
    LogField<EventRecord>{"kind", Unit::none,
                          [](const EventRecord& e) -> FieldValue { return e.kind.text(); }},
    LogField<EventRecord>{
        "code", Unit::none,
        [](const EventRecord& e) -> FieldValue { return e.code == Code{} ? "" : code_name(e.code); }},
    LogField<EventRecord>{"block", Unit::none,
                          [](const EventRecord& e) -> FieldValue { return whole(e.block); }},
    LogField<EventRecord>{"source_line", Unit::none,
                          [](const EventRecord& e) -> FieldValue { return whole(e.span.line); }},
    LogField<EventRecord>{"source_column", Unit::none,
                          [](const EventRecord& e) -> FieldValue { return whole(e.span.column); }},
    LogField<EventRecord>{"axis", Unit::none,
                          [](const EventRecord& e) -> FieldValue { return whole(e.axis); }},
    LogField<EventRecord>{"value", Unit::none, [](const EventRecord& e) -> FieldValue { return e.value; }},
    LogField<EventRecord>{"limit", Unit::none, [](const EventRecord& e) -> FieldValue { return e.limit; }},
    LogField<EventRecord>{"text", Unit::none, [](const EventRecord& e) -> FieldValue { return e.text; }},
};

constexpr std::array kBlockFields = {
    LogField<BlockRecord>{"tick", Unit::none,
                          [](const BlockRecord& b) -> FieldValue { return b.tick.value; }},
    LogField<BlockRecord>{"block", Unit::none,
                          [](const BlockRecord& b) -> FieldValue { return whole(b.block); }},
    LogField<BlockRecord>{"source_line", Unit::none,
                          [](const BlockRecord& b) -> FieldValue { return whole(b.span.line); }},
    LogField<BlockRecord>{"source_column", Unit::none,
                          [](const BlockRecord& b) -> FieldValue { return whole(b.span.column); }},
    LogField<BlockRecord>{"source_text", Unit::none,
                          [](const BlockRecord& b) -> FieldValue { return b.text; }},
    LogField<BlockRecord>{"motion", Unit::none, [](const BlockRecord& b) -> FieldValue { return b.motion; }},
    LogField<BlockRecord>{"length_u", Unit::path,
                          [](const BlockRecord& b) -> FieldValue { return b.length_u; }},
    LogField<BlockRecord>{"programmed_u_s", Unit::path_speed,
                          [](const BlockRecord& b) -> FieldValue { return b.programmed_u_s; }},
    LogField<BlockRecord>{"planned_peak_u_s", Unit::path_speed,
                          [](const BlockRecord& b) -> FieldValue { return b.planned_peak_u_s; }},
    LogField<BlockRecord>{"planned_end_u_s", Unit::path_speed,
                          [](const BlockRecord& b) -> FieldValue { return b.planned_end_u_s; }},
    LogField<BlockRecord>{"planned_s", Unit::time,
                          [](const BlockRecord& b) -> FieldValue { return b.planned_s; }},
    LogField<BlockRecord>{"limited_by", Unit::none,
                          [](const BlockRecord& b) -> FieldValue { return b.limited_by; }},
    LogField<BlockRecord>{"entry_u_s", Unit::path_speed,
                          [](const BlockRecord& b) -> FieldValue { return b.entry_u_s; }},
    LogField<BlockRecord>{"planned_entry_u_s", Unit::path_speed,
                          [](const BlockRecord& b) -> FieldValue { return b.planned_entry_u_s; }},
    LogField<BlockRecord>{"deferred_ticks", Unit::none,
                          [](const BlockRecord& b) -> FieldValue { return b.deferred_ticks.value; }},
};

constexpr std::array kDiagnosticFields = {
    LogField<LogDiagnostic>{"tick", Unit::none,
                            [](const LogDiagnostic& d) -> FieldValue { return d.tick.value; }},
    LogField<LogDiagnostic>{
        "severity", Unit::none,
        [](const LogDiagnostic& d) -> FieldValue { return whole(static_cast<int>(d.severity) + 1); }},
    LogField<LogDiagnostic>{"code", Unit::none, [](const LogDiagnostic& d) -> FieldValue { return d.code; }},
    LogField<LogDiagnostic>{"source_line", Unit::none,
                            [](const LogDiagnostic& d) -> FieldValue { return whole(d.span.line); }},
    LogField<LogDiagnostic>{"source_column", Unit::none,
                            [](const LogDiagnostic& d) -> FieldValue { return whole(d.span.column); }},
    LogField<LogDiagnostic>{"text", Unit::none,
                            [](const LogDiagnostic& d) -> FieldValue { return d.message; }},
    LogField<LogDiagnostic>{"label", Unit::none,
                            [](const LogDiagnostic& d) -> FieldValue { return d.label; }},
    LogField<LogDiagnostic>{"help", Unit::none, [](const LogDiagnostic& d) -> FieldValue { return d.help; }},
};

// peaks and means follow from the ticks: they are not compared again
constexpr std::array kSummaryFields = {
    LogField<RunSummary>{"outcome", Unit::none,
                         [](const RunSummary& s) -> FieldValue { return s.outcome.text(); }},
    LogField<RunSummary>{"tick", Unit::none, [](const RunSummary& s) -> FieldValue { return s.ticks.value; }},
    LogField<RunSummary>{"blocks", Unit::none,
                         [](const RunSummary& s) -> FieldValue { return whole(s.blocks); }},
    LogField<RunSummary>{"path_u", Unit::path, [](const RunSummary& s) -> FieldValue { return s.path_u; }},
    LogField<RunSummary>{"pulses", Unit::none, [](const RunSummary& s) -> FieldValue { return s.pulses; }},
    LogField<RunSummary>{
        "n_alarms", Unit::none,
        [](const RunSummary& s) -> FieldValue { return static_cast<std::int64_t>(s.alarms); }},
    LogField<RunSummary>{
        "n_warnings", Unit::none,
        [](const RunSummary& s) -> FieldValue { return static_cast<std::int64_t>(s.warnings); }},
    LogField<RunSummary>{"exit_code", Unit::none,
                         [](const RunSummary& s) -> FieldValue { return whole(s.exit_code); }},
};

constexpr std::array kAxisSummaryFields = {
    LogField<AxisSummary>{"axis_pulses", Unit::none,
                          [](const AxisSummary& a) -> FieldValue { return a.pulses; }},
    LogField<AxisSummary>{"net_steps", Unit::none,
                          [](const AxisSummary& a) -> FieldValue { return a.net_steps.value; }},
    LogField<AxisSummary>{"end_steps", Unit::none,
                          [](const AxisSummary& a) -> FieldValue { return a.end_steps.value; }},
    LogField<AxisSummary>{"end_u", Unit::axis, [](const AxisSummary& a) -> FieldValue { return a.end_u; }},
    LogField<AxisSummary>{"lost_steps", Unit::none,
                          [](const AxisSummary& a) -> FieldValue { return a.lost_steps.value; }},
};

constexpr std::array<std::string_view, 3> kStepFields = {"pulses", "offset_ticks", "sign"};

}  // namespace

std::span<const LogField<TickAt>> tick_fields() { return kTickFields; }
std::span<const LogField<AxisAt>> axis_fields() { return kAxisFields; }
std::span<const LogField<EventRecord>> event_fields() { return kEventFields; }
std::span<const LogField<BlockRecord>> block_fields() { return kBlockFields; }
std::span<const LogField<LogDiagnostic>> diagnostic_fields() { return kDiagnosticFields; }
std::span<const LogField<RunSummary>> summary_fields() { return kSummaryFields; }
std::span<const LogField<AxisSummary>> axis_summary_fields() { return kAxisSummaryFields; }
std::span<const std::string_view> step_fields() { return kStepFields; }

std::string_view channel_name(DiffChannel channel) {
  switch (channel) {
    case DiffChannel::event:
      return kEventChannel;
    case DiffChannel::block:
      return kBlockChannel;
    case DiffChannel::diagnostic:
      return kDiagChannel;
    case DiffChannel::command:
    case DiffChannel::load:
      return kTicksChannel;
    case DiffChannel::steps:
      return kStepsChannel;
    case DiffChannel::summary:
      return kSummaryChannel;
  }
  return "";
}

bool same_value(const FieldValue& a, const FieldValue& b) {
  const double* x = std::get_if<double>(&a);
  const double* y = std::get_if<double>(&b);
  if (x != nullptr && y != nullptr)
    return std::bit_cast<std::uint64_t>(*x) == std::bit_cast<std::uint64_t>(*y);
  return a == b;
}

std::string value_text(const FieldValue& value) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) return std::to_string(*number);
  if (const auto* real = std::get_if<double>(&value)) return number_text(*real);
  return std::get<std::string>(value);
}

std::string unit_text(FieldUnit unit, const std::string& path_unit, const std::string& axis_unit) {
  switch (unit) {
    case FieldUnit::none:
      return "";
    case FieldUnit::path:
      return path_unit;
    case FieldUnit::path_speed:
      return speed_unit(path_unit);
    case FieldUnit::path_accel:
      return path_unit == "mm+deg" ? "mm/s2 or deg/s2" : path_unit + "/s2";
    case FieldUnit::axis:
      return axis_unit;
    case FieldUnit::axis_speed:
      return axis_unit + "/s";
    case FieldUnit::force:
      return axis_unit == "deg" ? "N m" : "N";
    case FieldUnit::time:
      return "s";
  }
  return "";
}

std::string path_unit(const LogHeader& header) {
  const auto rotary = [](const LogAxis& axis) { return axis.unit == "deg"; };
  const bool any = std::any_of(header.axis.begin(), header.axis.end(), rotary);
  const bool all = std::all_of(header.axis.begin(), header.axis.end(), rotary);
  return !any ? "mm" : all ? "deg" : "mm+deg";
}

}  // namespace kadr::emulator
