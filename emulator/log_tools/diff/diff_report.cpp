#include "emulator/log_tools/diff/diff_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/log/log_info.h"
#include "emulator/text/text.h"
#include "machine/base/parse_number.h"
#include "machine/base/terminal_text.h"

namespace kadr::log_tools {
namespace {

using Align = text::TextTable::Align;

constexpr std::size_t kValueWidth = 64;  // cells of an event's text
constexpr std::size_t kNameWidth = 24;   // cells of a log's name in a table

std::string file_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

/// Titles of the columns of both logs: their file names, if they differ and are short.
std::pair<std::string, std::string> log_titles(const LogDiff& diff) {
  const std::string a = file_name(diff.a.path), b = file_name(diff.b.path);
  if (a == b || text::display_width(a) > kNameWidth || text::display_width(b) > kNameWidth) return {"A", "B"};
  return {text::one_line(a, kNameWidth), text::one_line(b, kNameWidth)};
}

std::string difference_text(const std::optional<double>& difference) {
  if (!difference || *difference == 0) return "";  // other bits, or no number
  return fmt::format("{:+.6g}", *difference);
}

/// "KADR_STEPS, block 17, part.ngc:42"
std::string where(const TickDifference& d) {
  std::string text(channel_name(d.fields.front().channel));
  const ProgramPlace& place = d.place_a.line > 0 ? d.place_a : d.place_b;
  if (place.line > 0) text += fmt::format(", block {}, {}", d.block, place.name());
  return text;
}

std::string seconds_text(const log::LogHeader& header, Ticks tick) {
  return fmt::format("{:.6f} s", header.seconds(tick));
}

/// The program's line, or both logs' lines where they are not the same.
std::string source_lines(const TickDifference& d) {
  const auto line = [](const ProgramPlace& place) {
    return place.text.empty()
               ? ""
               : fmt::format("  {} | {}\n", place.line, text::one_line(place.text, kValueWidth));
  };
  if (d.place_a == d.place_b) return line(d.place_a);
  return line(d.place_a) + line(d.place_b);
}

std::string field_table(const std::vector<FieldDifference>& differing,
                        const std::vector<FieldDifference>& same, const LogDiff& diff) {
  const auto [a, b] = log_titles(diff);
  text::TextTable table({{"field", Align::left}, {"unit", Align::left}, {a}, {b}, {"difference"}});
  for (const auto* list : {&differing, &same})
    for (const FieldDifference& f : *list)
      table.add({f.name(), f.unit, text::one_line(f.a, kValueWidth), text::one_line(f.b, kValueWidth),
                 difference_text(f.difference)});
  return table.render("  ");
}

std::string context_table(const FirstDifference& first, const LogDiff& diff) {
  const bool values = std::any_of(first.rows.begin(), first.rows.end(),
                                  [](const ContextRow& row) { return row.a != "-" || row.b != "-"; });
  if (first.rows.size() < 2 || !values) return "";
  const auto [a, b] = log_titles(diff);
  text::TextTable table({{"", Align::left}, {"control tick"}, {"end s"}, {"line", Align::left}, {a}, {b}});
  const std::int64_t tau = diff.a.header.control_tick_ticks;
  for (const ContextRow& row : first.rows)
    table.add({row.control_tick == first.tick.control_tick ? ">" : "", text::grouped(row.control_tick),
               fmt::format("{:.6f}", diff.a.header.seconds(Ticks{(row.control_tick + 1) * tau})), row.place,
               row.a, row.b});
  return fmt::format("around it: {}{}\n", first.context_name,
                     first.context_unit.empty() ? "" : ", " + first.context_unit) +
         table.render("  ");
}

std::string headline(const LogDiff& diff) {
  if (!diff.compared)
    return "logs not compared: their clocks differ, so control ticks do not mean the same time "
           "(--align path compares by path length)\n";
  if (diff.first) {
    const TickDifference& d = diff.first->tick;
    const Ticks begin{d.control_tick * diff.a.header.control_tick_ticks};
    return fmt::format("logs differ: first at control tick {} (from {}), {}\n", text::grouped(d.control_tick),
                       seconds_text(diff.a.header, begin), where(d));
  }
  if (diff.lengths_differ()) {
    const LogSide& longer = diff.a.control_ticks > diff.b.control_ticks ? diff.a : diff.b;
    const LogSide& shorter = diff.a.control_ticks > diff.b.control_ticks ? diff.b : diff.a;
    return fmt::format("logs differ: {} has {} more than {}; the {} of both are the same\n",
                       displayable(longer.path),
                       text::counted(longer.control_ticks - shorter.control_ticks, "control tick"),
                       displayable(shorter.path), text::grouped(diff.both));
  }
  if (!diff.summary.empty()) return "logs differ: in KADR_SUMMARY alone\n";
  return fmt::format("no difference in {}\n", text::counted(diff.both, "control tick"));
}

std::string inputs_line(const std::vector<InputDifference>& inputs) {
  std::string text;
  for (const InputDifference& input : inputs) {
    text +=
        fmt::format("{}{} {}", text.empty() ? "inputs: " : ", ", input.name, input.same ? "same" : "differs");
    if (input.same && !input.detail.empty()) text += " (" + displayable(input.detail) + ")";
  }
  return text + "\n";
}

std::string totals(const LogDiff& diff) {
  text::TextTable table(
      {{"channel", Align::left}, {"control ticks that differ"}, {"first at"}, {"what", Align::left}});
  for (std::size_t c = 0; c < kDiffChannels; ++c) {
    const ChannelTotals& t = diff.channels[c];
    if (!t.first) continue;
    const auto channel = static_cast<DiffChannel>(c);
    const FieldDifference& f = *t.first;
    const std::string difference = difference_text(f.difference);
    table.add({std::string(channel_name(channel)) + (channel == DiffChannel::load ? " load" : ""),
               fmt::format("{} of {}", text::grouped(t.differing), text::grouped(diff.both)),
               text::grouped(t.first_control_tick),
               fmt::format("{} {} | {}{}{}", f.name(), text::one_line(f.a, kNameWidth * 2),
                           text::one_line(f.b, kNameWidth * 2), f.unit.empty() ? "" : " " + f.unit,
                           difference.empty() ? "" : " (" + difference + ")")});
  }
  return table.empty() ? "" : "totals\n" + table.render("  ");
}

/// Largest differences of the plant's states: the tolerance that would be needed.
std::string peaks(const LogDiff& diff) {
  if (diff.load_peaks.empty()) return "";
  text::TextTable table(
      {{"plant state", Align::left}, {"unit", Align::left}, {"largest difference"}, {"control tick"}});
  for (const LoadPeak& p : diff.load_peaks)
    table.add(
        {p.axis + " " + p.field, p.unit, fmt::format("{:.6g}", p.difference), text::grouped(p.control_tick)});
  return table.render("  ");
}

std::string ends(const LogDiff& diff) {
  std::string text;
  for (const LogSide* side : {&diff.a, &diff.b})
    if (const std::string end = end_text(*side); !end.empty()) text += end + "\n";
  if (diff.a.summary && diff.b.summary) {
    if (diff.summary.empty()) return text + "end: position, time, pulses and outcome same\n";
    return text + "end (KADR_SUMMARY)\n" + field_table(diff.summary, {}, diff);
  }
  if (diff.lengths_differ())
    text += fmt::format("control ticks: {} | {}, compared as far as both go\n",
                        text::grouped(diff.a.control_ticks), text::grouped(diff.b.control_ticks));
  return text;
}

}  // namespace

std::string end_text(const LogSide& side) {
  return side.end.detail.empty()
             ? ""
             : fmt::format("{}: {}", displayable(side.path), displayable(side.end.detail));
}

std::string render_input_differences(const std::vector<InputDifference>& inputs) {
  text::TextTable table({{"inputs differ", Align::left}, {"", Align::left}});
  for (const InputDifference& input : inputs)
    if (!input.same) table.add({"  " + input.name, input.detail});
  return table.empty() ? "" : table.render();
}

std::string render_tick_difference(const TickDifference& d, const LogDiff& logs) {
  std::string text;
  for (const FieldDifference& f : d.fields) {
    const ProgramPlace& place = d.place_a.line > 0 ? d.place_a : d.place_b;
    const std::string difference = difference_text(f.difference);
    text +=
        fmt::format("{} {} {} {} {} {} | {}{}{}\n", d.control_tick, seconds_text(logs.a.header, f.tick),
                    place.line > 0 ? place.name() : "-", channel_name(f.channel), f.name(),
                    text::one_line(f.a, kValueWidth), text::one_line(f.b, kValueWidth),
                    f.unit.empty() ? "" : " " + f.unit, difference.empty() ? "" : " (" + difference + ")");
  }
  return text;
}

std::string render_log_diff(const LogDiff& diff) {
  std::string text = headline(diff);
  if (diff.first) {
    text += source_lines(diff.first->tick);
    text += field_table(diff.first->tick.fields, diff.first->same, diff);
    text += context_table(*diff.first, diff);
    if (!diff.first->input.empty())
      text += "nearest input before: " + text::one_line(diff.first->input, 100) + "\n";
    if (!diff.first->event.empty())
      text += "nearest event before: " + text::one_line(diff.first->event, 100) + "\n";
  }
  text += inputs_line(diff.inputs);
  if (!diff.compared) return text;
  text += totals(diff);
  text += peaks(diff);
  text += ends(diff);
  return text;
}

}  // namespace kadr::log_tools
