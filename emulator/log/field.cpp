#include "emulator/log/field.h"

#include "emulator/log/channels/run.h"
#include "emulator/log/tick_columns.h"

namespace kadr::log {

std::string_view unit_symbol(FieldUnit unit) {
  switch (unit) {
    case FieldUnit::none:
      return "";
    case FieldUnit::path:
    case FieldUnit::axis:
      return "u";
    case FieldUnit::path_speed:
    case FieldUnit::axis_speed:
      return "u/s";
    case FieldUnit::path_accel:
    case FieldUnit::axis_accel:
      return "u/s2";
    case FieldUnit::path_jerk:
    case FieldUnit::axis_jerk:
      return "u/s3";
    case FieldUnit::axis_thousandth:
      return "um or mdeg";
    case FieldUnit::force:
      return "N or N m";
    case FieldUnit::energy:
      return "J";
    case FieldUnit::time:
      return "s";
    case FieldUnit::percent:
      return "%";
  }
  return "";
}

bool allows(CountRule rule, std::int32_t count, const Counts& counts, const LogHeader& header) {
  constexpr std::int32_t kMaxAxes = 64;
  switch (rule) {
    case CountRule::not_a_count:
      return false;
    case CountRule::log_axes:
      return count == static_cast<std::int32_t>(header.axis.size());
    case CountRule::plant_axes:
      return count == 0 || count == counts.of("n_axes");
    case CountRule::axes:
      return count >= 0 && count <= kMaxAxes;
    case CountRule::block_ticks:
      return count >= 1 && count <= kMaxBlockTicks;
    case CountRule::all_ticks:
      return count == 0 || count == counts.of("n");
    case CountRule::any:
      return count >= 0;
  }
  return false;
}

namespace field {

bool take_integer(std::int64_t v, Severity& out) {
  if (v < as_integer(Severity::note) || v > as_integer(Severity::error)) return false;
  out = v == as_integer(Severity::note)    ? Severity::note
        : v == as_integer(Severity::error) ? Severity::error
                                           : Severity::warning;
  return true;
}

double seconds_at(Ticks tick, const LogHeader& header) { return header.seconds(tick); }

}  // namespace field

bool begins_at_its_tick(Ticks begin, ControlTicks first, const LogHeader& header) {
  constexpr std::int64_t kLatest = std::int64_t{1} << 62;
  return first.value >= 0 && first.value <= kLatest / header.control_tick_ticks &&
         begin.value == first.value * header.control_tick_ticks;
}

}  // namespace kadr::log
