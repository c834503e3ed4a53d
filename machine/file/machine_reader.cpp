#include "machine/file/machine_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "machine/base/parse_number.h"
#include "machine/file/code_table.h"
#include "machine/file/data_sheet.h"
#include "machine/file/machine_keys.h"
#include "machine/file/technology.h"

namespace kadr::machine {

namespace {

constexpr double kEdition = 1;
constexpr double kMegahertz = 1e6;
constexpr double kMaxControlTicks = 65536;

constexpr std::size_t kMostStartup = 200;  // bytes

void read_format(TableReader& root) {
  const auto format = root.number(kFormat.name, {1, 1e6, false, true});
  if (!format.valid || format.value == kEdition) return;
  Diagnostic d =
      file_diagnostic(Code::file_format, format.span,
                      fmt::format("is edition {}, this kadr reads edition 1", number_text(format.value)));
  d.notes.push_back("allowed: format = 1");
  root.context().diagnostics.add(std::move(d));
}

/// A text of `least` to `most` bytes without control characters. @return "" if it is not, and told
std::string one_line(TableReader& root, std::string_view key, const machine::Reading<std::string>& text,
                     std::size_t least, std::size_t most) {
  if (!text.valid) return "";
  const bool control = std::any_of(text.value.begin(), text.value.end(),
                                   [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
  if (text.value.size() >= least && text.value.size() <= most && !control) return text.value;
  Diagnostic d =
      file_diagnostic(Code::file_out_of_range, text.span,
                      control ? "has control characters" : fmt::format("has {} bytes", text.value.size()));
  d.message = fmt::format("{}: value is out of range", key);
  d.notes.push_back(fmt::format("allowed: {}{} bytes on one line",
                                least == 0 ? "up to " : fmt::format("{} to ", least), most));
  root.context().diagnostics.add(std::move(d));
  return "";
}

std::string read_name(TableReader& root) {
  return one_line(root, kName.name, root.text(kName.name), 1, kMostMachineName);
}

/// Its words are read with each program: their mistakes are told there.
std::string read_startup(TableReader& root) {
  return one_line(root, kProgramStartup.name, root.text(kProgramStartup.name, ""), 0, kMostStartup);
}

ClockModel read_clock(const Node* table, const Span& place, ReadContext& context) {
  TableReader r(table, "clock", place, context);
  ClockKeys written;
  const auto rate = read_key(r, written, kRate);
  const auto period = read_key(r, written, kControlPeriod);
  r.finish();

  ClockModel clock;
  if (!rate.valid || !period.valid) return clock;
  if (std::fmod(rate.value, kMegahertz) != 0) {
    const double below = std::floor(rate.value / kMegahertz);
    Diagnostic d = file_diagnostic(Code::machine_clock, rate.span,
                                   fmt::format("is {} MHz", number_text(rate.value / kMegahertz)));
    d.notes.push_back("allowed: whole multiples of 1 MHz (1000000)");
    d.help = fmt::format("write rate_hz = {:.0f} or {:.0f}", below * kMegahertz, (below + 1) * kMegahertz);
    context.diagnostics.add(std::move(d));
    return clock;
  }
  clock.base_hz = static_cast<std::int64_t>(rate.value);

  // 0.1 us at 10 MHz is one tick, though 0.1 is not exact: a relative error of a few roundings is a whole number
  const double ticks = period.value * (rate.value / kMegahertz);
  const double whole = std::floor(ticks + 0.5);
  if (whole < 1 || std::fabs(ticks - whole) > 1e-9 * ticks) {
    Diagnostic d = file_diagnostic(Code::machine_control_period, period.span,
                                   fmt::format("is {:.12g} ticks of {} MHz", ticks, rate.value / kMegahertz));
    d.notes.push_back(fmt::format("allowed: whole multiples of {:.12g} us", kMegahertz / rate.value));
    d.help =
        fmt::format("write control_period_us = {:.12g}", std::max(whole, 1.0) / (rate.value / kMegahertz));
    context.diagnostics.add(std::move(d));
    return clock;
  }
  if (whole > kMaxControlTicks) {
    Diagnostic d =
        file_diagnostic(Code::machine_long_period, period.span, fmt::format("is {:.0f} base ticks", whole));
    d.notes.push_back(fmt::format("allowed: up to 65536 base ticks, {:.12g} us at {:.12g} MHz",
                                  kMaxControlTicks / (rate.value / kMegahertz), rate.value / kMegahertz));
    context.diagnostics.add(std::move(d));
    return clock;
  }
  clock.control_tick = Ticks{static_cast<std::int64_t>(whole)};
  return clock;
}

/// Where path.approach was written: its axes are known later.
struct WrittenApproach {
  std::vector<std::string> groups;
  Span span;
};

PathLimits read_path_limits(const Node* path, const Node* feed, const Span& place, WrittenApproach& approach,
                            ReadContext& context) {
  PathLimits limits;
  TableReader p(path, "path", place, context);
  read_keys(p, limits, kPathKeys);
  approach.span = p.place(kApproach.name);
  for (const auto& group : p.texts(kApproach.name)) approach.groups.push_back(group.value);
  p.finish();

  TableReader f(feed, "feed", place, context);
  read_keys(f, limits, kFeedKeys);
  f.finish();
  return limits;
}

PlannerSettings read_planner(const Node* table, const Span& place, ReadContext& context) {
  TableReader r(table, "planner", place, context);
  PlannerSettings s;
  read_keys(r, s, kPlannerKeys);
  if (s.rapid_law != RapidShape::scurve && s.scheduler == SchedulerKind::blockwise) {
    Diagnostic d = file_diagnostic(Code::machine_rapid_law, r.place("rapid_law"),
                                   "but planner.scheduler is \"blockwise\"");
    d.help = "give rapid_law = \"scurve\", or scheduler = \"chained\"";
    context.diagnostics.add(std::move(d));
  }
  r.finish();
  return s;
}

void read_interpolator(const Node* table, const Span& place, MachineModel& model, ReadContext& context) {
  TableReader r(table, "interpolator", place, context);
  read_key(r, model, kInterpolatorMethod);
  r.finish();
}

/// A table that has keys of settings alone.
template <class Settings, class Keys>
Settings read_settings(const Node* table, const char* path, const Span& place, const Keys& keys,
                       ReadContext& context) {
  TableReader r(table, path, place, context);
  Settings settings;
  read_keys(r, settings, keys);
  r.finish();
  return settings;
}

LogSettings read_log(const Node* table, const Span& place, const ClockModel& clock, ReadContext& context) {
  TableReader r(table, "log", place, context);
  LogSettings s;
  read_keys(r, s, kLogKeys);
  // viewer values come from control ticks: there are no more of them
  auto viewer_rate = kViewerRate;
  viewer_rate.bounds.high = 1 / clock.tau_s();
  s.viewer_rate_hz = std::min(s.viewer_rate_hz, viewer_rate.bounds.high);
  read_key(r, s, viewer_rate);
  r.finish();
  return s;
}

PlantSettings read_plant_settings(const Node* table, const Span& place, const std::vector<AxisModel>& axes,
                                  ReadContext& context) {
  TableReader r(table, "plant", place, context);
  PlantSettings s;
  const auto integrator = read_key(r, s, kIntegrator);
  read_key(r, s, kTolerance);
  r.finish();
  if (s.integrator != IntegratorKind::oracle) return s;
  for (const AxisModel& axis : axes) {
    if (!axis.has_plant || Motor(axis).linear()) continue;
    context.diagnostics.add(file_diagnostic(
        Code::machine_oracle_motor, integrator.span,
        fmt::format("but axis {} has a {} motor", axis.letter, kMotorModels.word(axis.plant.motor))));
  }
  return s;
}

std::optional<StockModel> read_stock(const Node* table, const Span& place, const MachineModel& model,
                                     ReadContext& context) {
  if (!table) return std::nullopt;
  constexpr std::string_view kLinearAxes[] = {"X", "Y", "Z", "U", "V", "W"};
  constexpr std::size_t kAxisZ = 2;
  TableReader r(table, "stock", place, context);
  StockModel stock;
  const auto axis = r.word(kStockAxis.name, kLinearAxes, kAxisZ);
  stock.axis = kLinearAxes[axis.value].front();
  read_key(r, stock, kStockPosition);
  read_key(r, stock, kStockBelow);
  r.finish();
  const int index = model.find_axis(stock.axis);
  if (axis.valid && (index < 0 || model.axis[static_cast<std::size_t>(index)].kind == AxisKind::rotary)) {
    Diagnostic d = file_diagnostic(Code::machine_stock_axis, axis.span,
                                   fmt::format("the machine has no linear axis {}", stock.axis));
    d.help = "name the axis along which the probe meets the material";
    context.diagnostics.add(std::move(d));
  }
  return stock;
}

std::vector<TechnologyRule> read_technology(TableReader& root) {
  std::vector<TechnologyRule> rules;
  for (const Node& node : root.tables("technology")) {
    TableReader keys(&node, "technology", node.span, root.context());
    rules.push_back(read_technology_rule(keys));
    keys.finish();
  }
  return rules;
}

void read_axes(TableReader& root, MachineModel& model) {
  ReadContext& context = root.context();
  const std::vector<Node>& tables = root.tables("axis");
  if (tables.empty() && context.complete && !root.has("axis"))
    context.diagnostics.add(
        file_diagnostic(Code::machine_no_axis, root.header(), "the file has no [[axis]]"));
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (context.diagnostics.full()) return context.diagnostics.stop(tables[i].span);
    double home2_u = 0;
    AxisModel axis = read_axis(tables[i], i, model.clock, home2_u, context);
    if (axis.letter == 0) continue;
    if (model.find_axis(axis.letter) >= 0) {
      Diagnostic d = file_diagnostic(Code::machine_duplicate_axis, tables[i].find("name")->value.span,
                                     fmt::format("axis {} is already given above", axis.letter));
      d.help = "give each axis its own letter of X Y Z A B C U V W";
      context.diagnostics.add(std::move(d));
      continue;
    }
    model.home2[static_cast<std::size_t>(axis_index(axis.letter))] = home2_u;
    model.axis.push_back(axis);
  }
}

/// Each axis of the machine stands in one group.
std::vector<std::string> checked_approach(WrittenApproach approach, const MachineModel& model,
                                          ReadContext& context) {
  if (approach.groups.empty()) return {};
  std::string named, fault, all;
  for (const std::string& group : approach.groups) {
    if (group.empty() && fault.empty()) fault = "a group is empty";
    for (const char letter : group) {
      const bool known = model.find_axis(letter) >= 0;
      if (fault.empty() && !known) fault = fmt::format("the machine has no axis '{}'", letter);
      if (fault.empty() && named.find(letter) != std::string::npos)
        fault = fmt::format("axis {} is named twice", letter);
      named += letter;
    }
  }
  for (const AxisModel& axis : model.axis) {
    all += axis.letter;
    if (fault.empty() && named.find(axis.letter) == std::string::npos)
      fault = fmt::format("axis {} is not named", axis.letter);
  }
  if (fault.empty()) return std::move(approach.groups);
  Diagnostic d = file_diagnostic(Code::machine_approach, approach.span, std::move(fault));
  d.help = fmt::format("name each axis of the machine once: {}", all);
  context.diagnostics.add(std::move(d));
  return {};
}

}  // namespace

MachineModel read_machine_model(const Node& root_node, ReadContext& context) {
  Span top = root_node.span;
  top.length = 1;
  TableReader root(&root_node, "", top, context);
  MachineModel model;
  read_format(root);
  model.name = read_name(root);
  const StartUnits units = root.choice(kProgramUnits.name, kStartUnits, StartUnits::mm).value;
  if (root.has(kProgramUnits.name)) model.units = units;
  model.startup = read_startup(root);
  read_key(root, model, kOnAlarm);
  model.clock = read_clock(root.table("clock"), top, context);
  WrittenApproach approach;
  model.path = read_path_limits(root.table("path"), root.table("feed"), top, approach, context);
  const Node* const planner = root.table("planner");
  model.planner = read_planner(planner, top, context);
  read_interpolator(root.table("interpolator"), top, model, context);
  model.feed_override =
      read_settings<OverrideSettings>(root.table("override"), "override", top, kOverrideKeys, context);
  model.spindle =
      read_settings<SpindleReaction>(root.table("spindle"), "spindle", top, kSpindleKeys, context);
  read_axes(root, model);
  model.approach = checked_approach(std::move(approach), model, context);
  model.plant = read_plant_settings(root.table("plant"), top, model.axis, context);
  model.stock = read_stock(root.table("stock"), top, model, context);
  model.technology = read_technology(root);
  model.codes = read_owner_codes(root.table("codes"), top,
                                 planner != nullptr && planner->find("tool_change_s") != nullptr,
                                 model.planner, context);
  model.log = read_log(root.table("log"), top, model.clock, context);
  root.finish();
  return model;
}

}  // namespace kadr::machine
