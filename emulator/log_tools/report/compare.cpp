#include "emulator/log_tools/report/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/log_tools/diff/diff_fields.h"
#include "emulator/log_tools/report/built_pages.h"
#include "emulator/log_tools/report/page_style.h"
#include "emulator/log_tools/report/report_page.h"
#include "emulator/log_tools/report/run_data.h"
#include "emulator/text/line_chart.h"
#include "emulator/text/text.h"
#include "machine/base/hash.h"
#include "machine/base/terminal_text.h"

namespace kadr::log_tools {
namespace {

using text::Json;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostReasons = 6;

const log::RunSummary& summary(const ComparedRun& run) { return run.data.summary->run; }

/// Runs are named A, B, C ... in tables and charts; their files are listed once above.
std::string letter(std::size_t k) { return std::string(1, static_cast<char>('A' + k)); }

template <class Get>
void add(std::vector<ComparedQuantity>& out, const std::vector<ComparedRun>& runs, const std::string& name,
         const std::string& key, const std::string& unit, int decimals, Get get) {
  ComparedQuantity q{name, key, unit, decimals, {}};
  bool some = false;
  for (const ComparedRun& run : runs) {
    q.value.push_back(get(run));
    some |= !std::isnan(q.value.back());
  }
  if (some) out.push_back(std::move(q));
}

double reason_s(const ComparedRun& run, const std::string& reason) {
  for (const log::LimitShare& share : summary(run).limited_by)
    if (share.limited_by == reason) return share.time_s;
  return 0;
}

std::string key_of(std::string name) {
  for (char& c : name)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))) c = '_';
  return name;
}

void add_axes(std::vector<ComparedQuantity>& out, const std::vector<ComparedRun>& runs) {
  const log::LogHeader& h = runs.front().data.header;
  for (std::size_t a = 0; a < h.axis.size(); ++a) {
    const std::string& axis = h.axis[a].name;
    const std::string small = h.axis[a].unit == "deg" ? "mdeg" : "um";
    const auto plant = [a](const ComparedRun& run) {
      return a < run.data.work.size() && a < summary(run).axis.size() && run.data.header.axis[a].has_plant;
    };
    add(out, runs, "vibration " + axis + ", peak", "vibration_" + axis + "_" + small, small, 3,
        [&](const ComparedRun& r) { return plant(r) ? 1000 * summary(r).axis[a].peak_vibration_u : kNone; });
    add(out, runs, "residual " + axis, "residual_" + axis + "_" + small, small, 3,
        [&](const ComparedRun& r) { return plant(r) ? 1000 * summary(r).axis[a].residual_u : kNone; });
    add(out, runs, "following " + axis + ", peak", "following_" + axis + "_" + small, small, 3,
        [&](const ComparedRun& r) { return plant(r) ? 1000 * summary(r).axis[a].peak_following_u : kNone; });
    add(out, runs, "work " + axis + ", driving", "work_" + axis + "_J", "J", 4,
        [&](const ComparedRun& r) { return plant(r) ? r.data.work[a].driving_J : kNone; });
  }
}

const Track* track(const ComparedRun& run, const char* pattern) {
  for (const Track& t : run.data.tracks)
    if (matches_pattern(t.signal.name, pattern)) return &t;
  return nullptr;
}

/// A signal over time, or over the length of path; highest value of each piece.
text::ChartLine line(const ComparedRun& run, std::size_t k, const char* pattern, bool over_path) {
  text::ChartLine out{letter(k), fmt::format("s{}", k % 6), {}, 1};
  const Track* t = track(run, pattern);
  if (t == nullptr) return out;
  const log::LogHeader& h = run.data.header;
  for (std::size_t i = 0; i < t->high.size(); ++i) {
    if (std::isnan(t->high[i])) continue;
    const std::int64_t passed =
        run.data.first_control_tick + static_cast<std::int64_t>(i + 1) * run.data.every;
    out.points.push_back(
        {over_path ? 1e-3 * run.data.path_milli[i] : h.seconds(Ticks{passed * h.control_tick_ticks}),
         t->high[i]});
  }
  return out;
}

std::string chart(const std::vector<ComparedRun>& runs, const char* id, const char* title,
                  const char* pattern, bool over_path, const std::string& y_label) {
  text::LineChart drawing;
  drawing.id = id;
  drawing.description = fmt::format("{} of {} runs; the table has their numbers.", title, runs.size());
  drawing.x_label = over_path ? "path, " + path_unit(runs.front().data.header) : "t, s";
  drawing.y_label = y_label;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    text::ChartLine l = line(runs[k], k, pattern, over_path);
    if (!l.points.empty()) drawing.lines.push_back(std::move(l));
  }
  return drawing.lines.empty() ? "" : fmt::format("<h2>{}</h2>\n{}", title, text::render_svg(drawing));
}

}  // namespace

