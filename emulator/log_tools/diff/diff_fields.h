#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "emulator/log/log_reader.h"
#include "machine/base/vocabulary.h"

/// What of a log is compared: one table per kind of record, one line per field.
namespace kadr::emulator {

/// Where a difference stands, in the order of comparison within a control tick.
enum class DiffChannel : std::uint8_t {
  event,       ///< KADR_EVENT
  block,       ///< KADR_BLOCK
  diagnostic,  ///< KADR_DIAG
  command,     ///< KADR_TICKS: feed, path and commanded positions
  steps,       ///< KADR_STEPS
  load,        ///< KADR_TICKS: states of the plant
  summary,     ///< KADR_SUMMARY
};
inline constexpr std::size_t kDiffChannels = 7;
/// "KADR_EVENT"; commands and plant states are both "KADR_TICKS"
std::string_view channel_name(DiffChannel channel);

using FieldValue = std::variant<std::int64_t, double, std::string>;

/// Unit of a field; `_u` is the unit of the path or the axis.
enum class FieldUnit : std::uint8_t { none, path, path_speed, path_accel, axis, axis_speed, force, time };

/// Plant states and feed may have a tolerance: --tolerance KEY=VALUE.
enum class ToleranceKey : std::uint8_t { base, link, base_rate, link_rate, force, feed, none };
inline constexpr std::size_t kToleranceKeys = 6;
inline constexpr Vocabulary<ToleranceKey, kToleranceKeys + 1> kToleranceWords{{
    {ToleranceKey::base, "base"},
    {ToleranceKey::link, "link"},
    {ToleranceKey::base_rate, "base_rate"},
    {ToleranceKey::link_rate, "link_rate"},
    {ToleranceKey::force, "force"},
    {ToleranceKey::feed, "feed"},
    {ToleranceKey::none, ""},
}};
static_assert(kToleranceWords.complete());

template <class Record>
struct LogField {
  std::string_view name;  ///< as in kadr.lcm
  FieldUnit unit = FieldUnit::none;
  FieldValue (*get)(const Record&) = nullptr;
  ToleranceKey key = ToleranceKey::none;                    ///< of a plant state
  std::string_view (*word)(std::int64_t number) = nullptr;  ///< name of a coded number
};

/// One control tick of KADR_TICKS, and one axis of it.
struct TickAt {
  const TickBlock& block;
  std::size_t index;
};
struct AxisAt {
  const AxisTicks& axis;
  std::size_t index;
};

std::span<const LogField<TickAt>> tick_fields();
std::span<const LogField<AxisAt>> axis_fields();  ///< with a key: plant states, else commands
std::span<const LogField<EventRecord>> event_fields();
std::span<const LogField<BlockRecord>> block_fields();
std::span<const LogField<LogDiagnostic>> diagnostic_fields();
std::span<const LogField<RunSummary>> summary_fields();
std::span<const LogField<AxisSummary>> axis_summary_fields();
/// KADR_STEPS, per axis: "pulses", "offset_ticks", "sign". They have no accessor: pulses are compared one by
/// one.
std::span<const std::string_view> step_fields();

/// Equal to the last bit: 0 and -0 differ, a NaN equals itself.
bool same_value(const FieldValue& a, const FieldValue& b);
/// Shortest text that reads back as the same value.
std::string value_text(const FieldValue& value);
template <class Record>
std::string value_text(const LogField<Record>& field, const FieldValue& value) {
  if (field.word != nullptr)
    if (const auto* number = std::get_if<std::int64_t>(&value)) return std::string(field.word(*number));
  return value_text(value);
}
/// "mm", "deg/s" ...; empty if there is none.
/// @param path_unit  unit of path length: "mm", "deg", "mm+deg"
/// @param axis_unit  unit of the field's axis
std::string unit_text(FieldUnit unit, const std::string& path_unit, const std::string& axis_unit);
/// Unit of path length by the log's axes: "mm", "deg", or "mm+deg" if it has axes of both kinds.
std::string path_unit(const LogHeader& header);

}  // namespace kadr::emulator
