#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "machine/base/parse_number.h"
#include "machine/base/terminal_text.h"
#include "machine/base/utf8.h"
#include "machine/file/machine_keys.h"
#include "machine/file/technology.h"
#include "machine/machine_file.h"

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

/// A text of TOML; what a terminal may not be shown is escaped.
std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint c = decode_utf8(text, at);
    if (!may_be_shown(c.value))
      out += fmt::format("\\U{:08X}", static_cast<std::uint32_t>(c.value));
    else if (c.value == '"' || c.value == '\\')
      out.append("\\").append(text.substr(at, 1));
    else
      out += text.substr(at, c.bytes);
    at += c.bytes;
  }
  return out + '"';
}

template <class Model, class Value>
void write_key(TomlWriter& w, const Model& model, const Key<Model, Value>& key,
               AxisKind kind = AxisKind::linear) {
  const Value value = model.*key.member;
  const std::string name = spelled(key.name, kind);
  // a motor's number that is not given holds 0: left out where 0 is not allowed
  if constexpr (std::is_same_v<Value, bool>)
    w.line(name, value ? "true" : "false");
  else if (key.need != Need::motor || as_number(value) >= key.bounds.low)
    w.line(name, default_text(as_number(value), key.bounds.whole));
}
template <class Model, class Enum, std::size_t kCount>
void write_key(TomlWriter& w, const Model& model, const WordKey<Model, Enum, kCount>& key,
               AxisKind = AxisKind::linear) {
  w.word(key.name, key.words->word(model.*key.member));
}
template <class Model, class... Keys>
void write_keys(TomlWriter& w, const Model& model, const std::tuple<Keys...>& keys,
                AxisKind kind = AxisKind::linear) {
  std::apply([&](const auto&... each) { (write_key(w, model, each, kind), ...); }, keys);
}

void write_axis(TomlWriter& w, const AxisModel& axis, double home2_u) {
  w.table("[[axis]]", fmt::format("axis.{}", axis.letter));
  w.word("name", std::string(1, axis.letter));
  write_key(w, axis, kAxisKindKey);
  w.number(spelled(kStep.name, axis.kind), axis.step_u, spelled("steps_per_{u}", axis.kind));
  w.line(spelled(kRangeDocument.name, axis.kind),
         fmt::format("[{}, {}]", number_text(axis.soft_min_u), number_text(axis.soft_max_u)));
  write_key(w, axis, kHome, axis.kind);
  write_key(w, SecondHome{home2_u}, kHome2, axis.kind);
  write_key(w, axis, kMaxFeed, axis.kind);
  write_keys(w, axis, kAxisLimitKeys, axis.kind);
  write_keys(w, axis, kJunctionKeys, axis.kind);
  if (!axis.has_plant) return;
  w.table("  [axis.plant]", fmt::format("axis.{}.plant", axis.letter));
  write_key(w, axis.plant, kMotor);
  write_keys(w, axis.plant, kPlantKeys, axis.kind);
}

void write_codes(TomlWriter& w, const OwnerCodes& codes) {
  if (!codes.ignore.empty()) {
    w.table("[codes]", "codes");
    std::string list;
    for (const CodeName& code : codes.ignore)
      list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", code_text(code));
    w.line(kCodesIgnored.name, "[" + list + "]");
  }
  for (const OwnerCode& own : codes.own) {
    const std::string name = code_text(own.code);
    // G12.1 with its point is a key in quotes
    const bool point = name.find('.') != std::string::npos;
    w.table(fmt::format("[codes.{}]", point ? "\"" + name + "\"" : name), fmt::format("codes.{}", name));
    if (!own.call.empty()) {
      w.line(kOwnerCall.name, quoted(own.call));
      continue;
    }
    w.number("time_s", own.time_s);
    if (own.output < 0) continue;
    w.number("output", own.output);
    w.line("on", own.on ? "true" : "false");
    w.line("stop", own.stop ? "true" : "false");
  }
}

void write_settings(TomlWriter& w, const MachineModel& m) {
  w.table("[clock]", "clock");
  const auto rate_hz = static_cast<double>(m.clock.base_hz);
  const ClockKeys clock{rate_hz, static_cast<double>(m.clock.control_tick.value) / (rate_hz / 1e6)};
  write_key(w, clock, kRate);
  write_key(w, clock, kControlPeriod);
  w.table("[path]", "path");
  write_keys(w, m.path, kPathKeys);
  if (!m.approach.empty()) w.line(kApproach.name, fmt::format("[\"{}\"]", fmt::join(m.approach, "\", \"")));
  w.table("[feed]", "feed");
  write_keys(w, m.path, kFeedKeys);
  w.table("[planner]", "planner");
  write_keys(w, m.planner, kPlannerKeys);
  w.table("[interpolator]", "interpolator");
  write_key(w, m, kInterpolatorMethod);
  w.table("[override]", "override");
  write_keys(w, m.feed_override, kOverrideKeys);
  w.table("[spindle]", "spindle");
  write_keys(w, m.spindle, kSpindleKeys);
  w.table("[plant]", "plant");
  write_key(w, m.plant, kIntegrator);
  write_key(w, m.plant, kTolerance);
  for (const TechnologyRule& rule : m.technology) {
    w.table("[[technology]]", "technology");
    w.word("on", technology_code(rule));
    write_key(w, rule, kTechnologyLimit);
  }
  if (m.stock) {
    w.table("[stock]", "stock");
    w.word("axis", std::string(1, m.stock->axis));
    write_key(w, *m.stock, kStockPosition);
    write_key(w, *m.stock, kStockBelow);
  }
  write_codes(w, m.codes);
  w.table("[log]", "log");
  write_keys(w, m.log, kLogKeys);
  write_key(w, m.log, kViewerRate);
}

}  // namespace

std::string render_machine(const MachineFile& file) {
  const MachineModel& m = file.model;
  TomlWriter w(file);
  w.line("format", "1");
  w.line("name", quoted(m.name));
  if (m.units) w.word(kProgramUnits.name, kStartUnits.word(*m.units));
  if (!m.startup.empty()) w.line(kProgramStartup.name, quoted(m.startup));
  write_key(w, m, kOnAlarm);
  write_settings(w, m);
  for (const AxisModel& axis : m.axis)
    write_axis(w, axis, m.home2[static_cast<std::size_t>(axis_index(axis.letter))]);
  return w.take();
}

}  // namespace kadr::machine
