#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "emulator/scenario/scenario.h"
#include "emulator/scenario/scenario_keys.h"
#include "machine/base/hash.h"
#include "machine/file/code_table.h"
#include "machine/file/named_file.h"
#include "machine/file/table_reader.h"
#include "machine/file/technology.h"
#include "scenarios/generator/wind.h"

namespace kadr::scenario {
namespace {

namespace fs = std::filesystem;
using machine::file_diagnostic;
using machine::Node;
using machine::read_number;
using machine::TableReader;

constexpr machine::Bounds kVibration{0, 1e9};
constexpr std::size_t kMostSettings = 1000;  // each is looked up among all others

/// Reads one scenario file; mistakes go to the context's diagnostics.
class ScenarioReader {
 public:
  ScenarioReader(const SourceSet& sources, std::uint32_t file, Scenario& scenario,
                 machine::ReadContext& context)
      : source_(sources[file]), scenario_(scenario), context_(context) {}

  void read(const Node& root, std::uint32_t file) {
    TableReader table(&root, "", Span{file, 1, 1, 1}, context_);
    const auto format = read_number(table, kScenarioFormat);
    if (format.valid && format.value != 1)
      tell(Code::file_format, format.span,
           fmt::format("is edition {:.0f}, this kadr reads edition 1", format.value));
    scenario_.name = table.text(kScenarioName.name).value;
    scenario_.summary = table.text(kSummary.name, "").value;
    read_program(table);
    read_machine_name(table);
    read_tools(table);
    scenario_.dialect = table.choice(kDialect.name, gcode::kDialects, gcode::Dialect::linuxcnc).value;
    scenario_.from_line = read_line(table, kFromLine);
    scenario_.to_line = read_line(table, kToLine);
    read_ini(table);
    scenario_.ignored = machine::read_code_names(table.texts(kIgnore.name), {}, context_.diagnostics);
    if (const Node* hal = table.table("hal")) read_hal(*hal, "");
    if (const Node* settings = table.table("settings")) flatten_settings(*settings, "");
    // the stock of a scenario overrides that of the machine file
    if (const Node* stock = table.table("stock")) flatten_settings(*stock, "stock");
    for (const Node& point : table.tables("technology")) read_technology(point);
    for (const Node& step : table.tables("step"))
      if (!context_.diagnostics.full()) read_step(step);
    read_most_override(table);
    if (const Node* expect = table.table("expect")) read_expect(*expect);
    table.finish();
  }

 private:
  void tell(Code code, const Span& span, std::string label, std::string help = "") {
    Diagnostic d = file_diagnostic(code, span, std::move(label));
    d.help = std::move(help);
    context_.diagnostics.add(std::move(d));
  }

  static std::optional<std::uint32_t> read_line(TableReader& table, const NumberKey& key) {
    if (!table.has(key.name)) return std::nullopt;
    return static_cast<std::uint32_t>(read_number(table, key).value);
  }

  void read_technology(const Node& node) {
    TableReader keys(&node, "technology", node.span, context_);
    ScenarioTechnology point;
    point.span = node.span;
    if (keys.has(kPointLine.name)) {
      const auto line = read_number(keys, kPointLine);
      point.line = static_cast<std::uint32_t>(line.value);
      point.span = line.span;
      point.rule.max_u_s = machine::read_technology_limit(keys);
    } else if (keys.has(kPointPath.name)) {
      const auto at = read_number(keys, kPointPath);
      point.path_u = at.value;
      point.span = at.span;
      point.rule.max_u_s = machine::read_technology_limit(keys);
    } else {
      point.rule = machine::read_technology_rule(keys);
    }
    keys.finish();
    scenario_.technology.push_back(point);
  }

  void read_program(TableReader& table) {
    const Node* wind = table.table("wind");
    if (wind) {
      read_winding(*wind);
      if (table.has(kProgram.name))
        tell(Code::scenario_program, table.text(kProgram.name).span, "a winding is given as well",
             "keep one of program and [wind]");
      return;
    }
    const auto program = table.text(kProgram.name);
    if (!program.valid) return;
    scenario_.program_name = fs::path(program.value).filename().string();
    scenario_.program_file = program.value;
    look_for(program);
  }

  /// The file that a key names.
  void look_for(const machine::Reading<std::string>& name) {
    const InputFile file = scenario_.input(name.value);
    if (machine::look_for(file, name.span, context_.diagnostics) == InputPlace::missing)
      tell(Code::scenario_file_missing, name.span, missing_text(file));
  }

