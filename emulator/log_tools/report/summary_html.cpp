#include "emulator/log_tools/report/summary_html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/log_tools/diff/diff_fields.h"
#include "emulator/log_tools/export/charts.h"
#include "emulator/log_tools/report/path_svg.h"
#include "emulator/text/text.h"
#include "machine/base/hash.h"

namespace kadr::log_tools {
namespace {

constexpr std::size_t kRowsShown = 200;  ///< of alarms and messages

/// A cell or a head: text, and whether it is a word of the page that may be translated.
struct Cell {
  std::string text;
  bool word = false;
};
using Row = std::vector<Cell>;

Cell word(std::string text) { return {std::move(text), true}; }
Cell number(double value, int decimals, const std::string& unit) {
  return {text::fixed(value, decimals) + (unit.empty() ? "" : " " + unit)};
}

std::string cell_html(const char* tag, const Cell& cell) {
  return fmt::format("<{0}{1}>{2}</{3}>", tag, cell.word ? " class=\"w\"" : "", text::xml_text(cell.text),
                     std::string_view(tag).substr(0, 2));
}

std::string row_html(const Row& row, const std::string& attributes = "") {
  std::string out = "<tr" + attributes + ">";
  for (std::size_t k = 0; k < row.size(); ++k) out += cell_html(k == 0 ? "th scope=\"row\"" : "td", row[k]);
  return out + "</tr>\n";
}

std::string table_html(const char* id, const char* caption, const Row& head, const std::string& rows) {
  std::string out =
      fmt::format("<div class=\"scroll\"><table id=\"{}\"><caption class=\"w\">{}</caption>\n", id, caption);
  if (!head.empty()) {
    out += "<thead><tr>";
    for (const Cell& cell : head) out += cell_html("th scope=\"col\"", cell);
    out += "</tr></thead>\n";
  }
  return out + "<tbody>\n" + rows + "</tbody></table></div>\n";
}

/// A share of a limit: "98 %".
std::string share(double value, double limit) {
  return std::isfinite(limit) && limit > 0 ? fmt::format("{} %", text::fixed(100 * value / limit, 1)) : "";
}
std::string limit_text(double limit, int decimals) {
  return std::isfinite(limit) ? text::fixed(limit, decimals) : "-";
}

class Summary {
 public:
  explicit Summary(const PageData& data) : d_(data), h_(data.header) {}

  std::string html() const {
    std::string out;
    if (const std::string note = end_note(d_); !note.empty())
      out += fmt::format("<p class=\"warning\"><b class=\"w\">Warning</b> {}</p>\n", text::xml_text(note));
    out += messages();
    if (!d_.summary) return out;
    return out + "<div class=\"tables\">\n" + run() + reasons() + losses() + axes() + loads() + "</div>\n";
  }

 private:
  const log::RunSummary& s() const { return d_.summary->run; }

  std::string run() const {
    const std::string unit = path_unit(h_);
    std::string rows = row_html({word("outcome"), word(s().outcome.text())});
    rows += row_html({word("time"), number(h_.seconds(s().ticks), 3, "s")}, " id=\"total-time\"");
    rows += row_html({word("in motion"), number(s().motion_s, 3, "s")});
    rows += row_html({word("standing"), number(s().dwell_s, 3, "s")});
    rows += row_html({word("path"), number(s().path_u, 3, unit)});
    rows += row_html({word("feed, mean"), number(s().mean_feed_u_s, 3, unit + "/s")});
    const std::string per_minute =
        unit == "mm" ? fmt::format(" (F{})", text::fixed(60 * s().peak_feed_u_s, 0)) : "";
    rows +=
        row_html({word("feed, peak"), {text::fixed(s().peak_feed_u_s, 3) + " " + unit + "/s" + per_minute}});
    rows += row_html({word("path error, peak"),
                      d_.work.empty() ? word("not simulated") : number(1000 * s().path_error_u, 3, "um")});
    rows += row_html({word("blocks"), {text::grouped(s().blocks)}});
    rows += row_html({word("pulses"), {text::grouped(s().pulses)}});
    rows += row_html({word("steps hash"), {hash_text(s().steps_hash)}});
    return table_html("run", "Run", {}, rows);
  }

  static std::string shares(const std::vector<log::LimitShare>& list, double total_s) {
    std::string rows;
    for (const log::LimitShare& entry : list)
      rows += row_html({word(entry.limited_by),
                        number(entry.time_s, 3, "s"),
                        {total_s > 0 ? text::fixed(100 * entry.time_s / total_s, 1) + " %" : ""}});
    return rows;
  }

