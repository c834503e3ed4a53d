#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "emulator/scenario/scenario.h"
#include "machine/base/hash.h"
#include "machine/base/parse_number.h"
#include "machine/file/tree.h"

namespace kadr::scenario {
namespace {

using machine::Entry;
using machine::Node;

/// A piece of the file and its replacement.
struct Replacement {
  Span span;
  std::string text;
};

std::string alarms_text(const std::vector<std::pair<Code, std::int64_t>>& alarms) {
  std::string out;
  for (const auto& [code, count] : alarms)
    out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", code_name(code), count);
  return out.empty() ? "{}" : "{ " + out + " }";
}

std::string diagnostics_text(const std::vector<Code>& codes) {
  std::string out;
  for (const Code code : codes) out += fmt::format("{}\"{}\"", out.empty() ? "" : ", ", code_name(code));
  return "[" + out + "]";
}

std::string quoted_hash(const log::RunSummary& summary) {
  return "\"" + hash_text(summary.steps_hash) + "\"";
}

void replace_axis(const Entry& axis, const ScenarioResult& result, const machine::MachineModel& machine,
                  std::vector<Replacement>& out) {
  const int index = axis.key.size() == 1 ? machine.find_axis(axis.key.front()) : -1;
  if (index < 0) return;
  const log::AxisSummary& measured = result.summary->axis.at(static_cast<std::size_t>(index));
  if (const Entry* e = axis.value.find("pulses"))
    out.push_back({e->value.span, fmt::format("{}", measured.pulses)});
  if (const Entry* e = axis.value.find("end_steps"))
    out.push_back({e->value.span, fmt::format("{}", measured.end_steps.value)});
}

void replace_boundary(const Node& node, const ScenarioResult& result, std::vector<Replacement>& out) {
  const Entry* block = node.find("block");
  if (!block) return;
  for (const BoundaryExpectation& b : result.boundaries) {
    if (static_cast<double>(b.block) != block->value.number) continue;
    const auto put = [&](std::string_view key, std::string text) {
      if (const Entry* e = node.find(key)) out.push_back({e->value.span, std::move(text)});
    };
    put("control_tick", fmt::format("{}", b.control_tick));
    put("offset", fmt::format("{}", b.offset));
    put("feed_mm_s", fmt::format("{:.4f}", b.feed_u_s));
    put("planned_mm_s", fmt::format("{:.4f}", b.planned_u_s));
    put("deferred_ticks", fmt::format("{}", b.deferred_ticks));
  }
}

std::vector<Replacement> replacements(const Node& expect, const ScenarioResult& result,
                                      const machine::MachineModel& machine) {
  std::vector<Replacement> out;
  if (const Entry* e = expect.find("diagnostics"))
    out.push_back({e->value.span, diagnostics_text(result.codes)});
  if (!result.summary) return out;
  if (const Entry* e = expect.find("time_s")) out.push_back({e->value.span, number_text(result.machine_s)});
  if (const Entry* e = expect.find("steps_hash"))
    out.push_back({e->value.span, quoted_hash(*result.summary)});
  if (const Entry* e = expect.find("alarms")) out.push_back({e->value.span, alarms_text(result.alarms)});
  if (const Entry* e = expect.find("boundary"))
    for (const Node& boundary : e->value.items) replace_boundary(boundary, result, out);
  if (const Entry* e = expect.find("axis"))
    for (const Entry& axis : e->value.entries) replace_axis(axis, result, machine, out);
  return out;
}

/// An [expect] with all exact values.
std::string whole_expect(const ScenarioResult& result, const machine::MachineModel& machine) {
  std::string out = "\n[expect]\n";
  if (!result.codes.empty()) out += "diagnostics = " + diagnostics_text(result.codes) + "\n";
  if (!result.summary) return out;
  out += fmt::format("time_s = {}\nwithin_s = 0.000001\nsteps_hash = {}\n", number_text(result.machine_s),
                     quoted_hash(*result.summary));
  if (!result.alarms.empty()) out += "alarms = " + alarms_text(result.alarms) + "\n";
  for (std::size_t a = 0; a < machine.axis.size(); ++a)
    out += fmt::format("\n[expect.axis.{}]\npulses = {}\nend_steps = {}\n", machine.axis[a].letter,
                       result.summary->axis[a].pulses, result.summary->axis[a].end_steps.value);
  return out;
}

/// Byte offset of each line's beginning; [0] unused.
std::vector<std::size_t> line_starts(const std::string& text) {
  std::vector<std::size_t> starts = {0, 0};
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n') starts.push_back(i + 1);
  return starts;
}

/// End of the value at `at`: a span ends with its first line, a list or table may continue. No string of a list
/// or table that is replaced holds a bracket.
std::size_t value_end(const std::string& text, std::size_t at, std::size_t length) {
  const char close = text[at] == '[' ? ']' : text[at] == '{' ? '}' : '\0';
  return close == '\0' ? at + length : text.find(close, at) + 1;
}

}  // namespace

std::string updated_text(const Scenario& scenario, const ScenarioResult& result) {
  if (!result.failure.empty()) return scenario.text;
  SourceSet sources;
  cycle::JobInputs given;
  Diagnostics ignored;
  if (!open_job(scenario, given, sources, ignored)) return scenario.text;
  const std::uint32_t file = sources.add(SourceText(scenario.file, scenario.text));
  const machine::ParsedTree tree = machine::parse_toml(sources, file, ignored);
  const Entry* expect = tree.root.find("expect");
  if (!expect) return scenario.text + whole_expect(result, given.machine.model);

  // from the back, so that earlier positions stay valid
  std::vector<Replacement> list = replacements(expect->value, result, given.machine.model);
  std::sort(list.begin(), list.end(), [](const Replacement& a, const Replacement& b) {
    return std::pair(a.span.line, a.span.column) > std::pair(b.span.line, b.span.column);
  });
  std::string text = scenario.text;
  const auto starts = line_starts(text);
  for (const Replacement& r : list) {
    const std::size_t at = starts[r.span.line] + r.span.column - 1;
    text.replace(at, value_end(text, at, r.span.length) - at, r.text);
  }
  return text;
}

}  // namespace kadr::scenario
