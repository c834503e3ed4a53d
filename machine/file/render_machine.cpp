#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "machine/base/parse_number.h"
#include "machine/file/technology.h"
#include "machine/machine_file.h"
#include "machine/words.h"

namespace kadr::machine {

namespace {

/// Writes "key = value  # origin" lines, the comments in one column.
class TomlWriter {
 public:
  explicit TomlWriter(const MachineFile& file) : file_(file) {}

  void table(const std::string& header, std::string path) {
    out_ += '\n' + header + '\n';
    path_ = std::move(path);
  }
  /// `alias` is another key that may have given the value.
  void line(std::string_view key, const std::string& value, std::string_view alias = {}) {
    out_ += fmt::format("{:<44}  # {}\n", fmt::format("{} = {}", key, value), origin(key, alias));
  }
  void number(std::string_view key, double value, std::string_view alias = {}) {
    line(key, number_text(value), alias);
  }
  void word(std::string_view key, std::string_view value) { line(key, fmt::format("\"{}\"", value)); }
  void flag(std::string_view key, bool value) { line(key, value ? "true" : "false"); }
  /// A number that is left out where the machine has none.
  void number_if(std::string_view key, double value) {
    if (value > 0) number(key, value);
  }
  std::string take() { return std::move(out_); }

 private:
  std::string origin(std::string_view key, std::string_view alias) const {
    const auto full = [&](std::string_view k) {
      return path_.empty() ? std::string(k) : fmt::format("{}.{}", path_, k);
    };
    const std::string first = full(key), second = alias.empty() ? first : full(alias);
    for (const KeyOrigin& o : file_.origins) {
      if (o.key == first) return o.origin;
      if (o.key == second) return fmt::format("{} ({})", o.origin, alias);
    }
    return "default";
  }

