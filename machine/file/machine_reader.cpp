#include "machine/file/machine_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "machine/base/parse_number.h"
#include "machine/file/technology.h"
#include "machine/words.h"

namespace kadr::machine {

namespace {

constexpr double kFormat = 1;
constexpr double kMegahertz = 1e6;
constexpr std::size_t kMaxName = 100;
constexpr double kMaxControlTicks = 65536;

Bounds or_infinite(Bounds bounds) {
  bounds.infinite = true;
  return bounds;
}

void read_format(TableReader& root) {
  const auto format = root.number("format", {1, 1e6, false, true});
  if (!format.valid || format.value == kFormat) return;
  Diagnostic d =
      file_diagnostic(Code::file_format, format.span,
                      fmt::format("is edition {}, this kadr reads edition 1", number_text(format.value)));
  d.notes.push_back("allowed: format = 1");
  root.context().diagnostics.add(std::move(d));
}

std::string read_name(TableReader& root) {
  const auto name = root.text("name");
  if (!name.valid) return "";
  const bool control = std::any_of(name.value.begin(), name.value.end(),
                                   [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
  if (!name.value.empty() && name.value.size() <= kMaxName && !control) return name.value;
  Diagnostic d =
      file_diagnostic(Code::file_out_of_range, name.span,
                      control ? "has control characters" : fmt::format("has {} bytes", name.value.size()));
  d.message = "name: value is out of range";
  d.notes.push_back(fmt::format("allowed: 1 to {} bytes on one line", kMaxName));
  root.context().diagnostics.add(std::move(d));
  return "";
}

ClockModel read_clock(const Node* table, const Span& place, ReadContext& context) {
  TableReader r(table, "clock", place, context);
  const auto rate = r.number("rate_hz", {1e6, 1e9, false, true}, 10e6);
  const auto period = r.number("control_period_us", {1e-3, 65536}, 1000);
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

  // 0.1 us at 10 MHz is one tick, though 0.1 is not exact: a relative error of a few roundings is a whole
  // number
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

PathLimits read_path_limits(const Node* path, const Node* feed, const Span& place, ReadContext& context) {
  PathLimits limits;
  TableReader p(path, "path", place, context);
  limits.arc_end_tolerance_mm = p.number("arc_end_tolerance_mm", {0, 1e6}, limits.arc_end_tolerance_mm).value;
  limits.arc_end_tolerance_relative =
      p.number("arc_end_tolerance_relative", {0, 1}, limits.arc_end_tolerance_relative).value;
  p.finish();

  TableReader f(feed, "feed", place, context);
  limits.max_feed_mm_s = f.number("max_mm_s", or_infinite(kFeedBounds), kInfinity).value;
  limits.max_accel_mm_s2 = f.number("max_acceleration_mm_s2", or_infinite(kAccelBounds), kInfinity).value;
  limits.max_jerk_mm_s3 = f.number("max_jerk_mm_s3", kJerkBounds, kInfinity).value;
  limits.centripetal_accel_mm_s2 =
      f.number("centripetal_acceleration_mm_s2", or_infinite(kAccelBounds), kInfinity).value;
  f.finish();
  return limits;
}

PlannerSettings read_planner(const Node* table, const Span& place, ReadContext& context) {
  TableReader r(table, "planner", place, context);
  PlannerSettings s;
  s.whole_ticks = r.flag("whole_ticks", s.whole_ticks).value;
  s.axis_limits = r.choice("axis_limits", kAxisLimitRules, s.axis_limits).value;
  s.tick_feed = r.choice("tick_feed", kTickFeeds, s.tick_feed).value;
  s.tool_change_s = r.number("tool_change_s", {0, 1e6}, s.tool_change_s).value;
  s.scheduler = r.choice("scheduler", kSchedulers, s.scheduler).value;
  s.block_ticks = r.choice("block_ticks", kBlockTicks, s.block_ticks).value;
  s.law = r.choice("law", kRampLaws, s.law).value;
  s.method = r.choice("method", kPlanMethods, s.method).value;
  s.node_mm = r.number("node_mm", {1e-3, 1e3}, s.node_mm).value;
  s.tube_levels = static_cast<int>(r.number("tube_levels", {3, 1000, false, true}, s.tube_levels).value);
  const auto rapid = r.choice("rapid_law", kRapidShapes, s.rapid_law);
  s.rapid_law = rapid.value;
  if (s.rapid_law != RapidShape::scurve && s.scheduler == SchedulerKind::blockwise) {
    Diagnostic d =
        file_diagnostic(Code::machine_rapid_law, rapid.span, "but planner.scheduler is \"blockwise\"");
    d.help = "give rapid_law = \"scurve\", or scheduler = \"chained\"";
    context.diagnostics.add(std::move(d));
  }
  s.rapid_frequency_pct = r.number("rapid_frequency_pct", {0, 50}, s.rapid_frequency_pct).value;
  r.finish();
  return s;
}

StepMethod read_interpolator(const Node* table, const Span& place, ReadContext& context) {
  TableReader r(table, "interpolator", place, context);
  const auto method = r.choice("method", kMachineMethods, StepMethod::crossing);
  r.finish();
  return method.value;
}

OverrideSettings read_override(const Node* table, const Span& place, ReadContext& context) {
  TableReader r(table, "override", place, context);
  OverrideSettings s;
  s.mode = r.choice("mode", kOverrideModes, s.mode).value;
  s.locked = r.choice("locked", kLockedFeeds, s.locked).value;
  s.disabled = r.choice("disabled", kLockedFeeds, s.disabled).value;
  s.limiter = r.choice("limiter", kLimiters, s.limiter).value;
  s.predictive = r.flag("predictive", s.predictive).value;
  s.limiter_band_u_s = r.number("limiter_band_mm_s", {1e-3, 1e4}, s.limiter_band_u_s).value;
  r.finish();
  return s;
}

SpindleReaction read_spindle(const Node* table, const Span& place, ReadContext& context) {
  TableReader r(table, "spindle", place, context);
  SpindleReaction s;
  s.high_load_pct = r.number("high_load_pct", {1, 1000}, s.high_load_pct).value;
  s.high_ms = r.number("high_ms", {1, 1e6}, s.high_ms).value;
  s.down_pct = r.number("down_pct", {0, 100}, s.down_pct).value;
  s.down_ms = r.number("down_ms", {1, 1e6}, s.down_ms).value;
  s.low_load_pct = r.number("low_load_pct", {0, 1000}, s.low_load_pct).value;
  s.low_ms = r.number("low_ms", {1, 1e6}, s.low_ms).value;
  s.up_pct = r.number("up_pct", {0, 100}, s.up_pct).value;
  s.up_ms = r.number("up_ms", {1, 1e6}, s.up_ms).value;
  s.least_pct = r.number("least_pct", {1, 100}, s.least_pct).value;
  r.finish();
  return s;
}

LogSettings read_log(const Node* table, const Span& place, const ClockModel& clock, ReadContext& context) {
  TableReader r(table, "log", place, context);
  LogSettings s;
  s.ticks = r.flag("ticks", s.ticks).value;
  s.steps = r.flag("steps", s.steps).value;
  s.energy = r.flag("energy", s.energy).value;
  s.block_ticks = static_cast<int>(r.number("block_ticks", {16, 64, false, true}, s.block_ticks).value);
  // viewer values come from control ticks: there are no more of them
  const double most_hz = 1 / clock.tau_s();
  s.viewer_rate_hz = r.number("viewer_rate_hz", {0, most_hz}, std::min(s.viewer_rate_hz, most_hz)).value;
  r.finish();
  return s;
}

PlantSettings read_plant_settings(const Node* table, const Span& place, const std::vector<AxisModel>& axes,
                                  ReadContext& context) {
  TableReader r(table, "plant", place, context);
  PlantSettings s;
  const auto integrator = r.choice("integrator", kIntegrators, s.integrator);
  s.integrator = integrator.value;
  s.tolerance_um = r.number("tolerance_um", {1e-12, 1e3}, s.tolerance_um).value;
  r.finish();
  if (s.integrator != IntegratorKind::oracle) return s;
  for (const AxisModel& axis : axes) {
    if (!axis.has_plant || axis.plant.motor != MotorModel::stepper) continue;
    context.diagnostics.add(file_diagnostic(Code::machine_oracle_motor, integrator.span,
                                            fmt::format("but axis {} has a stepper motor", axis.letter)));
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
  const auto axis = r.word("axis", kLinearAxes, kAxisZ);
  stock.axis = kLinearAxes[axis.value].front();
  stock.position_mm = r.number("position_mm", kPositionBounds).value;
  stock.below = r.flag("below", stock.below).value;
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
    double home2_u = 0;
    AxisModel axis = read_axis(tables[i], i, model.clock, home2_u, context);
    if (axis.letter == 0) continue;
    if (model.find_axis(axis.letter) >= 0) {
      Diagnostic d = file_diagnostic(Code::machine_duplicate_axis, tables[i].find("name")->value.span,
                                     fmt::format("axis {} stands above already", axis.letter));
      d.help = "give each axis its own letter of X Y Z A B C U V W";
      context.diagnostics.add(std::move(d));
      continue;
    }
    model.home2[static_cast<std::size_t>(axis_index(axis.letter))] = home2_u;
    model.axis.push_back(axis);
  }
}

}  // namespace

MachineModel read_machine_model(const Node& root_node, ReadContext& context) {
  Span top = root_node.span;
  top.length = 1;
  TableReader root(&root_node, "", top, context);
  MachineModel model;
  read_format(root);
  model.name = read_name(root);
  model.on_alarm = root.choice("on_alarm", kOnAlarms, model.on_alarm).value;
  model.clock = read_clock(root.table("clock"), top, context);
  model.path = read_path_limits(root.table("path"), root.table("feed"), top, context);
  model.planner = read_planner(root.table("planner"), top, context);
  model.interpolator = read_interpolator(root.table("interpolator"), top, context);
  model.feed_override = read_override(root.table("override"), top, context);
  model.spindle = read_spindle(root.table("spindle"), top, context);
  read_axes(root, model);
  model.plant = read_plant_settings(root.table("plant"), top, model.axis, context);
  model.stock = read_stock(root.table("stock"), top, model, context);
  model.technology = read_technology(root);
  model.log = read_log(root.table("log"), top, model.clock, context);
  root.finish();
  return model;
}

}  // namespace kadr::machine
