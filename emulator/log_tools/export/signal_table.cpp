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

class Table {
 public:
  std::vector<SignalSource> sources;

  void real(const std::string& name, const std::string& unit,
            std::function<double(const TickContext&)> value) {
    sources.push_back({{name + suffix(unit), unit, false, {}}, std::move(value)});
  }
  void whole(const std::string& name, std::function<double(const TickContext&)> value) {
    sources.push_back({{name, "", true, {}}, std::move(value)});
  }
  void code(const std::string& name, std::vector<std::string> words,
            std::function<double(const TickContext&)> value) {
    sources.push_back({{name, "", true, std::move(words)}, std::move(value)});
  }
};

void add_feed(Table& table, const std::string& unit, bool has_override) {
  table.real("feed.commanded", unit + "/s", [](const TickContext& c) { return c.ticks().feed_u_s[c.at()]; });
  table.real("feed.programmed", unit + "/s", [](const TickContext& c) {
    const log::BlockRecord* block = c.frame->block.get();
    return block != nullptr && block->programmed_u_s > 0 ? block->programmed_u_s : kNone;
  });
  table.real("feed.acceleration", unit + "/s2",
             [](const TickContext& c) { return c.ticks().accel_u_s2[c.at()]; });
  table.real("feed.jerk", unit + "/s3", [](const TickContext& c) { return c.feed_jerk_u_s3; });
  table.real("feed.override_used", "%",
             [](const TickContext& c) { return 100 * c.ticks().override_used[c.at()]; });
  if (has_override) {
    table.real("feed.override_requested", "%",
               [](const TickContext& c) { return 100 * c.ticks().override_requested[c.at()]; });
    table.real("feed.limiter", "%", [](const TickContext& c) { return 100 * c.ticks().limiter[c.at()]; });
    table.code("feed.override_note", kOverrideNotes.strings(),
               [](const TickContext& c) { return double(c.ticks().override_note[c.at()]); });
  }
  table.code("feed.limited_by", kLimitedBy.strings(),
             [](const TickContext& c) { return double(c.ticks().limited_by[c.at()]); });
  table.whole("feed.block", [](const TickContext& c) { return double(c.ticks().block[c.at()]); });
  table.whole("feed.line", [](const TickContext& c) {
    return c.frame->block ? static_cast<double>(c.frame->block->span.line) : kNone;
  });
  table.real("path.length", unit, [](const TickContext& c) { return c.ticks().path_u[c.at()]; });
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
  table.real("path.error", "um", [axes](const TickContext& c) {
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

void add_axis(Table& table, const log::LogHeader& header, std::size_t a, bool plant, bool pulses) {
  const log::LogAxis& axis = header.axis[a];
  const std::string name = "axis." + axis.name + ".", &unit = axis.unit;
  const std::string small = unit == "deg" ? "mdeg" : "um";  // thousandths
  table.whole(name + "steps",
              [a](const TickContext& c) { return static_cast<double>(c.ticks().axis[a].steps[c.at()]); });
  table.real(name + "command", unit, [a](const TickContext& c) { return c.axis[a].command_u; });
  table.real(name + "speed", unit + "/s", [a](const TickContext& c) { return c.axis[a].speed_u_s; });
  table.real(name + "acceleration", unit + "/s2", [a](const TickContext& c) { return c.axis[a].accel_u_s2; });
  table.real(name + "jerk", unit + "/s3", [a](const TickContext& c) { return c.axis[a].jerk_u_s3; });
  if (pulses)
    table.real(name + "step_rate", "Hz", [a](const TickContext& c) {
      const StepBatch* batch = c.frame->batch();
      if (batch == nullptr || a >= batch->axis.size()) return kNone;
      return static_cast<double>(batch->axis[a].count()) * static_cast<double>(c.header->base_hz) /
             static_cast<double>(c.header->control_tick_ticks);
    });
  if (!plant || !axis.has_plant) return;
  table.real(name + "load", unit, [a](const TickContext& c) {
    return c.ticks().axis[a].base_u[c.at()] + c.ticks().axis[a].link_u[c.at()];
  });
  table.real(name + "load_rate", unit + "/s", [a](const TickContext& c) {
    return c.ticks().axis[a].base_u_s[c.at()] + c.ticks().axis[a].link_u_s[c.at()];
  });
  table.real(name + "following", small, [a](const TickContext& c) {
    const log::AxisTicks& x = c.ticks().axis[a];
    return 1000 * (x.base_u[c.at()] + x.link_u[c.at()] - x.command_u[c.at()]);
  });
  table.real(name + "vibration", small,
             [a](const TickContext& c) { return 1000 * c.ticks().axis[a].link_u[c.at()]; });
  table.real(name + "motor_force", unit == "deg" ? "N m" : "N",
             [a](const TickContext& c) { return c.ticks().axis[a].motor_force_N[c.at()]; });
}

/// A column of exact data as it stands in the log; no value in control ticks whose log does not have it.
template <class At>
std::function<double(const At&)> number_of(const LogField<At>& field) {
  return [get = field.get](const At& at) {
    const log::FieldValue value = get(at);
    if (const auto* real = std::get_if<double>(&value)) return *real;
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
    return kNone;
  };
}

/// What has no signal above: the columns of other channels, and those appended to KADR_TICKS.
void add_further(Table& table, const log::LogHeader& header, const LogFrame& first) {
  const auto add = [&](std::string name, std::string unit, const log::FieldValue& sample,
                       std::function<double(const TickContext&)> value) {
    if (is_absent(sample)) return;
    const bool whole = std::holds_alternative<std::int64_t>(sample);
    table.sources.push_back({{std::move(name), std::move(unit), whole, {}, true}, std::move(value)});
  };
  for (const auto& field : tick_fields())
    if (!field.signal.empty())
      add(field.signal, unit_text(field.unit, path_unit(header), ""),
          field.get({*first.ticks, first.tick_index}), [number = number_of(field)](const TickContext& c) {
            return number({*c.frame->ticks, c.at()});
          });
  for (std::size_t a = 0; a < header.axis.size(); ++a)
    for (const auto& field : axis_fields())
      if (!field.signal.empty())
        add(fmt::format("axis.{}.{}", header.axis[a].name, field.signal),
            unit_text(field.unit, path_unit(header), header.axis[a].unit),
            field.get({*first.ticks, a, first.tick_index}),
            [a, number = number_of(field)](const TickContext& c) {
              return number({*c.frame->ticks, a, c.at()});
            });
}

}  // namespace

std::vector<SignalSource> signal_table(const log::LogHeader& header, const LogFrame& first) {
  Table table;
  const bool plant = first.ticks->has_plant;
  add_feed(table, path_unit(header), !first.ticks->override_requested.empty());
  if (plant) add_path_error(table, header);
  for (std::size_t a = 0; a < header.axis.size(); ++a) add_axis(table, header, a, plant, header.logs_steps);
  add_further(table, header, first);
  return std::move(table.sources);
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