  void read_winding(const Node& node) {
    TableReader table(&node, "wind", node.span, context_);
    std::vector<std::string_view> kinds;
    for (const auto& k : scenarios::wind_kinds()) kinds.push_back(k.name);
    const auto kind = table.word("kind", kinds);
    const std::string_view kind_name = kinds[kind.value];
    scenarios::WindSettings settings;
    for (const scenarios::WindParameter& p : scenarios::wind_parameters(kind_name)) {
      const auto value = table.number(p.key, {p.least, p.most, false, p.whole}, p.preset);
      if (table.has(p.key)) settings.emplace_back(p.key, value.value);
    }
    const std::size_t errors = context_.diagnostics.errors();
    table.finish();
    if (context_.diagnostics.errors() != errors || !kind.valid) return;
    const auto winding = scenarios::wind(kind_name, settings);
    if (!winding) return tell(Code::scenario_program, node.span, winding.error());
    scenario_.program_name = fmt::format("wind_{}.ngc", kind_name);
    scenario_.generated_program =
        scenarios::render_winding(*winding, scenarios::wind_command(kind_name, settings));
  }

  void read_machine_name(TableReader& table) {
    const auto name = table.text(kMachine.name);
    if (!name.valid) return;
    scenario_.machine = name.value;
    if (!machine::shipped_machine(name.value).empty()) return;
    scenario_.machine_is_file = true;
    const InputFile file = scenario_.input(name.value);
    if (machine::look_for(file, name.span, context_.diagnostics) != InputPlace::missing) return;
    std::string known;
    for (const auto shipped : machine::shipped_machine_names())
      known += fmt::format("{}{}", known.empty() ? "" : ", ", shipped);
    tell(Code::scenario_file_missing, name.span,
         fmt::format("there is no machine '{}' and no such file", name.value),
         fmt::format("machines that ship with kadr: {}", known));
  }

  void read_tools(TableReader& table) {
    if (!table.has(kTools.name)) return;
    const auto name = table.text(kTools.name);
    if (!name.valid) return;
    scenario_.tools_file = name.value;
    look_for(name);
  }

  void read_ini(TableReader& table) {
    if (!table.has(kIni.name)) return;
    const auto name = table.text(kIni.name);
    if (!name.valid) return;
    scenario_.ini_file = name.value;
    look_for(name);
  }

  /// plasmac.feed = 1 is the pin plasmac.feed, as "plasmac.feed" = 1 is.
  void read_hal(const Node& node, const std::string& prefix) {
    TableReader table(&node, prefix.empty() ? "hal" : "hal." + prefix, node.span, context_);
    for (const machine::Entry& entry : node.entries) {
      const std::string name = prefix.empty() ? entry.key : prefix + "." + entry.key;
      if (entry.value.kind == Node::Kind::table) {
        read_hal(*table.table(entry.key), name);
        continue;
      }
      const auto value = table.number(entry.key, kAny);
      if (!gcode::is_hal_name(name)) {
        tell(Code::scenario_value, entry.key_span, fmt::format("'{}' is no name of a pin", name));
      } else if (value.valid) {
        scenario_.hal.push_back({name, value.value});
      }
    }
    table.finish();
  }

  /// planner.axis_limits = "report" becomes the setting planner.axis_limits="report".
  void flatten_settings(const Node& node, const std::string& prefix) {
    for (const machine::Entry& entry : node.entries) {
      const std::string key = prefix.empty() ? entry.key : prefix + "." + entry.key;
      if (entry.value.kind == Node::Kind::table) {
        flatten_settings(entry.value, key);
        continue;
      }
      const Span& span = entry.value.span;
      if (scenario_.settings.size() >= kMostSettings) {
        if (std::exchange(settings_full_, true)) return;
        return tell(Code::file_setting, span, fmt::format("more than {} settings", kMostSettings));
      }
      scenario_.settings.push_back(
          fmt::format("{}={}", key, source_.line(span.line).substr(span.column - 1, span.length)));
    }
  }

  /// When or where a step is: one of kMomentKeys.
  void read_moment(TableReader& table, ScenarioStep& step) {
    const auto place = [&](const NumberKey& key, cycle::PathPlace::Kind kind) {
      const auto at = read_number(table, key);
      step.place = cycle::PathPlace{kind, at.value};
      step.span = at.span;
    };
    if (table.has(kAtLine.name)) {
      place(kAtLine, cycle::PathPlace::Kind::line);
      if (table.has(kPass.name)) step.place->pass = static_cast<int>(read_number(table, kPass).value);
    } else if (table.has(kAtBlock.name)) {
      place(kAtBlock, cycle::PathPlace::Kind::block);
    } else if (table.has(kAtPath.name)) {
      place(kAtPath, cycle::PathPlace::Kind::length);
    } else if (table.has(kAtTick.name)) {
      const auto tick = read_number(table, kAtTick);
      step.at_tick = static_cast<std::int64_t>(tick.value);
      step.span = tick.span;
    } else {
      const auto time = read_number(table, kAtS);
      step.at_s = time.value;
      step.span = time.span;
    }
    if (step.place && table.has(kAfter.name)) step.place->after_u = read_number(table, kAfter).value;
  }

