#include "emulator/log_tools/export/signal_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "emulator/log_tools/diff/diff_fields.h"
#include "machine/tick_motion.h"

namespace kadr::log_tools {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// "mm/s2" as the end of a name: "_mm_s2".
std::string suffix(const std::string& unit) {
  std::string out = "_" + unit;
  std::replace(out.begin(), out.end(), '/', '_');
  std::replace(out.begin(), out.end(), '+', '_');
  if (unit == "%") return "_pct";
  if (unit == "Hz") return "_hz";
  if (unit == "N m") return "_N_m";
  return out;
}

/// Unit of a signal, as its name and its column have it.
std::string signal_unit(log::FieldUnit unit, const std::string& of_path, const std::string& of_axis) {
  if (unit == log::FieldUnit::path_speed) return of_path + "/s";
  if (unit == log::FieldUnit::path_accel) return of_path + "/s2";
  if (unit == log::FieldUnit::path_jerk) return of_path + "/s3";
  return unit_text(unit, of_path, of_axis);
}

/// Signals in the order of exports: columns as they come, what is made of them behind them.
class Table {
 public:
  /// @param name    "feed.commanded"; the unit is added
  /// @param behind  the column that it belongs to; empty: it is one
  void real(const std::string& name, const std::string& unit, std::string_view behind,
            std::function<double(const TickContext&)> value) {
    insert({{name + suffix(unit), unit, false, {}}, std::move(value)}, behind.empty() ? name : behind);
  }
  void whole(const std::string& name, std::string_view behind,
             std::function<double(const TickContext&)> value) {
    insert({{name, "", true, {}}, std::move(value)}, behind.empty() ? name : behind);
  }
  void code(const std::string& name, std::vector<std::string> words, std::string_view behind,
            std::function<double(const TickContext&)> value) {
    insert({{name, "", true, std::move(words)}, std::move(value)}, behind.empty() ? name : behind);
  }
  void append_to(std::vector<SignalSource>& list) {
    for (Entry& entry : entries_) list.push_back(std::move(entry.source));
  }

 private:
  struct Entry {
    SignalSource source;
    std::string column;
  };
  void insert(SignalSource source, std::string_view column) {
    const auto last = std::find_if(entries_.rbegin(), entries_.rend(),
                                   [&](const Entry& entry) { return entry.column == column; });
    entries_.insert(last == entries_.rend() ? entries_.end() : last.base(),
                    {std::move(source), std::string(column)});
  }

