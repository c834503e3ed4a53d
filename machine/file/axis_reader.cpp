#include <fmt/format.h>

#include <tuple>

#include "machine/base/parse_number.h"
#include "machine/file/machine_keys.h"
#include "machine/file/machine_reader.h"

namespace kadr::machine {

namespace {

/// Keys of an axis end in its unit: "max_mm_s" or "max_deg_s".
struct AxisKeys {
  std::string unit;
  std::string of(std::string_view stem, std::string_view suffix = "") const {
    return fmt::format("{}_{}{}", stem, unit, suffix);
  }
};

char read_letter(TableReader& r, ReadContext& context) {
  const auto name = r.text(kAxisName.name);
  if (!name.valid) return 0;
  if (name.value.size() == 1 && axis_index(name.value[0]) >= 0) return name.value[0];
  Diagnostic d = file_diagnostic(Code::machine_axis_letter, name.span, "no word of a program has this name");
  d.notes.push_back("allowed: X Y Z A B C U V W");
  if (name.value.size() == 1 && axis_index(static_cast<char>(name.value[0] - 32)) >= 0)
    d.help = fmt::format("write \"{}\"", static_cast<char>(name.value[0] - 32));
  context.diagnostics.add(std::move(d));
  return 0;
}

AxisKind read_kind(TableReader& r, char letter, ReadContext& context) {
  const bool rotary_letter = is_rotary_letter(letter);
  AxisModel axis;
  axis.kind = rotary_letter ? AxisKind::rotary : AxisKind::linear;
  const auto kind = read_key(r, axis, kAxisKindKey);
  const AxisKind chosen = kind.value;
  const bool free_letter = letter == 0 || letter == 'U' || letter == 'V' || letter == 'W';
  if (!kind.valid || free_letter || (chosen == AxisKind::rotary) == rotary_letter) return chosen;
  Diagnostic d = file_diagnostic(Code::machine_axis_kind, kind.span,
                                 fmt::format("axis {} is {}", letter, rotary_letter ? "rotary" : "linear"));
  d.notes.push_back("allowed: X Y Z linear, A B C rotary, U V W either");
  d.help = rotary_letter ? "name a linear axis X Y Z U V or W" : "name a rotary axis A B C U V or W";
  context.diagnostics.add(std::move(d));
  return rotary_letter ? AxisKind::rotary : AxisKind::linear;
}

/// Step length, given as such or as steps per unit.
Reading<double> read_step(TableReader& r, const AxisKeys& keys) {
  const std::string length = keys.of("step"), per = fmt::format("steps_per_{}", keys.unit);
  if (r.one_of(length, per) == length) return r.number(length, kStep.bounds);
  auto steps = r.number(per, kStepsPerBounds);
  steps.value = 1 / steps.value;
  return steps;
}

void check_step_rate(const AxisModel& axis, const Reading<double>& step, const Reading<double>& feed,
                     const ClockModel& clock, const AxisKeys& keys, ReadContext& context) {
  if (!step.valid || !feed.valid) return;
  const double rate_hz = axis.max_feed_u_s / axis.step_u;
  const double allowed_hz = static_cast<double>(clock.base_hz) / 2;
  if (rate_hz <= allowed_hz) return;
  Diagnostic d = file_diagnostic(
      Code::machine_step_rate, feed.span,
      fmt::format("is {:.12g} steps/s at {:.12g} {} per step", rate_hz, axis.step_u, keys.unit));
  d.notes.push_back(fmt::format("allowed: up to {:.12g} steps/s, half of clock.rate_hz", allowed_hz));
  d.help = fmt::format("at most {} = {:.12g}", keys.of("max", "_s"), allowed_hz * axis.step_u);
  context.diagnostics.add(std::move(d));
}

/// Reads the soft limits, and checks that home and second reference position are within them.
void read_range(TableReader& r, AxisModel& axis, double& home2_u, const AxisKeys& keys,
                ReadContext& context) {
  // a rotary axis may turn without end; a linear one says so with [-inf, inf]
  std::optional<std::pair<double, double>> otherwise;
  if (axis.kind == AxisKind::rotary) otherwise = {-kInfinity, kInfinity};
  const auto range = r.pair(spelled(kRangeDocument.name, axis.kind), kRangeBounds, otherwise);
  const auto home = read_key(r, axis, kHome, axis.kind);
  SecondHome second{axis.home_u};
  const auto home2 = read_key(r, second, kHome2, axis.kind);
  std::tie(axis.soft_min_u, axis.soft_max_u) = range.value;
  home2_u = home2.value;
  if (!range.valid) return;

  const std::string allowed =
      fmt::format("allowed: {} to {} {} ({})", number_text(axis.soft_min_u), number_text(axis.soft_max_u),
                  keys.unit, r.path_of(keys.of("range")));
  if (axis.soft_min_u >= axis.soft_max_u) {
    Diagnostic d = file_diagnostic(Code::machine_range_order, range.span,
                                   fmt::format("from {} to {} {}", number_text(axis.soft_min_u),
                                               number_text(axis.soft_max_u), keys.unit));
    d.notes.push_back("allowed: [lowest, highest] with lowest < highest");
    if (axis.soft_min_u > axis.soft_max_u)
      d.help = fmt::format("write {} = [{}, {}]", keys.of("range"), number_text(axis.soft_max_u),
                           number_text(axis.soft_min_u));
    context.diagnostics.add(std::move(d));
    return;
  }
  const auto check = [&](const Reading<double>& position, std::string_view what, const std::string& key) {
    if (!position.valid || (position.value >= axis.soft_min_u && position.value <= axis.soft_max_u)) return;
    const bool given = r.has(key);
    Diagnostic d = file_diagnostic(Code::machine_outside_range, given ? position.span : range.span,
                                   fmt::format("{} is at {} {}{}", what, number_text(position.value),
                                               keys.unit, given ? "" : " unless given"));
    d.notes.push_back(allowed);
    if (!given) d.help = fmt::format("write {} = ... within the range", key);
    context.diagnostics.add(std::move(d));
  };
  check(home, "home", keys.of("home"));
  if (r.has(keys.of("home2"))) check(home2, "second reference position", keys.of("home2"));
}

/// The plant of an axis; nothing for a rigid motor that carries no flexible link: the axis then follows its
/// steps exactly, and neither mass nor spring is needed.
std::optional<TwoMassModel> read_plant(const Node& table, const std::string& path, const AxisModel& axis,
                                       ReadContext& context) {
  TableReader r(&table, path, table.span, context);
  TwoMassModel m;
  read_key(r, m, kMotor);
  const auto any_given = [&](const auto&... each) {
    return ((each.need == Need::link && r.has(spelled(each.name, axis.kind))) || ...);
  };
  const bool link = m.motor != MotorModel::rigid || std::apply(any_given, kPlantKeys);
  const auto read = [&](const auto& key) {
    const bool needed =
        (key.need == Need::link && link) || (key.need == Need::motor && motor_needs(m.motor, key.member));
    read_key(r, m, key, axis.kind, needed);
  };
  std::apply([&](const auto&... each) { (read(each), ...); }, kPlantKeys);
  r.finish();
  return link ? std::optional(m) : std::nullopt;
}

}  // namespace

AxisModel read_axis(const Node& table, std::size_t index, const ClockModel& clock, double& home2_u,
                    ReadContext& context) {
  const Entry* name = table.find("name");
  const bool named = name && name->value.kind == Node::Kind::text && !name->value.text.empty();
  TableReader r(&table, named ? "axis." + name->value.text : fmt::format("axis[{}]", index + 1), table.span,
                context);
  AxisModel axis;
  axis.letter = read_letter(r, context);
  axis.kind = read_kind(r, axis.letter, context);
  const AxisKeys keys{axis.kind == AxisKind::rotary ? "deg" : "mm"};

  const auto step = read_step(r, keys);
  read_range(r, axis, home2_u, keys, context);
  axis.step_u = step.value;
  const auto feed = read_key(r, axis, kMaxFeed, axis.kind);
  read_keys(r, axis, kAxisLimitKeys, axis.kind);
  axis.junction_accel_u_s2 = axis.max_accel_u_s2;
  read_keys(r, axis, kJunctionKeys, axis.kind);
  check_step_rate(axis, step, feed, clock, keys, context);

  if (const Node* plant = r.table("plant")) {
    const auto model = read_plant(*plant, r.path() + ".plant", axis, context);
    axis.has_plant = model.has_value();
    axis.plant = model.value_or(TwoMassModel{});
  }
  r.finish();
  return axis;
}

}  // namespace kadr::machine