  void read_action(TableReader& table, const ActionKey& key, ScenarioStep& step) {
    switch (key.takes) {
      case ActionKey::Takes::percent:
        step.value = table.number(key.name, key.bounds).value / 100;
        break;
      case ActionKey::Takes::flag:
        if (!table.flag(key.name, true).value)
          tell(Code::scenario_step, table.header(), fmt::format("{} = false does nothing", key.name),
               "leave the step out, or write true");
        break;
      case ActionKey::Takes::input:
        step.analog = key.name == "analog_input";
        step.number = static_cast<int>(table.number(key.name, key.bounds).value);
        step.value = read_number(table, step.analog ? kAnalogValue : kDigitalValue).value;
        break;
    }
    step.action = key.action;
  }

  void read_step(const Node& node) {
    TableReader table(&node, "step", node.span, context_);
    ScenarioStep step;
    read_moment(table, step);
    int actions = 0;
    std::string names;
    for (const ActionKey& key : kActionKeys) {
      names += fmt::format("{}{}", names.empty() ? "" : ", ", key.name);
      if (table.has(key.name) && ++actions == 1) read_action(table, key, step);
    }
    if (step.action == cycle::OperatorAction::spindle_load && table.has(kForS.name))
      step.for_s = read_number(table, kForS).value;
    if (actions == 0) return tell(Code::scenario_step, node.span, "does nothing", "one of " + names);
    if (actions > 1)
      return tell(Code::scenario_step, node.span, fmt::format("does {} things at once", actions),
                  "write a [[step]] for each, at the same tick if need be");
    if (!step.action && step.place)
      return tell(Code::scenario_step, step.span, "an input changes at a time, not at a position",
                  "write at_s or at_tick");
    if (step.place && step.for_s > 0)
      return tell(Code::scenario_step, step.span, "for_s counts from a time, not from a position",
                  "write a second step where the load falls again");
    table.finish();
    scenario_.steps.push_back(step);
  }

  /// The highest override that the run must be able to follow; no step goes beyond it.
  void read_most_override(TableReader& table) {
    if (!table.has(kMostOverride.name)) return;
    const auto most = read_number(table, kMostOverride);
    if (!most.valid) return;
    scenario_.most_override = most.value / 100;
    for (const ScenarioStep& step : scenario_.steps)
      if (step.action == cycle::OperatorAction::feed_override && step.value > *scenario_.most_override)
        tell(Code::scenario_step, step.span,
             fmt::format("an override of {:.6g} % is above {} = {:.6g}", 100 * step.value, kMostOverride.name,
                         most.value),
             fmt::format("raise {}, or leave it out", kMostOverride.name));
  }

  void read_expect(const Node& node) {
    TableReader table(&node, "expect", node.span, context_);
    Expectations& expect = scenario_.expect;
    if (table.has(kTimeS.name)) {
      expect.time_s = read_number(table, kTimeS).value;
      expect.within_s = read_number(table, kWithin).value;
    }
    if (table.has(kStepsHash.name)) expect.steps_hash = read_hash(table.text(kStepsHash.name));
    if (const Node* alarms = table.table(kAlarms.name)) read_alarms(*alarms);
    for (const auto& item : table.texts(kDiagnostics.name))
      if (const auto code = known_code(item.value, item.span)) expect.diagnostics.push_back(*code);
    if (const Node* axes = table.table("axis"))
      for (const machine::Entry& entry : axes->entries) read_axis(entry);
    for (const Node& signal : table.tables("signal")) read_signal(signal);
    for (const Node& boundary : table.tables("boundary")) read_boundary(boundary);
    table.finish();
  }

  void read_signal(const Node& node) {
    TableReader table(&node, "expect.signal", node.span, context_);
    SignalExpectation s;
    const auto name = table.text(kSignalName.name);
    s.signal = name.value;
    s.span = name.span;
    machine::read_keys(table, s, kSignalKeys);
    if (s.least == -machine::kInfinity && s.most == machine::kInfinity)
      tell(Code::scenario_value, s.span, "has neither least nor most", "write least, most or both");
    table.finish();
    scenario_.expect.signals.push_back(std::move(s));
  }

