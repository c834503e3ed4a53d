#include "emulator/answers/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/text/text.h"
#include "emulator/text/units.h"
#include "machine/base/hash.h"
#include "machine/base/terminal_text.h"
#include "machine/machine.h"

namespace kadr::answers {
namespace {

constexpr std::size_t kSummaryWidth = 90;
constexpr std::size_t kHeadWidth = 15;
constexpr std::size_t kAlarmsShown = 10;

using Align = text::TextTable::Align;

std::string head(std::string_view name, const std::string& text) {
  return text::pad_right(name, kHeadWidth) + ' ' + text + '\n';
}

/// A small length: um for a linear, thousandths of a degree for a rotary axis.
std::string error_number(double value_u) {
  const double value = value_u * 1000;
  const double size = std::fabs(value);
  return text::fixed(value, size >= 99.95 ? 1 : size >= 9.995 ? 2 : 3);
}
const char* error_unit(const machine::AxisModel& axis) {
  return axis.kind == machine::AxisKind::rotary ? "mdeg" : "um";
}
std::string error_pair(double first_u, double second_u, const machine::AxisModel& axis) {
  return fmt::format("{} / {} {}", error_number(first_u), error_number(second_u), error_unit(axis));
}

double seconds(Ticks ticks, const machine::MachineModel& model) {
  return static_cast<double>(ticks.value) / static_cast<double>(model.clock.base_hz);
}

std::string title(const log::RunSummary& s, const SummaryContext& c) {
  std::string left = fmt::format("{} on {}", text::one_line(c.program, 60), text::one_line(c.machine, 60));
  if (!c.scenario.empty()) left += ", scenario " + text::one_line(c.scenario, 60);
  std::string right = s.outcome.text();
  if (c.program_warnings > 0)
    right += ", " + text::counted(static_cast<std::int64_t>(c.program_warnings), "warning");
  if (s.alarms > 0) right += ", " + text::counted(static_cast<std::int64_t>(s.alarms), "alarm");
  const std::size_t used = text::display_width(left) + text::display_width(right);
  return left + std::string(used + 2 < kSummaryWidth ? kSummaryWidth - used : 2, ' ') + right + '\n' +
         std::string(kSummaryWidth, '-') + '\n';
}

std::string motion_table(const log::RunSummary& s, const SummaryContext& c) {
  text::TextTable table(
      {{"axis", Align::left}, {"steps"}, {"net"}, {"end"}, {"range"}, {"peak feed"}, {"at"}});
  for (std::size_t a = 0; a < s.axis.size(); ++a) {
    const log::AxisSummary& x = s.axis[a];
    const machine::AxisModel& axis = c.model->axis[a];
    const char* unit = text::axis_unit(axis);
    std::vector<std::string> row = {std::string("  ") + axis.letter,
                                    text::grouped(x.pulses),
                                    text::grouped_signed(x.net_steps.value),
                                    fmt::format("{} {}", text::fixed(x.end_u, 3), unit),
                                    fmt::format("{} .. {}", text::fixed(x.min_u, 3), text::fixed(x.max_u, 3)),
                                    fmt::format("{} {}/s", text::fixed(x.peak_feed_u_s, 3), unit)};
    if (x.peak_feed_u_s > 0) row.push_back(text::fixed(seconds(x.peak_feed_tick, *c.model), 3) + " s");
    while (row.size() < 7) row.emplace_back();
    table.add(std::move(row));
  }
  return table.render();
}

std::string acceleration_table(const log::RunSummary& s, const SummaryContext& c) {
  text::TextTable table(
      {{"axis", Align::left}, {"acceleration"}, {"of"}, {"jerk"}, {"of"}, {"", Align::left}});
  for (std::size_t a = 0; a < s.axis.size(); ++a) {
    const log::AxisSummary& x = s.axis[a];
    const machine::AxisModel& axis = c.model->axis[a];
    const char* unit = text::axis_unit(axis);
    table.add({std::string("  ") + axis.letter, text::fixed(x.peak_accel_u_s2, 1),
               text::fixed(axis.max_accel_u_s2, 1), text::fixed(x.peak_jerk_u_s3, 0),
               text::fixed(axis.max_jerk_u_s3, 0), fmt::format("{0}/s2, {0}/s3", unit)});
  }
  return table.render();
}

std::string load_table(const log::RunSummary& s, const SummaryContext& c) {
  text::TextTable table({{"load (simulated)", Align::left},
                         {"vibration peak / rms"},
                         {"at"},
                         {"", Align::left},
                         {"residual"},
                         {"following peak / rms"},
                         {"lost steps"}});
  for (std::size_t a = 0; a < s.axis.size(); ++a) {
    const log::AxisSummary& x = s.axis[a];
    const machine::AxisModel& axis = c.model->axis[a];
    const std::string name = std::string("  ") + axis.letter;
    if (!axis.has_plant) {
      table.add({name + "   rigid (not modelled)"});
      continue;
    }
    const bool moved = x.peak_vibration_u > 0;
    table.add({name, error_pair(x.peak_vibration_u, x.rms_vibration_u, axis),
               moved ? text::fixed(seconds(x.peak_vibration_tick, *c.model), 3) + " s" : "",
               moved && x.peak_vibration_line > 0 ? fmt::format("line {}", x.peak_vibration_line) : "",
               fmt::format("{} {}", error_number(x.residual_u), error_unit(axis)),
               error_pair(x.peak_following_u, x.rms_following_u, axis), text::grouped(x.lost_steps.value)});
  }
  return table.render();
}

/// Work of the motors; empty without log.energy.
std::string energy_table(const log::RunSummary& s, const SummaryContext& c) {
  if (!c.plant || !c.model->log.energy) return "";
  text::TextTable table(
      {{"energy of motors", Align::left}, {"positive J"}, {"absolute J"}, {"recuperated J"}});
  for (std::size_t a = 0; a < s.axis.size(); ++a) {
    if (!c.model->axis[a].has_plant) continue;
    const log::AxisSummary& x = s.axis[a];
    table.add({std::string("  ") + c.model->axis[a].letter, text::fixed(x.positive_J, 4),
               text::fixed(x.positive_J + x.recuperated_J, 4), text::fixed(x.recuperated_J, 4)});
  }
  return table.render();
}

std::string alarm_lines(const log::RunSummary& s, const SummaryContext& c) {
  if (s.alarms == 0) return head("alarms", "none");
  std::string out = head("alarms", text::grouped(static_cast<std::int64_t>(s.alarms)));
  for (const auto& [code, count] : c.alarm_counts)
    out += head(
        "", fmt::format("{} {}, {}", code_name(code), code_entry(code).title,
                        count == 1 ? "once" : text::grouped(static_cast<std::int64_t>(count)) + " times"));
  text::TextTable table({{"at"}, {"line"}, {"code", Align::left}, {"what", Align::left}});
  for (std::size_t i = 0; i < std::min(c.alarms.size(), kAlarmsShown); ++i) {
    const log::EventRecord& e = c.alarms[i];
    table.add({text::fixed(seconds(e.tick, *c.model), 3) + " s",
               e.span.line > 0 ? std::to_string(e.span.line) : "-", code_name(e.code),
               text::one_line(e.text, 200)});
  }
  if (!table.empty()) out += table.render("  ");
  if (s.alarms > kAlarmsShown && !c.alarms.empty())
    out += fmt::format(
        "  ... {} more, all in the log\n",
        text::grouped(static_cast<std::int64_t>(s.alarms - std::min(c.alarms.size(), kAlarmsShown))));
  return out;
}

}  // namespace

std::string render_limits(const std::vector<log::LimitShare>& shares) {
  double total_s = 0;
  for (const log::LimitShare& share : shares) total_s += share.time_s;
  if (!(total_s > 0)) return {};
  std::string text;
  std::size_t column = 0;
  double rest_s = 0;
  const auto entry = [&](std::string_view name, double time_s) {
    const double percent = 100 * time_s / total_s;
    const std::string item =
        fmt::format("{} {} %", name, percent >= 0.95 ? text::fixed(percent, 0) : text::fixed(percent, 1));
    if (column > 0 && kHeadWidth + 1 + column + 3 + item.size() > kSummaryWidth) {
      text += '\n' + std::string(kHeadWidth + 1, ' ');
      column = 0;
    }
    if (column > 0) text += "   ";
    text += item;
    column += item.size() + (column > 0 ? 3 : 0);
  };
  for (const log::LimitShare& share : shares) {
    if (share.time_s < 0.0005 * total_s)
      rest_s += share.time_s;
    else
      entry(share.limited_by, share.time_s);
  }
  if (rest_s >= 0.0005 * total_s) entry("other", rest_s);
  return head("limited by", text + "   (of time)");
}

/// Time lost against the plan at 100 %, by reason; empty in a run without operator and spindle.
static std::string render_losses(const log::RunSummary& s) {
  if (s.lost_by.empty()) return {};
  std::string text;
  for (const log::LimitShare& share : s.lost_by)
    text += fmt::format("{}{} {:+.3f} s", text.empty() ? "" : "   ", share.limited_by, share.time_s);
  return head("time lost", text + fmt::format("   (planned {})", text::duration_text(s.planned_s)));
}

std::string render_summary(const log::RunSummary& s, const SummaryContext& c) {
  const machine::MachineModel& model = *c.model;
  const double time_s = seconds(s.ticks, model);
  std::string out = title(s, c);
  out += head("time", fmt::format("{}   ({} in motion, {} standing)   {}, {}", text::duration_text(time_s),
                                  text::duration_text(s.motion_s), text::duration_text(s.dwell_s),
                                  text::counted(s.control_ticks.value, "control tick"),
                                  text::counted(s.blocks, "block")));
  if (c.approach) out += head("approach", approach_text(*c.approach));
  out += head("path", fmt::format("{} {}   feed mean {}, peak {} {}", text::fixed(s.path_u, 3), c.path_unit,
                                  text::fixed(s.mean_feed_u_s, 3), text::fixed(s.peak_feed_u_s, 3),
                                  text::speed_unit(c.path_unit)));
  out += motion_table(s, c);
  out += acceleration_table(s, c);
  if (c.plant) {
    out += load_table(s, c);
    out += energy_table(s, c);
    out += head("path error",
                fmt::format("{} um   (tool from command over X Y Z, largest)", error_number(s.path_error_u)));
  } else {
    out += head("load", "not simulated (--no-plant)");
  }
  if (model.planner.tick_feed == machine::TickFeed::constant)
    out += head("feed held", fmt::format("path error {} um along the path (tick_feed = \"constant\")",
                                         error_number(s.held_error_u)));
  out += render_limits(s.limited_by);
  out += render_losses(s);
  out += alarm_lines(s, c);
  out += head("steps hash", hash_text(s.steps_hash));
  if (!c.log_path.empty())
    out += head("log", displayable(c.log_path) +
                           (c.log_bytes ? fmt::format("   {}", text::bytes_text(*c.log_bytes)) : ""));
  if (c.wall_s >= 0) {
    const double factor = c.wall_s > 0 ? time_s / c.wall_s : 0;
    out += head("wall", fmt::format("{} s, {}x real time", text::fixed(c.wall_s, 2),
                                    text::fixed(factor, factor < 10 ? 1 : 0)));
  }
  return out;
}

}  // namespace kadr::answers
