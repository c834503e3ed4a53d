#include "emulator/studies/teach/teach_report.h"

#include <fmt/format.h>

#include <cmath>

#include "emulator/text/text.h"
#include "machine/base/terminal_text.h"

namespace kadr::studies {
namespace {

namespace lattice = interpolator::lattice;
using text::Json;

// wider sequences are left to the step tables
constexpr std::size_t kMostMoves = 48;

std::string signed_steps(double value) {
  const std::string text = text::fixed(value, 3);
  return value > 0 && text.find_first_of("123456789") != text.npos ? "+" + text : text;
}

std::string lower_letter(std::size_t axis) {
  return std::string(1, static_cast<char>(axis_letter(axis) | 0x20));
}

std::string node_text(const lattice::Point& node, int axes) {
  std::string out = "(";
  for (std::size_t k = 0; k < static_cast<std::size_t>(axes); ++k)
    out += fmt::format("{}{}", k == 0 ? "" : ", ", node[k]);
  return out + ")";
}

std::string hash_text(const StepTable& table) { return fmt::format("{:016x}", table.hash); }

std::string end_text(const StepTable& table) {
  if (table.end_reached) return "end " + node_text(table.end, table.axes) + " reached";
  return fmt::format("end {} missed: at {}", node_text(table.end, table.axes),
                     node_text(table.last.node, table.axes));
}

std::string square_text(const StepTable& table) {
  return table.worst_square_steps < 0 ? "-" : text::fixed(table.worst_square_steps, 4);
}

/// "XY X XY": the moves of a table in one line.
std::string moves_line(const StepTable& table) {
  std::string out;
  for (const StepRow& row : table.rows) {
    std::string move;
    for (std::size_t k = 0; k < static_cast<std::size_t>(table.axes); ++k)
      if (row.slot.step[k] != 0)
        move += row.slot.step[k] > 0 ? std::string(1, axis_letter(k)) : lower_letter(k);
    if (table.diagonals > 0 && !out.empty()) out += ' ';
    out += move.empty() ? "." : move;
  }
  return out;
}

}  // namespace

std::string move_text(const lattice::Slot& slot, int axes) {
  std::string out;
  for (std::size_t k = 0; k < static_cast<std::size_t>(axes); ++k)
    if (slot.step[k] != 0) out += fmt::format("{}{}", slot.step[k] > 0 ? '+' : '-', axis_letter(k));
  return out.empty() ? "-" : out;
}

std::string render_step_table(const TeachCase& subject, const StepTable& table) {
  std::vector<text::TextTable::Column> columns = {{"i"}};
  for (std::size_t k = 0; k < static_cast<std::size_t>(table.axes); ++k) columns.push_back({lower_letter(k)});
  for (const std::string* name : {&table.value_name, &table.tested_name, &table.tested_y_name})
    if (!name->empty()) columns.push_back({*name});
  const bool parametric = !table.rows.empty() && table.rows.front().slot.parameter >= 0;
  if (parametric) columns.push_back({"t"});
  columns.push_back({"move"});
  columns.push_back({"deviation"});
  text::TextTable text(std::move(columns));
  const auto add = [&](std::size_t i, const StepRow& row, bool last) {
    std::vector<std::string> cells = {std::to_string(i)};
    for (std::size_t k = 0; k < static_cast<std::size_t>(table.axes); ++k)
      cells.push_back(std::to_string(row.node[k]));
    const std::pair<const std::string*, std::int64_t> values[] = {{&table.value_name, row.slot.value},
                                                                  {&table.tested_name, row.slot.tested},
                                                                  {&table.tested_y_name, row.slot.tested_y}};
    for (const auto& [name, value] : values)
      if (!name->empty()) cells.push_back(last ? "" : std::to_string(value));
    if (parametric) cells.push_back(last ? "" : text::fixed(row.slot.parameter, 6));
    cells.push_back(last ? "end" : move_text(row.slot, table.axes) + (row.slot.forced ? "!" : ""));
    // a curve in the plane has two sides
    cells.push_back(table.axes == 2 && !parametric ? signed_steps(row.deviation_steps)
                                                   : text::fixed(row.deviation_steps, 3));
    text.add(std::move(cells));
  };
  for (std::size_t i = 0; i < table.rows.size(); ++i) add(i, table.rows[i], false);
  add(table.rows.size(), table.last, true);
  const lattice::MethodEntry& method = lattice::entry_of(table.method);
  std::string out = fmt::format("{}, {}: {}; deviation in steps\n", displayable(subject.title), method.name(),
                                method.meaning());
  out += text.render();
  out += fmt::format("{}, {}, {} with several axes, {} idle, {} forced by the end (!)\n",
                     text::counted(static_cast<std::int64_t>(table.rows.size()), "slot"),
                     text::counted(table.pulses, "pulse"), text::counted(table.diagonals, "slot"),
                     text::grouped(table.idle), text::grouped(table.forced));
  out += fmt::format("largest deviation {} steps, root mean square {} steps",
                     text::fixed(table.worst_steps, 4), text::fixed(table.rms_steps, 4));
  if (table.worst_square_steps >= 0) out += fmt::format(", in the larger axis {} steps", square_text(table));
  out += fmt::format("\n{}; path {} steps; steps hash {}\n", end_text(table),
                     text::fixed(table.length_steps, 3), hash_text(table));
  return out;
}

std::string render_step_csv(const StepTable& table) {
  std::string out = "i";
  for (std::size_t k = 0; k < static_cast<std::size_t>(table.axes); ++k) out += "," + lower_letter(k);
  out += ",value,tested,tested_y,t,move,forced,deviation_steps\n";
  const auto add = [&](std::size_t i, const StepRow& row, bool last) {
    out += std::to_string(i);
    for (std::size_t k = 0; k < static_cast<std::size_t>(table.axes); ++k)
      out += fmt::format(",{}", row.node[k]);
    if (last)
      out += ",,,,,end,";
    else
      out += fmt::format(",{},{},{},{},{},{}", row.slot.value, row.slot.tested, row.slot.tested_y,
                         row.slot.parameter >= 0 ? fmt::format("{}", row.slot.parameter) : std::string(),
                         move_text(row.slot, table.axes), row.slot.forced ? 1 : 0);
    out += fmt::format(",{}\n", row.deviation_steps);
  };
  for (std::size_t i = 0; i < table.rows.size(); ++i) add(i, table.rows[i], false);
  add(table.rows.size(), table.last, true);
  return out;
}

namespace {

Json summary_json(const StepTable& table) {
  const auto point = [&](const lattice::Point& p) {
    return std::vector<std::int64_t>(p.begin(), p.begin() + table.axes);
  };
  Json j;
  j["method"] = lattice::entry_of(table.method).name();
  j["slots"] = table.rows.size();
  j["pulses"] = table.pulses;
  j["slots_with_several_axes"] = table.diagonals;
  j["idle_slots"] = table.idle;
  j["forced_slots"] = table.forced;
  j["largest_deviation_steps"] = table.worst_steps;
  j["rms_deviation_steps"] = table.rms_steps;
  j["larger_axis_deviation_steps"] =
      table.worst_square_steps < 0 ? Json(nullptr) : Json(table.worst_square_steps);
  j["path_steps"] = table.length_steps;
  j["end"] = point(table.end);
  j["node"] = point(table.last.node);
  j["end_reached"] = table.end_reached;
  j["steps_hash"] = hash_text(table);
  return j;
}

}  // namespace

Json json_of(const TeachCase& subject, const StepTable& table) {
  Json j = {{"case", subject.title}, {"axes", table.axes}};
  j.update(summary_json(table));
  j["value_name"] = table.value_name;
  j["tested_name"] = table.tested_name;
  j["tested_y_name"] = table.tested_y_name;
  Json rows = Json::array();
  for (const StepRow& row : table.rows) {
    Json r = {{"node", std::vector<std::int64_t>(row.node.begin(), row.node.begin() + table.axes)},
              {"value", row.slot.value},
              {"tested", row.slot.tested},
              {"tested_y", row.slot.tested_y},
              {"step", std::vector<int>(row.slot.step.begin(), row.slot.step.begin() + table.axes)},
              {"forced", row.slot.forced},
              {"deviation_steps", row.deviation_steps}};
    if (row.slot.parameter >= 0) r["t"] = row.slot.parameter;
    rows.push_back(std::move(r));
  }
  j["rows"] = std::move(rows);
  return j;
}

std::string render_comparison(const TeachCase& subject, const std::vector<StepTable>& tables) {
  using Align = text::TextTable::Align;
  text::TextTable text({{"method", Align::left},
                        {"slots"},
                        {"pulses"},
                        {"idle"},
                        {"forced"},
                        {"largest"},
                        {"rms"},
                        {"larger axis"},
                        {"steps hash", Align::left},
                        {"end", Align::left}});
  bool few = true;
  std::size_t width = 0;
  for (const StepTable& t : tables) {
    text.add({std::string(lattice::entry_of(t.method).name()),
              text::grouped(static_cast<std::int64_t>(t.rows.size())), text::grouped(t.pulses),
              text::grouped(t.idle), text::grouped(t.forced), text::fixed(t.worst_steps, 4),
              text::fixed(t.rms_steps, 4), square_text(t), hash_text(t),
              t.end_reached ? "reached" : "missed: at " + node_text(t.last.node, t.axes)});
    few = few && t.rows.size() <= kMostMoves;
    width = std::max(width, lattice::entry_of(t.method).name().size());
  }
  std::string out = fmt::format("{}: path {} steps, end {}; deviations in steps\n",
                                displayable(subject.title), text::fixed(tables.front().length_steps, 3),
                                node_text(tables.front().end, tables.front().axes));
  out += text.render();
  if (!few) return out;
  out += "\nmoves (small letters: backwards)\n";
  for (const StepTable& t : tables)
    out += fmt::format("{}  {}\n", text::pad_right(lattice::entry_of(t.method).name(), width), moves_line(t));
  return out;
}

std::string render_comparison_csv(const std::vector<StepTable>& tables) {
  std::string out =
      "method,slots,pulses,slots_with_several_axes,idle_slots,forced_slots,largest_deviation_steps,"
      "rms_deviation_steps,larger_axis_deviation_steps,end_reached,steps_hash\n";
  for (const StepTable& t : tables)
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", lattice::entry_of(t.method).name(),
                       t.rows.size(), t.pulses, t.diagonals, t.idle, t.forced, t.worst_steps, t.rms_steps,
                       t.worst_square_steps < 0 ? std::string() : fmt::format("{}", t.worst_square_steps),
                       t.end_reached ? 1 : 0, hash_text(t));
  return out;
}

