#include "emulator/log_tools/diff/diff_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <utility>
#include <vector>

#include "emulator/text/units.h"
#include "machine/base/parse_number.h"

namespace kadr::log_tools {
namespace {

/// Calls f.template operator()<index>(field) for each field of a channel's table.
template <class R, class F>
void each_field(F&& f) {
  const auto call = [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    (f.template operator()<kIndex>(log::Channel<R>::fields[kIndex]), ...);
  };
  call(std::make_index_sequence<log::Channel<R>::fields.size()>());
}

template <class Record>
LogField<Record> log_field(const log::FieldInfo& field, log::FieldValue (*get)(const Record&)) {
  return {std::string(field.name), field.unit, get, field.key, field.word};
}

/// "load.torque_Nm" of KADR_LOAD's torque_Nm
std::string signal_name(std::string_view channel, const log::FieldInfo& field) {
  constexpr std::string_view kPrefix = "KADR_";
  std::string name;
  for (const char c : channel.substr(channel.starts_with(kPrefix) ? kPrefix.size() : 0))
    name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return fmt::format("{}.{}", name, field.name);
}

/// The values of a record; arrays are left out.
template <class R>
std::vector<LogField<R>> scalar_fields() {
  std::vector<LogField<R>> list;
  each_field<R>([&]<std::size_t kIndex>(const log::Field<R>& field) {
    if (!field.compared || field.dimensions() != 0) return;
    list.push_back(
        log_field<R>(field, [](const R& r) { return log::Channel<R>::fields[kIndex].value(r, 0, 0); }));
  });
  return list;
}

/// A column of exact data, of the path or of an axis.
template <class At>
std::vector<LogField<At>> column_fields() {
  constexpr bool kOfAxis = std::is_same_v<At, AxisAt>;
  std::vector<LogField<At>> list;
  log::for_each_channel(log::TickChannels{}, [&]<class R>() {
    each_field<R>([&]<std::size_t kIndex>(const log::Field<R>& field) {
      if (!field.compared || field.dimensions() != (kOfAxis ? 2 : 1)) return;
      const auto get = [](const At& at) -> log::FieldValue {
        const R* block = at.exact.template of<R>();
        if (block == nullptr) return std::string("-");
        if constexpr (std::is_same_v<At, AxisAt>)
          return log::Channel<R>::fields[kIndex].value(*block, at.axis, at.index);
        else
          return log::Channel<R>::fields[kIndex].value(*block, at.index, 0);
      };
      constexpr std::string_view kChannel = log::Channel<R>::info.name;
      LogField<At> column = log_field<At>(field, get);
      if (!std::is_same_v<R, log::TickBlock>) column.name = fmt::format("{}/{}", kChannel, field.name);
      if (field.shown) column.signal = signal_name(kChannel, field);
      list.push_back(std::move(column));
    });
  });
  return list;
}

std::vector<LogField<AxisSummaryAt>> axis_values_of_summary() {
  std::vector<LogField<AxisSummaryAt>> list;
  each_field<log::LogSummary>([&]<std::size_t kIndex>(const log::Field<log::LogSummary>& field) {
    if (!field.compared || field.dimensions() != 1) return;
    list.push_back(log_field<AxisSummaryAt>(field, [](const AxisSummaryAt& at) {
      return log::Channel<log::LogSummary>::fields[kIndex].value(at.summary, at.axis, 0);
    }));
  });
  return list;
}

constexpr std::array<std::string_view, 3> kStepFields = {"pulses", "offset_ticks", "sign"};

}  // namespace

std::span<const LogField<TickAt>> tick_fields() {
  static const auto kFields = column_fields<TickAt>();
  return kFields;
}
std::span<const LogField<AxisAt>> axis_fields() {
  static const auto kFields = column_fields<AxisAt>();
  return kFields;
}
std::span<const LogField<log::EventRecord>> event_fields() {
  static const auto kFields = scalar_fields<log::EventRecord>();
  return kFields;
}
std::span<const LogField<log::BlockRecord>> block_fields() {
  static const auto kFields = scalar_fields<log::BlockRecord>();
  return kFields;
}
std::span<const LogField<log::LogDiagnostic>> diagnostic_fields() {
  static const auto kFields = scalar_fields<log::LogDiagnostic>();
  return kFields;
}
std::span<const LogField<log::LogSummary>> summary_fields() {
  static const auto kFields = scalar_fields<log::LogSummary>();
  return kFields;
}
std::span<const LogField<AxisSummaryAt>> axis_summary_fields() {
  static const auto kFields = axis_values_of_summary();
  return kFields;
}
std::span<const std::string_view> step_fields() { return kStepFields; }

std::string_view channel_name(DiffChannel channel) {
  switch (channel) {
    case DiffChannel::event:
      return log::Channel<log::EventRecord>::info.name;
    case DiffChannel::block:
      return log::Channel<log::BlockRecord>::info.name;
    case DiffChannel::diagnostic:
      return log::Channel<log::LogDiagnostic>::info.name;
    case DiffChannel::command:
    case DiffChannel::load:
      return log::Channel<log::TickBlock>::info.name;
    case DiffChannel::steps:
      return log::Channel<log::PulseBlock>::info.name;
    case DiffChannel::summary:
      return log::Channel<log::LogSummary>::info.name;
  }
  return "";
}

bool same_value(const log::FieldValue& a, const log::FieldValue& b) {
  const double* x = std::get_if<double>(&a);
  const double* y = std::get_if<double>(&b);
  if (x != nullptr && y != nullptr)
    return std::bit_cast<std::uint64_t>(*x) == std::bit_cast<std::uint64_t>(*y);
  return a == b;
}

std::string value_text(const log::FieldValue& value) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) return std::to_string(*number);
  if (const auto* real = std::get_if<double>(&value)) return number_text(*real);
  return std::get<std::string>(value);
}

std::string unit_text(log::FieldUnit unit, const std::string& path_unit, const std::string& axis_unit) {
  switch (unit) {
    case log::FieldUnit::path:
      return path_unit;
    case log::FieldUnit::path_speed:
      return text::speed_unit(path_unit);
    case log::FieldUnit::path_accel:
      return path_unit == "mm+deg" ? "mm/s2 or deg/s2" : path_unit + "/s2";
    case log::FieldUnit::path_jerk:
      return path_unit == "mm+deg" ? "mm/s3 or deg/s3" : path_unit + "/s3";
    case log::FieldUnit::axis:
      return axis_unit;
    case log::FieldUnit::axis_speed:
      return axis_unit + "/s";
    case log::FieldUnit::axis_accel:
      return axis_unit + "/s2";
    case log::FieldUnit::axis_jerk:
      return axis_unit + "/s3";
    case log::FieldUnit::axis_thousandth:
      return axis_unit == "deg" ? "mdeg" : "um";
    case log::FieldUnit::force:
      return axis_unit == "deg" ? "N m" : "N";
    case log::FieldUnit::none:
    case log::FieldUnit::energy:
    case log::FieldUnit::time:
    case log::FieldUnit::percent:
      break;
  }
  return std::string(log::unit_symbol(unit));
}

std::string path_unit(const log::LogHeader& header) {
  const auto rotary = [](const log::LogAxis& axis) { return axis.unit == "deg"; };
  const bool any = std::any_of(header.axis.begin(), header.axis.end(), rotary);
  const bool all = std::all_of(header.axis.begin(), header.axis.end(), rotary);
  return !any ? "mm" : all ? "deg" : "mm+deg";
}

}  // namespace kadr::log_tools