  const MachineFile& file_;
  std::string path_;
  std::string out_;
};

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

void write_plant(TomlWriter& w, const AxisModel& axis) {
  const bool rotary = axis.kind == AxisKind::rotary;
  const auto key = [&](std::string_view stem, std::string_view linear, std::string_view turning) {
    return fmt::format("{}_{}", stem, rotary ? turning : linear);
  };
  const TwoMassModel& m = axis.plant;
  w.table("  [axis.plant]", fmt::format("axis.{}.plant", axis.letter));
  w.word("model", kMotorModels.word(m.motor));
  w.number(key("base_mass", "kg", "kg_m2"), m.base_mass_kg);
  w.number(key("link_mass", "kg", "kg_m2"), m.link_mass_kg);
  w.number(key("link_stiffness", "N_per_m", "Nm_per_rad"), m.link_stiffness_N_per_m);
  w.number(key("link_damping", "Ns_per_m", "Nms_per_rad"), m.link_damping_Ns_per_m);
  w.number(key("base_friction", "Ns_per_m", "Nms_per_rad"), m.base_friction_Ns_per_m);
  w.number_if(key("motor_stiffness", "N_per_m", "Nm_per_rad"), m.motor_stiffness_N_per_m);
  w.number(key("motor_damping", "Ns_per_m", "Nms_per_rad"), m.motor_damping_Ns_per_m);
  w.number_if(key("holding_force", "N", "Nm"), m.holding_force_N);
  w.number_if(key("tooth_pitch", "mm", "deg"), m.tooth_pitch_u);
}

void write_axis(TomlWriter& w, const AxisModel& axis, double home2_u) {
  const bool rotary = axis.kind == AxisKind::rotary;
  const std::string unit = rotary ? "deg" : "mm";
  const auto key = [&](std::string_view stem, std::string_view suffix = "") {
    return fmt::format("{}_{}{}", stem, unit, suffix);
  };
  w.table("[[axis]]", fmt::format("axis.{}", axis.letter));
  w.word("name", std::string(1, axis.letter));
  w.word("kind", kAxisKinds.word(axis.kind));
  w.number(key("step"), axis.step_u, fmt::format("steps_per_{}", unit));
  w.line(key("range"), fmt::format("[{}, {}]", number_text(axis.soft_min_u), number_text(axis.soft_max_u)));
  w.number(key("home"), axis.home_u);
  w.number(key("home2"), home2_u);
  w.number(key("max", "_s"), axis.max_feed_u_s);
  w.number(key("max_acceleration", "_s2"), axis.max_accel_u_s2);
  w.number(key("max_jerk", "_s3"), axis.max_jerk_u_s3);
  w.number(key("junction_acceleration", "_s2"), axis.junction_accel_u_s2);
  w.number(key("junction_jerk", "_s3"), axis.junction_jerk_u_s3);
  if (axis.has_plant) write_plant(w, axis);
}

void write_override(TomlWriter& w, const OverrideSettings& s) {
  w.table("[override]", "override");
  w.word("mode", kOverrideModes.word(s.mode));
  w.word("locked", kLockedFeeds.word(s.locked));
  w.word("disabled", kLockedFeeds.word(s.disabled));
  w.word("limiter", kLimiters.word(s.limiter));
  w.flag("predictive", s.predictive);
  w.number("limiter_band_mm_s", s.limiter_band_u_s);
}

void write_spindle(TomlWriter& w, const SpindleReaction& s) {
  w.table("[spindle]", "spindle");
  w.number("high_load_pct", s.high_load_pct);
  w.number("high_ms", s.high_ms);
  w.number("down_pct", s.down_pct);
  w.number("down_ms", s.down_ms);
  w.number("low_load_pct", s.low_load_pct);
  w.number("low_ms", s.low_ms);
  w.number("up_pct", s.up_pct);
  w.number("up_ms", s.up_ms);
  w.number("least_pct", s.least_pct);
}

void write_settings(TomlWriter& w, const MachineModel& m) {
  w.table("[clock]", "clock");
  w.line("rate_hz", fmt::format("{}", m.clock.base_hz));
  w.number("control_period_us",
           static_cast<double>(m.clock.control_tick.value) / (static_cast<double>(m.clock.base_hz) / 1e6));
  w.table("[path]", "path");
  w.number("arc_end_tolerance_mm", m.path.arc_end_tolerance_mm);
  w.number("arc_end_tolerance_relative", m.path.arc_end_tolerance_relative);
  w.table("[feed]", "feed");
  w.number("max_mm_s", m.path.max_feed_mm_s);
  w.number("max_acceleration_mm_s2", m.path.max_accel_mm_s2);
  w.number("max_jerk_mm_s3", m.path.max_jerk_mm_s3);
  w.number("centripetal_acceleration_mm_s2", m.path.centripetal_accel_mm_s2);
  w.table("[planner]", "planner");
  w.flag("whole_ticks", m.planner.whole_ticks);
  w.word("axis_limits", kAxisLimitRules.word(m.planner.axis_limits));
  w.word("tick_feed", kTickFeeds.word(m.planner.tick_feed));
  w.number("tool_change_s", m.planner.tool_change_s);
  w.word("scheduler", kSchedulers.word(m.planner.scheduler));
  w.word("block_ticks", kBlockTicks.word(m.planner.block_ticks));
  w.word("law", kRampLaws.word(m.planner.law));
  w.word("method", kPlanMethods.word(m.planner.method));
  w.number("node_mm", m.planner.node_mm);
  w.number("tube_levels", m.planner.tube_levels);
  w.word("rapid_law", kRapidShapes.word(m.planner.rapid_law));
  w.number("rapid_frequency_pct", m.planner.rapid_frequency_pct);
  w.table("[interpolator]", "interpolator");
  w.word("method", kStepMethods.word(m.interpolator));
  write_override(w, m.feed_override);
  write_spindle(w, m.spindle);
  w.table("[plant]", "plant");
  w.word("integrator", kIntegrators.word(m.plant.integrator));
  w.number("tolerance_um", m.plant.tolerance_um);
  for (const TechnologyRule& rule : m.technology) {
    w.table("[[technology]]", "technology");
    w.word("on", technology_code(rule));
    w.number("max_mm_s", rule.max_u_s);
  }
  if (m.stock) {
    w.table("[stock]", "stock");
    w.word("axis", std::string(1, m.stock->axis));
    w.number("position_mm", m.stock->position_mm);
    w.flag("below", m.stock->below);
  }
  w.table("[log]", "log");
  w.flag("ticks", m.log.ticks);
  w.flag("steps", m.log.steps);
  w.flag("energy", m.log.energy);
  w.line("block_ticks", fmt::format("{}", m.log.block_ticks));
  w.number("viewer_rate_hz", m.log.viewer_rate_hz);
}

}  // namespace

std::string render_machine(const MachineFile& file) {
  const MachineModel& m = file.model;
  TomlWriter w(file);
  w.line("format", "1");
  w.line("name", quoted(m.name));
  w.word("on_alarm", kOnAlarms.word(m.on_alarm));
  write_settings(w, m);
  for (const AxisModel& axis : m.axis)
    write_axis(w, axis, m.home2[static_cast<std::size_t>(axis_index(axis.letter))]);
  return w.take();
}

}  // namespace kadr::machine