  std::vector<Entry> entries_;
};

/// A value of a column at a control tick; none in control ticks whose log does not have it.
template <class R, std::size_t kIndex>
double column_value(const ExactTicks& exact, std::size_t row, std::size_t column) {
  static constexpr const log::Field<R>& kField = log::Channel<R>::fields[kIndex];
  const R* block = exact.of<R>();
  if (block == nullptr || !kField.has(*block, row, column)) return kNone;
  return kField.signal.factor * kField.number(*block, row, column);
}

/// Whether a column is a signal of this log.
template <class R>
bool is_signal(const log::Field<R>& field, std::size_t dimensions, const ExactTicks& exact, std::size_t row,
               std::size_t column) {
  if (!field.signal.shown || field.number == nullptr || field.dimensions() != dimensions) return false;
  const R* block = exact.of<R>();
  return block != nullptr && field.has(*block, row, column);
}

/// Of a plant's column: an axis without plant has none, whatever the log holds for it.
bool is_of_plant(const log::FieldInfo& field) {
  const auto count =
      std::find_if(log::Channel<log::TickBlock>::fields.begin(), log::Channel<log::TickBlock>::fields.end(),
                   [&](const log::FieldInfo& each) { return each.name == field.extent[0]; });
  return count != log::Channel<log::TickBlock>::fields.end() && count->count == log::CountRule::plant_axes;
}

bool is_whole(const log::FieldInfo& field) { return field.wire != log::Wire::real; }

/// One column of KADR_TICKS under the name that its field gives it.
void add_column(Table& table, const log::FieldInfo& field, const std::string& before_name,
                const std::string& unit, std::function<double(const TickContext&)> value) {
  const std::string name = before_name + std::string(field.signal.name);
  const std::string behind =
      field.signal.behind.empty() ? "" : before_name + std::string(field.signal.behind);
  if (field.signal.words != nullptr)
    table.code(name, field.signal.words(), behind, std::move(value));
  else if (is_whole(field))
    table.whole(name, behind, std::move(value));
  else
    table.real(name, unit, behind, std::move(value));
}

void add_feed(Table& table, const log::LogHeader& header, const LogFrame& first) {
  const std::string unit = path_unit(header);
  log::for_each_field<log::TickBlock>([&]<std::size_t kIndex>(const log::Field<log::TickBlock>& field) {
    if (field.signal.name.empty() || !is_signal(field, 1, *first.ticks, first.tick_index, 0)) return;
    add_column(table, field, "", signal_unit(field.signal.unit, unit, ""), [](const TickContext& c) {
      return column_value<log::TickBlock, kIndex>(*c.frame->ticks, c.at(), 0);
    });
  });
  table.real("feed.programmed", unit + "/s", "feed.commanded", [](const TickContext& c) {
    const log::BlockRecord* block = c.frame->block.get();
    return block != nullptr && block->programmed_u_s > 0 ? block->programmed_u_s : kNone;
  });
  table.real("feed.jerk", unit + "/s3", "feed.acceleration",
             [](const TickContext& c) { return c.feed_jerk_u_s3; });
  table.whole("feed.line", "feed.block", [](const TickContext& c) {
    return c.frame->block ? static_cast<double>(c.frame->block->span.line) : kNone;
  });
}

/// Distance of the tool from the command over the axes X Y Z, across the motion of the control tick: what lies
/// along it is delay, not a wrong contour. At rest all of it.
void add_path_error(Table& table, const log::LogHeader& header) {
  std::vector<std::size_t> axes;
  for (std::size_t a = 0; a < header.axis.size(); ++a)
    if (header.axis[a].has_plant && header.axis[a].unit == "mm" &&
        (header.axis[a].name == "X" || header.axis[a].name == "Y" || header.axis[a].name == "Z"))
      axes.push_back(a);
  if (axes.empty()) return;
  table.real("path.error", "um", "path.length", [axes](const TickContext& c) {
    double sum = 0, along = 0, way = 0;
    for (const std::size_t a : axes) {
      const log::AxisTicks& axis = c.ticks().axis[a];
      const double off = axis.base_u[c.at()] + axis.link_u[c.at()] - axis.command_u[c.at()];
      const double speed = c.axis[a].speed_u_s;
      sum += off * off;
      along += off * speed;
      way += speed * speed;
    }
    if (way > 0 && c.ticks().feed_u_s[c.at()] > 0) sum = std::max(0.0, sum - along * along / way);
    return 1000 * std::sqrt(sum);
  });
}

/// What the positions of successive control ticks and the plant's states say together.
void add_motion(Table& table, const log::LogHeader& header, std::size_t a) {
  const log::LogAxis& axis = header.axis[a];
  const std::string name = "axis." + axis.name + ".", &unit = axis.unit, column = name + "command";
  table.real(name + "speed", unit + "/s", column, [a](const TickContext& c) { return c.axis[a].speed_u_s; });
  table.real(name + "acceleration", unit + "/s2", column,
             [a](const TickContext& c) { return c.axis[a].accel_u_s2; });
  table.real(name + "jerk", unit + "/s3", column, [a](const TickContext& c) { return c.axis[a].jerk_u_s3; });
  if (!header.logs_steps) return;
  table.real(name + "step_rate", "Hz", column, [a](const TickContext& c) {
    const StepBatch* batch = c.frame->batch();
    if (batch == nullptr || a >= batch->axis.size()) return kNone;
    return static_cast<double>(batch->axis[a].count()) * static_cast<double>(c.header->base_hz) /
           static_cast<double>(c.header->control_tick_ticks);
  });
}

void add_load(Table& table, const log::LogAxis& axis, std::size_t a) {
  const std::string name = "axis." + axis.name + ".", &unit = axis.unit, column = name + "command";
  table.real(name + "load", unit, column, [a](const TickContext& c) {
    return c.ticks().axis[a].base_u[c.at()] + c.ticks().axis[a].link_u[c.at()];
  });
  table.real(name + "load_rate", unit + "/s", column, [a](const TickContext& c) {
    return c.ticks().axis[a].base_u_s[c.at()] + c.ticks().axis[a].link_u_s[c.at()];
  });
  table.real(name + "following", signal_unit(log::FieldUnit::axis_thousandth, "", unit), column,
             [a](const TickContext& c) {
               const log::AxisTicks& x = c.ticks().axis[a];
               return 1000 * (x.base_u[c.at()] + x.link_u[c.at()] - x.command_u[c.at()]);
             });
}

void add_axis(Table& table, const log::LogHeader& header, const LogFrame& first, std::size_t a) {
  const log::LogAxis& axis = header.axis[a];
  log::for_each_field<log::TickBlock>([&]<std::size_t kIndex>(const log::Field<log::TickBlock>& field) {
    if (field.signal.name.empty() || !is_signal(field, 2, *first.ticks, a, first.tick_index)) return;
    if (is_of_plant(field) && !axis.has_plant) return;
    add_column(table, field, "axis." + axis.name + ".",
               signal_unit(field.signal.unit, path_unit(header), axis.unit), [a](const TickContext& c) {
                 return column_value<log::TickBlock, kIndex>(*c.frame->ticks, a, c.at());
               });
  });
  add_motion(table, header, a);
  if (first.ticks->has_plant && axis.has_plant) add_load(table, axis, a);
}

/// "load.torque_Nm" of KADR_LOAD's torque_Nm
std::string own_name(std::string_view channel, const log::FieldInfo& field) {
  constexpr std::string_view kPrefix = "KADR_";
  std::string name;
  for (const char c : channel.substr(channel.starts_with(kPrefix) ? kPrefix.size() : 0))
    name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return fmt::format("{}.{}", name, field.name);
}

/// Columns without a name of their own: those of other channels, and those appended to KADR_TICKS.
void add_further(std::vector<SignalSource>& list, const log::LogHeader& header, const LogFrame& first) {
  const auto each = [&](std::size_t dimensions, std::size_t a) {
    const bool of_axis = dimensions == 2;
    const std::size_t row = of_axis ? a : first.tick_index, column = of_axis ? first.tick_index : 0;
    log::for_each_channel(log::TickChannels{}, [&]<class R>() {
      log::for_each_field<R>([&]<std::size_t kIndex>(const log::Field<R>& field) {
        if (!field.signal.name.empty() || !is_signal(field, dimensions, *first.ticks, row, column)) return;
        std::string name = own_name(log::Channel<R>::info.name, field);
        if (of_axis) name = fmt::format("axis.{}.{}", header.axis[a].name, name);
        list.push_back({{std::move(name),
                         signal_unit(field.unit, path_unit(header), of_axis ? header.axis[a].unit : ""),
                         is_whole(field),
                         {},
                         true},
                        [of_axis, a](const TickContext& c) {
                          return of_axis ? column_value<R, kIndex>(*c.frame->ticks, a, c.at())
                                         : column_value<R, kIndex>(*c.frame->ticks, c.at(), 0);
                        }});
      });
    });
  };
  each(1, 0);
  for (std::size_t a = 0; a < header.axis.size(); ++a) each(2, a);
}

}  // namespace