  void read_boundary(const Node& node) {
    TableReader table(&node, "expect.boundary", node.span, context_);
    BoundaryExpectation b;
    b.span = node.span;
    machine::read_keys(table, b, kBoundaryKeys);
    table.finish();
    scenario_.expect.boundaries.push_back(b);
  }

  std::optional<std::uint64_t> read_hash(const machine::Reading<std::string>& text) {
    if (!text.valid) return {};
    std::uint64_t value = 0;
    const char* end = text.value.data() + text.value.size();
    const auto [at, error] = std::from_chars(text.value.data(), end, value, 16);
    if (error == std::errc{} && at == end && text.value.size() == 16) return value;
    tell(Code::scenario_value, text.span, "a hash has 16 hexadecimal digits",
         "kadr scenario run --update writes the measured one");
    return {};
  }

  std::optional<Code> known_code(const std::string& text, const Span& span) {
    const auto code = parse_code(text);
    if (!code)
      tell(Code::scenario_value, span, fmt::format("there is no code {}", text),
           "kadr explain --list lists all");
    return code;
  }

  void read_alarms(const Node& node) {
    TableReader table(&node, "expect.alarms", node.span, context_);
    for (const machine::Entry& entry : node.entries) {
      const auto count = table.number(entry.key, kWholeCount);
      if (const auto code = known_code(entry.key, entry.key_span))
        scenario_.expect.alarms.emplace_back(*code, static_cast<std::int64_t>(count.value));
    }
    table.finish();
    std::sort(scenario_.expect.alarms.begin(), scenario_.expect.alarms.end());
  }

  void read_axis(const machine::Entry& entry) {
    if (entry.key.size() != 1 || axis_index(entry.key.front()) < 0)
      return tell(Code::scenario_value, entry.key_span, fmt::format("'{}' is not an axis letter", entry.key),
                  fmt::format("axes are named by one of {}", kAxisLetters));
    AxisExpectation axis;
    axis.letter = entry.key.front();
    TableReader table(&entry.value, "expect.axis." + entry.key, entry.key_span, context_);
    // U V W may be of either kind
    bool rotary = is_rotary_letter(axis.letter);
    if (std::string_view("UVW").find(axis.letter) != std::string_view::npos)
      for (const RangeKey& key : kAxisRanges) rotary = rotary || table.has(key.rotary);
    const auto count = [&](const NumberKey& key, std::optional<std::int64_t>& member) {
      if (table.has(key.name)) member = static_cast<std::int64_t>(read_number(table, key).value);
    };
    count(kPulses, axis.pulses);
    count(kEndSteps, axis.end_steps);
    for (const RangeKey& key : kAxisRanges) {
      const std::string_view name = rotary ? key.rotary : key.linear;
      if (!table.has(name)) continue;
      const auto pair = table.pair(name, kVibration);
      axis.*key.member = ValueRange{pair.value.first / 1000, pair.value.second / 1000};
    }
    table.finish();
    scenario_.expect.axis.push_back(axis);
  }

  const SourceText& source_;
  bool settings_full_ = false;  ///< told that there are too many
  Scenario& scenario_;
  machine::ReadContext& context_;
};

}  // namespace

tl::expected<Scenario, Diagnostics> read_scenario(const InputFile& file, SourceSet& sources,
                                                  const std::vector<std::string>& allowed) {
  const bool is_folder = !file.folders && fs::is_directory(file.path);
  const InputFile found = is_folder ? InputFile("scenario.toml", InputFolders{file.path, allowed}) : file;
  return read_scenario(SourceText::open(found, kMostSettings_bytes), sources, allowed);
}

tl::expected<Scenario, Diagnostics> read_scenario(SourceText text, SourceSet& sources,
                                                  const std::vector<std::string>& allowed) {
  Scenario scenario;
  scenario.file = text.name();
  scenario.folders = {fs::path(scenario.file).parent_path().string(), allowed};
  const std::uint32_t file = sources.add(std::move(text));
  scenario.text = sources[file].text();
  Diagnostics diagnostics;
  const machine::ParsedTree tree = machine::parse_toml(sources, file, diagnostics);
  machine::ReadContext context{diagnostics, sources, tree.complete, {}};
  ScenarioReader(sources, file, scenario, context).read(tree.root, file);
  if (diagnostics.has_errors()) return tl::unexpected(std::move(diagnostics));
  return scenario;
}

}  // namespace kadr::scenario
