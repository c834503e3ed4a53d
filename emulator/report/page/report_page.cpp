#include "emulator/report/page/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "emulator/diff/diff_fields.h"
#include "emulator/report/json.h"
#include "emulator/report/page/encode.h"
#include "emulator/report/page/summary_html.h"
#include "emulator/report/text.h"
#include "machine/base/require.h"
#include "planner/planner.h"

namespace kadr::emulator {
namespace {

/// Data of a page: not code, so that the hashes of its security policy stay as they were built.
std::string data_script(const std::string& id, const std::string& base64) {
  return fmt::format("<script type=\"application/octet-stream\" id=\"{}\">{}</script>\n", id, base64);
}

/// JSON within HTML: no `<` can end the element.
std::string json_script(const std::string& id, const Json& json) {
  std::string text;
  for (const char c : json_line(json)) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id, text);
}

Json limited_by_names() {
  Json names = Json::array();
  for (int reason = 0; reason <= static_cast<int>(planner::LimitedBy::limiter); ++reason)
    names.push_back(planner::limited_by_name(static_cast<planner::LimitedBy>(reason)));
  return names;
}

Json block_columns(const PageData& data) {
  std::map<std::string, int> numbers;
  Json words = Json::array(), t = Json::array(), line = Json::array(), length = Json::array(),
       time = Json::array(), programmed = Json::array(), peak = Json::array(), reason = Json::array(),
       text = Json::array();
  const bool has_text = !data.header.program_text.empty();
  for (const PageBlock& b : data.blocks) {
    const auto [it, fresh] = numbers.try_emplace(b.limited_by, static_cast<int>(numbers.size()));
    if (fresh) words.push_back(b.limited_by);
    t.push_back(data.header.seconds(b.begin));
    line.push_back(b.line);
    length.push_back(b.length_u);
    time.push_back(b.planned_s);
    programmed.push_back(b.programmed_u_s);
    peak.push_back(b.planned_peak_u_s);
    reason.push_back(it->second);
    if (!has_text) text.push_back(b.text);
  }
  return {{"t_s", std::move(t)},
          {"line", std::move(line)},
          {"length_u", std::move(length)},
          {"planned_s", std::move(time)},
          {"programmed_u_s", std::move(programmed)},
          {"peak_u_s", std::move(peak)},
          {"limited_by", std::move(reason)},
          {"words", std::move(words)},
          {"text", std::move(text)},
          {"left_out", data.blocks_left_out}};
}

Json events_json(const PageData& data) {
  Json out = Json::array();
  for (const EventRecord& e : data.events)
    out.push_back(
        {{"t_s", data.header.seconds(e.tick)}, {"line", e.span.line}, {"kind", e.kind}, {"text", e.text}});
  return out;
}

/// Scripts of the whole data, in the form that emulator/report/web/src/data.ts reads.
std::string data_scripts(const PageData& data) {
  const LogHeader& h = data.header;
  std::string blobs;
  Json tracks = Json::array(), axes = Json::array();
  const bool pairs = data.every > 1;
  for (std::size_t k = 0; k < data.tracks.size(); ++k) {
    const Track& track = data.tracks[k];
    // both rows in one, so that they share a scale
    std::vector<float> values = track.low;
    if (pairs) values.insert(values.end(), track.high.begin(), track.high.end());
    const Quantised q = quantised(values, track.signal.whole);
    tracks.push_back(
        {{"name", track.signal.name}, {"unit", track.signal.unit}, {"low", q.low}, {"step", q.step}});
    blobs += data_script(fmt::format("track{}", k), q.data);
  }
  for (std::size_t a = 0; a < h.axis.size(); ++a) {
    axes.push_back({{"name", h.axis[a].name}, {"unit", h.axis[a].unit}, {"step_u", h.axis[a].step_u}});
    blobs += data_script(fmt::format("nodes{}", a), packed_counts(data.nodes[a]));
  }
  blobs += data_script("data-blocks", packed(json_line(block_columns(data))));
  blobs += data_script("data-program", packed(h.program_text));
  blobs += data_script("data-settings", packed(h.settings_toml));
  const Json meta = {{"kadr", h.kadr_version},
                     {"title", page_title(data)},
                     {"program", h.program_name},
                     {"path_unit", path_unit(h)},
                     {"control_tick_s", h.seconds(Ticks{h.control_tick_ticks})},
                     {"first_control_tick", data.first_control_tick},
                     {"control_ticks", data.control_ticks},
                     {"every", data.every},
                     {"pieces", data.pieces()},
                     {"tracks", std::move(tracks)},
                     {"axes", std::move(axes)},
                     {"limited_by", limited_by_names()},
                     {"events", events_json(data)},
                     {"events_left_out", data.events_left_out}};
  return json_script("meta", meta) + blobs;
}

/// Puts a text in the place of a mark of the template, which stands there once.
void fill(std::string& page, std::string_view mark, std::string_view text) {
  const auto at = page.find(mark);
  require(at != std::string::npos, "the page's template has every mark");
  page.replace(at, mark.size(), text);
}

}  // namespace

std::string render_report_page(PageData data, std::size_t max_bytes) {
  if (report_template().empty()) return render_plain_page(data);
  const std::string title = xml_text(page_title(data)), summary = summary_html(data),
                    charts = chart_html(data);
  const std::size_t frame = report_template().size() + 2 * title.size() + summary.size() + charts.size();
  std::string scripts = data_scripts(data);
  while (frame + scripts.size() > max_bytes && data.pieces() > 4096) {
    // the first halving doubles the rows of a track: it gains nothing
    if (data.every == 1) halve(data);
    halve(data);
    scripts = data_scripts(data);
  }
  std::string page(report_template());
  fill(page, "<!--TITLE-->", title);
  fill(page, "<!--HEADING-->", title);
  fill(page, "<!--SUMMARY-->", summary);
  fill(page, "<!--CHARTS-->", charts);
  fill(page, "<!--DATA-->", scripts);
  return page;
}

}  // namespace kadr::emulator