  std::string reasons() const {
    double total_s = 0;
    for (const log::LimitShare& entry : s().limited_by) total_s += entry.time_s;
    if (!(total_s > 0)) return {};
    return table_html("reasons", "What held the feed", {word("reason"), word("time"), word("share")},
                      shares(s().limited_by, total_s));
  }

  std::string losses() const {
    if (s().lost_by.empty()) return {};
    return table_html("losses", "Time lost against the plan at 100 %",
                      {word("reason"), word("time"), word("of the plan")},
                      shares(s().lost_by, s().planned_s));
  }

  std::string axes() const {
    std::string rows;
    for (std::size_t a = 0; a < s().axis.size() && a < h_.axis.size(); ++a) {
      const log::AxisSummary& x = s().axis[a];
      const std::string& unit = h_.axis[a].unit;
      const machine::AxisModel* m = d_.machine ? &d_.machine->axis[a] : nullptr;
      const auto against = [&](double value, double limit, int decimals, const char* per) {
        return Cell{fmt::format("{} {}{}", text::fixed(value, decimals),
                                m ? "/ " + limit_text(limit, decimals) + " " : "", unit + per)};
      };
      rows +=
          row_html({{h_.axis[a].name},
                    {text::grouped(x.pulses)},
                    {fmt::format("{} .. {} {}", text::fixed(x.min_u, 3), text::fixed(x.max_u, 3), unit)},
                    against(x.peak_feed_u_s, m ? m->max_feed_u_s : 0, 3, "/s"),
                    {m ? share(x.peak_feed_u_s, m->max_feed_u_s) : ""},
                    against(x.peak_accel_u_s2, m ? m->max_accel_u_s2 : 0, 1, "/s2"),
                    {m ? share(x.peak_accel_u_s2, m->max_accel_u_s2) : ""},
                    against(x.peak_jerk_u_s3, m ? m->max_jerk_u_s3 : 0, 0, "/s3"),
                    {m ? share(x.peak_jerk_u_s3, m->max_jerk_u_s3) : ""}},
                   x.peak_feed_u_s > 0 ? fmt::format(" data-t=\"{}\"", h_.seconds(x.peak_feed_tick)) : "");
    }
    return table_html("axes", "Axes against their limits",
                      {word("axis"), word("pulses"), word("range"), word("peak feed"), word("share"),
                       word("acceleration"), word("share"), word("jerk"), word("share")},
                      rows);
  }

  std::string loads() const {
    if (d_.work.empty()) return {};
    std::string rows;
    for (std::size_t a = 0; a < s().axis.size() && a < h_.axis.size(); ++a) {
      const log::AxisSummary& x = s().axis[a];
      if (!h_.axis[a].has_plant) {
        rows += row_html({{h_.axis[a].name}, word("rigid (not modelled)")});
        continue;
      }
      const std::string unit = h_.axis[a].unit == "deg" ? "mdeg" : "um";
      const bool moved = x.peak_vibration_u > 0;
      std::string place = moved ? fmt::format(" data-t=\"{}\"", h_.seconds(x.peak_vibration_tick)) : "";
      if (moved && x.peak_vibration_line > 0)
        place += fmt::format(" data-line=\"{}\"", x.peak_vibration_line);
      rows += row_html({{h_.axis[a].name},
                        number(1000 * x.peak_vibration_u, 3, unit),
                        number(1000 * x.rms_vibration_u, 3, unit),
                        {moved ? text::fixed(h_.seconds(x.peak_vibration_tick), 3) + " s" : ""},
                        {moved && x.peak_vibration_line > 0 ? std::to_string(x.peak_vibration_line) : ""},
                        number(1000 * x.residual_u, 3, unit),
                        number(1000 * x.peak_following_u, 3, unit),
                        {text::grouped(x.lost_steps.value)},
                        number(d_.work[a].driving_J, 3, "J"),
                        number(d_.work[a].braking_J, 3, "J")},
                       place);
    }
    return table_html(
        "loads", "Load (simulated)",
        {word("axis"), word("vibration, peak"), word("rms"), word("at"), word("line"), word("residual"),
         word("following error, peak"), word("lost steps"), word("work, driving"), word("braking")},
        rows);
  }