std::vector<SignalSource> signal_table(const log::LogHeader& header, const LogFrame& first) {
  Table path;
  add_feed(path, header, first);
  if (first.ticks->has_plant) add_path_error(path, header);
  std::vector<SignalSource> list;
  path.append_to(list);
  // the feed comes before the way
  std::stable_partition(list.begin(), list.end(),
                        [](const SignalSource& each) { return each.signal.name.starts_with("feed."); });
  for (std::size_t a = 0; a < header.axis.size(); ++a) {
    Table axis;
    add_axis(axis, header, first, a);
    axis.append_to(list);
  }
  add_further(list, header, first);
  return list;
}

void advance(TickContext& c, const LogFrame& frame, double tau_s) {
  const bool first = c.frame == nullptr;
  if (first) {
    c.axis.resize(c.header->axis.size());
    for (std::size_t a = 0; a < c.axis.size(); ++a) c.axis[a].command_u = c.header->axis[a].home_u;
  }
  const std::size_t i = frame.tick_index;
  const double accel_before = first || c.frame->ticks == nullptr ? 0 : c.ticks().accel_u_s2[c.at()];
  c.frame = &frame;
  c.feed_jerk_u_s3 = (frame.ticks->accel_u_s2[i] - accel_before) / tau_s;
  for (std::size_t a = 0; a < c.axis.size(); ++a) {
    CommandedAxis& m = c.axis[a];
    const double command_u = frame.ticks->axis[a].command_u[i];
    const double speed = (command_u - m.command_u) / tau_s, accel = (speed - m.speed_u_s) / tau_s;
    m = {command_u, speed, accel, (accel - m.accel_u_s2) / tau_s};
  }
}

}  // namespace kadr::log_tools