std::vector<ComparedQuantity> compared_quantities(const std::vector<ComparedRun>& runs) {
  std::vector<ComparedQuantity> out;
  const std::string unit = path_unit(runs.front().data.header);
  add(out, runs, "time", "time_s", "s", 3,
      [](const ComparedRun& r) { return r.data.header.seconds(summary(r).ticks); });
  add(out, runs, "in motion", "motion_s", "s", 3, [](const ComparedRun& r) { return summary(r).motion_s; });
  add(out, runs, "standing", "dwell_s", "s", 3, [](const ComparedRun& r) { return summary(r).dwell_s; });
  std::vector<std::string> reasons;
  for (const ComparedRun& run : runs)
    for (const log::LimitShare& share : summary(run).limited_by)
      if (std::find(reasons.begin(), reasons.end(), share.limited_by) == reasons.end() &&
          reasons.size() < kMostReasons)
        reasons.push_back(share.limited_by);
  for (const std::string& reason : reasons)
    add(out, runs, "limited by " + reason, "limited_by_" + key_of(reason) + "_s", "s", 3,
        [&](const ComparedRun& r) { return reason_s(r, reason); });
  add(out, runs, "path", "path_u", unit, 3, [](const ComparedRun& r) { return summary(r).path_u; });
  add(out, runs, "feed, mean", "mean_feed_u_s", unit + "/s", 3,
      [](const ComparedRun& r) { return summary(r).mean_feed_u_s; });
  add(out, runs, "feed, peak", "peak_feed_u_s", unit + "/s", 3,
      [](const ComparedRun& r) { return summary(r).peak_feed_u_s; });
  add(out, runs, "path error, peak", "path_error_um", "um", 3,
      [](const ComparedRun& r) { return r.data.work.empty() ? kNone : 1000 * summary(r).path_error_u; });
  add_axes(out, runs);
  add(out, runs, "alarms", "alarms", "", 0,
      [](const ComparedRun& r) { return static_cast<double>(summary(r).alarms); });
  return out;
}

std::string compared_note(const std::vector<ComparedRun>& runs) {
  std::string out;
  for (std::size_t k = 1; k < runs.size(); ++k) {
    const log::LogHeader &a = runs.front().data.header, &b = runs[k].data.header;
    if (a.program_hash != b.program_hash) out += fmt::format("{} ran another program than A\n", letter(k));
    if (a.machine_name != b.machine_name) out += fmt::format("{} ran on another machine than A\n", letter(k));
  }
  return out;
}

std::string render_comparison(const std::vector<ComparedRun>& runs) {
  std::string out;
  for (std::size_t k = 0; k < runs.size(); ++k)
    out += fmt::format("{}  {}   {} on {}, {}\n", letter(k), displayable(runs[k].path),
                       text::one_line(runs[k].data.header.program_name, 40),
                       text::one_line(runs[k].data.header.machine_name, 40), summary(runs[k]).outcome.text());
  out += compared_note(runs);
  std::vector<text::TextTable::Column> columns = {{"", text::TextTable::Align::left}};
  for (std::size_t k = 0; k < runs.size(); ++k) columns.push_back({letter(k)});
  for (std::size_t k = 1; k < runs.size(); ++k) columns.push_back({letter(k) + " - A"});
  columns.push_back({"", text::TextTable::Align::left});
  text::TextTable table(columns);
  for (const ComparedQuantity& q : compared_quantities(runs)) {
    std::vector<std::string> row = {q.name};
    for (const double value : q.value)
      row.push_back(std::isnan(value) ? "-" : text::fixed(value, q.decimals));
    for (std::size_t k = 1; k < runs.size(); ++k) {
      const double difference = q.value[k] - q.value[0];
      row.push_back(
          std::isnan(difference) ? "-" : (difference > 0 ? "+" : "") + text::fixed(difference, q.decimals));
    }
    row.push_back(q.unit);
    table.add(std::move(row));
  }
  return out + table.render();
}

Json json_of(const std::vector<ComparedRun>& runs) {
  Json list = Json::array();
  const std::vector<ComparedQuantity> quantities = compared_quantities(runs);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    Json j = {{"file", runs[k].path},
              {"program", runs[k].data.header.program_name},
              {"machine", runs[k].data.header.machine_name},
              {"outcome", summary(runs[k]).outcome.text()},
              {"unit", path_unit(runs[k].data.header)},
              {"steps_hash", hash_text(summary(runs[k]).steps_hash)},
              {"program_hash", hash_text(runs[k].data.header.program_hash)}};
    for (const ComparedQuantity& q : quantities)
      j[q.key] = std::isnan(q.value[k]) ? Json(nullptr)
                 : q.decimals == 0      ? Json(static_cast<std::int64_t>(q.value[k]))
                                        : Json(q.value[k]);
    list.push_back(std::move(j));
  }
  return {{"kadr", KADR_VERSION}, {"command", "compare"}, {"runs", std::move(list)}};
}

std::string render_compare_page(std::vector<ComparedRun> runs, std::size_t max_bytes) {
  const std::string unit = path_unit(runs.front().data.header);
  const std::string title = text::xml_text(
      fmt::format("{} runs of {}", runs.size(), text::one_line(runs.front().data.header.program_name, 80)));
  const std::string table =
      fmt::format("<pre id=\"comparison\">{}</pre>\n", text::xml_text(render_comparison(runs)));
  const std::string charts = chart(runs, "time", "Feed over time", "feed.commanded*", false, unit + "/s") +
                             chart(runs, "path", "Feed over the path", "feed.commanded*", true, unit + "/s") +
                             chart(runs, "error", "Path error over the path", "path.error*", true, "um");
  if (report_template().empty())
    return fmt::format(
        "{}<title>{}</title>\n</head>\n<body>\n<h1>{}</h1>\n{}{}<p>kadr {}{}</p>\n</body>\n</html>\n",
        kPlainHead, title, title, table, charts, KADR_VERSION, plain_note("compare"));
  const std::size_t frame = report_template().size() + table.size() + charts.size();
  const std::size_t room = max_bytes > frame ? max_bytes - frame : 0;
  Json letters = Json::array();
  std::string data;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    letters.push_back(letter(k));
    data += fitted_run(runs[k].data, room / runs.size(), letter(k) + "-", true, {});
  }
  return filled_template(title, table, charts,
                         json_script("runs", text::json_line({{"runs", std::move(letters)}})) + data);
}

}  // namespace kadr::log_tools