Json comparison_json(const TeachCase& subject, const std::vector<StepTable>& tables) {
  Json j = {{"case", subject.title}, {"axes", subject.axes}};
  j["methods"] = Json::array();
  for (const StepTable& t : tables) j["methods"].push_back(summary_json(t));
  return j;
}

std::string render_spacing(const PulseTrain& train) {
  std::string out = fmt::format(
      "time between pulses, {} us in all:",
      text::fixed(1e6 * static_cast<double>(train.duration.value) / static_cast<double>(train.clock_hz), 1));
  for (std::size_t k = 0; k < train.axis.size(); ++k) {
    const Spacing s = spacing_of(train.axis[k]);
    const double tick_us = 1e6 / static_cast<double>(train.clock_hz);
    out += s.most_ticks == 0 ? fmt::format("   {} -", axis_letter(k))
                             : fmt::format("   {} {} .. {} us", axis_letter(k),
                                           text::fixed(static_cast<double>(s.least_ticks) * tick_us, 1),
                                           text::fixed(static_cast<double>(s.most_ticks) * tick_us, 1));
  }
  return out + "\n";
}

Json json_of(const PulseTrain& train) {
  Json j;
  j["clock_hz"] = train.clock_hz;
  j["duration_ticks"] = train.duration.value;
  j["axes"] = Json::array();
  for (std::size_t k = 0; k < train.axis.size(); ++k) {
    const Spacing s = spacing_of(train.axis[k]);
    j["axes"].push_back({{"name", std::string(1, axis_letter(k))},
                         {"pulses", train.axis[k].size()},
                         {"least_spacing_ticks", s.least_ticks},
                         {"most_spacing_ticks", s.most_ticks}});
  }
  return j;
}

}  // namespace kadr::studies