  /// Line of the program with a caret below the span; empty without its text.
  std::string caret(const Span& span) const {
    if (span.line == 0 || h_.program_text.empty()) return {};
    std::string_view rest = h_.program_text;
    for (std::uint32_t line = 1; line < span.line; ++line) {
      const auto end = rest.find('\n');
      if (end == std::string_view::npos) return {};
      rest = rest.substr(end + 1);
    }
    std::string_view text = rest.substr(0, rest.find('\n'));
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    if (text::display_width(text) > 160) text = text.substr(0, 160);
    const std::size_t before = std::min<std::size_t>(text.size(), span.column > 0 ? span.column - 1 : 0);
    const std::size_t length =
        std::max<std::size_t>(1, std::min<std::size_t>(span.length, text.size() - before));
    const std::string left = fmt::format("{} | ", span.line);
    return fmt::format(
        "<pre>{}{}\n{}{}{}</pre>", left, text::xml_text(text), std::string(left.size() - 2, ' ') + "| ",
        std::string(text::display_width(text.substr(0, before)), ' '),
        std::string(std::max<std::size_t>(1, text::display_width(text.substr(before, length))), '^'));
  }

  std::string message(std::string_view severity, double t_s, const Span& span, const std::string& code,
                      const std::string& text) const {
    std::string place;
    if (t_s >= 0) place += fmt::format(" data-t=\"{}\"", t_s);
    if (span.line > 0) place += fmt::format(" data-line=\"{}\"", span.line);
    return fmt::format(
        "<tr class=\"{}\"{}><th scope=\"row\" "
        "class=\"w\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}{}</td></tr>\n",
        severity, place, severity, t_s >= 0 ? text::fixed(t_s, 4) + " s" : "",
        span.line > 0 ? std::to_string(span.line) : "", text::xml_text(code), text::xml_text(text),
        caret(span));
  }

  /// Errors first, then alarms, warnings and notes; each kind in the log's order.
  std::string messages() const {
    std::string rows;
    std::size_t shown = 0, all = 0;
    const auto add = [&](std::string_view severity, Ticks tick, const Span& span, const std::string& code,
                         const std::string& text) {
      ++all;
      if (shown >= kRowsShown) return;
      ++shown;
      rows += message(severity, tick.value < 0 ? -1 : h_.seconds(tick), span, code, text);
    };
    const auto diagnostics = [&](Severity severity) {
      for (const log::LogDiagnostic& d : d_.diagnostics)
        if (d.severity == severity)
          add(kSeverities.word(severity), d.tick, d.span, d.code,
              d.message + (d.label.empty() ? "" : ": " + d.label));
    };
    diagnostics(Severity::error);
    for (const log::EventRecord& e : d_.events)
      if (e.kind == log::EventKind::alarm) add("alarm", e.tick, e.span, code_name(e.code), e.text);
    diagnostics(Severity::warning);
    diagnostics(Severity::note);
    if (all == 0) return "<p id=\"no-alarms\" class=\"w\">No alarms, no messages.</p>\n";
    if (all > shown)
      rows += fmt::format("<tr><td colspan=\"5\">... {} more in the log</td></tr>\n",
                          text::grouped(static_cast<std::int64_t>(all - shown)));
    return table_html("alarms", "Alarms and messages",
                      {word("severity"), word("at"), word("line"), word("code"), word("what")}, rows);
  }

  const PageData& d_;
  const log::LogHeader& h_;
};

}  // namespace

std::string page_title(const PageData& data) {
  return fmt::format("{} on {}", text::one_line(data.header.program_name, 80),
                     text::one_line(data.header.machine_name, 60));
}

std::string end_note(const PageData& data) {
  if (data.end.state == log::LogState::complete) return {};
  return fmt::format("{} What is shown ends at {} s.", data.end.detail,
                     text::fixed(data.header.seconds(data.end.valid_until), 6));
}

std::string summary_html(const PageData& data) { return Summary(data).html(); }

std::string chart_html(const PageData& data) {
  constexpr std::size_t kPieces = 2048;
  std::vector<Signal> signals;
  std::vector<std::vector<Envelope::Piece>> pieces;
  const double piece_s =
      data.header.seconds(Ticks{data.header.control_tick_ticks}) * static_cast<double>(data.every);
  const double begin_s = data.header.seconds(Ticks{data.first_control_tick * data.header.control_tick_ticks});
  for (const Track& track : data.tracks) {
    if (!matches_pattern(track.signal.name, "feed.commanded*") &&
        !matches_pattern(track.signal.name, "feed.programmed*") &&
        !matches_pattern(track.signal.name, "path.error*"))
      continue;
    Envelope envelope(begin_s, piece_s, kPieces);
    for (std::size_t i = 0; i < track.low.size(); ++i)
      for (const float value : {track.low[i], track.high[i]})
        envelope.add(begin_s + piece_s * static_cast<double>(i + 1), value);
    signals.push_back(track.signal);
    pieces.push_back(envelope.pieces());
  }
  std::string out = path_svg(data);
  for (const text::LineChart& chart : charts_of(signals, pieces)) out += text::render_svg(chart);
  return out;
}

}  // namespace kadr::log_tools
