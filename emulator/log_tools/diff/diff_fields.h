#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "emulator/log/log_reader.h"
#include "emulator/log_tools/diff/exact_ticks.h"
#include "machine/base/vocabulary.h"

/// What of a log is compared, by the tables of its channels (emulator/log/channels/).
namespace kadr::log_tools {

/// Where a difference is, in the order of comparison within a control tick.
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

/// A field of a channel's table, as a comparison reads it.
template <class Record>
struct LogField {
  std::string
      name;  ///< as in kadr.lcm; outside of KADR_TICKS, of other exact data, with the channel: "KADR_X/y"
  log::FieldUnit unit = log::FieldUnit::none;
  log::FieldValue (*get)(const Record&) = nullptr;
  log::ToleranceKey key = log::ToleranceKey::none;          ///< of a plant state
  std::string_view (*word)(std::int64_t number) = nullptr;  ///< name of a coded number
  std::string signal{};  ///< of exact data that is a signal as it stands: "load.torque_Nm"; else empty
};

/// One control tick of exact data, one axis of it, and one axis of the summary.
struct TickAt {
  const ExactTicks& exact;
  std::size_t index;
};
struct AxisAt {
  const ExactTicks& exact;
  std::size_t axis;
  std::size_t index;
};
struct AxisSummaryAt {
  const log::LogSummary& summary;
  std::size_t axis;
};

/// What one log does not have: a channel that the kadr that wrote it did not know. It is not compared.
inline bool is_absent(const log::FieldValue& of_ticks) {
  return std::holds_alternative<std::string>(of_ticks);
}

std::span<const LogField<TickAt>> tick_fields();
std::span<const LogField<AxisAt>> axis_fields();  ///< with a key: plant states, else commands
std::span<const LogField<log::EventRecord>> event_fields();
std::span<const LogField<log::BlockRecord>> block_fields();
std::span<const LogField<log::LogDiagnostic>> diagnostic_fields();
std::span<const LogField<log::LogSummary>> summary_fields();
std::span<const LogField<AxisSummaryAt>> axis_summary_fields();
/// KADR_STEPS, per axis: "pulses", "offset_ticks", "sign". They have no accessor: pulses are compared one by one.
std::span<const std::string_view> step_fields();

/// Equal to the last bit: 0 and -0 differ, a NaN equals itself.
bool same_value(const log::FieldValue& a, const log::FieldValue& b);
/// Shortest text that reads back as the same value.
std::string value_text(const log::FieldValue& value);
template <class Record>
std::string value_text(const LogField<Record>& field, const log::FieldValue& value) {
  if (field.word != nullptr)
    if (const auto* number = std::get_if<std::int64_t>(&value)) return std::string(field.word(*number));
  return value_text(value);
}
/// "mm", "deg/s" ...; empty if there is none.
/// @param path_unit  unit of path length: "mm", "deg", "mm+deg"
/// @param axis_unit  unit of the field's axis
std::string unit_text(log::FieldUnit unit, const std::string& path_unit, const std::string& axis_unit);
/// Unit of path length by the log's axes: "mm", "deg", or "mm+deg" if it has axes of both kinds.
std::string path_unit(const log::LogHeader& header);

}  // namespace kadr::log_tools
