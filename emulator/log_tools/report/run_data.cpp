#include "emulator/log_tools/report/run_data.h"

#include <fmt/format.h>

#include <map>

#include "emulator/log_tools/diff/diff_fields.h"
#include "emulator/log_tools/report/encode.h"
#include "emulator/log_tools/report/summary_html.h"
#include "emulator/text/json.h"
#include "emulator/text/text.h"
#include "machine/tick_motion.h"

namespace kadr::log_tools {
namespace {

using text::Json;

/// Data of a page: not code, so that the hashes of its security policy stay as they were built.
std::string data_script(const std::string& id, const std::string& base64) {
  return fmt::format("<script type=\"application/octet-stream\" id=\"{}\">{}</script>\n", id, base64);
}

}  // namespace

std::string json_script(const std::string& id, const std::string& json) {
  std::string text;
  for (const char c : json) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id, text);
}

namespace {

Json limited_by_names() {
  Json names = Json::array();
  for (const auto& reason : kLimitedBy) names.push_back(reason.word);
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
  for (const log::EventRecord& e : data.events)
    out.push_back({{"t_s", data.header.seconds(e.tick)},
                   {"line", e.span.line},
                   {"kind", e.kind.text()},
                   {"text", e.text}});
  return out;
}

/// One signal: its pieces, and in the same steps the control ticks of the stretches at full rate.
void add_track(const PageData& data, std::size_t k, const std::string& prefix, Json& tracks,
               std::string& blobs) {
  const Track& track = data.tracks[k];
  // both rows in one, so that they share a scale
  std::vector<float> values = track.low;
  if (data.every > 1) values.insert(values.end(), track.high.begin(), track.high.end());
  const Quantised q = quantised(values, track.signal.whole);
  tracks.push_back(
      {{"name", track.signal.name}, {"unit", track.signal.unit}, {"low", q.low}, {"step", q.step}});
  blobs += data_script(fmt::format("{}track{}", prefix, k), q.data);
  if (!data.full_rate.stretches.empty())
    blobs += data_script(fmt::format("{}fine{}", prefix, k),
                         packed_reals(data.full_rate.tracks[k], q.low, q.step));
}

Json windows_json(const FullRate& full_rate) {
  Json out = Json::array();
  std::int64_t at = 0;
  for (const Stretch& s : full_rate.stretches) {
    out.push_back({{"first", s.first}, {"ticks", s.ticks}, {"at", at}});
    at += s.ticks;
  }
  return out;
}

}  // namespace

std::string run_scripts(const PageData& data, const std::string& prefix, bool with_path) {
  const log::LogHeader& h = data.header;
  std::string blobs;
  Json tracks = Json::array(), axes = Json::array();
  for (std::size_t k = 0; k < data.tracks.size(); ++k) add_track(data, k, prefix, tracks, blobs);
  const auto counts = [&](const char* name, std::size_t k, const std::vector<std::int32_t>& values) {
    blobs += data_script(fmt::format("{}{}{}", prefix, name, k), packed_counts(values));
  };
  counts("corner", 0, data.corners.ticks);
  for (std::size_t a = 0; a < h.axis.size(); ++a) {
    axes.push_back({{"name", h.axis[a].name}, {"unit", h.axis[a].unit}, {"step_u", h.axis[a].step_u}});
    counts("nodes", a, data.nodes[a]);
    counts("corner", a + 1, data.corners.nodes[a]);
    if (!data.full_rate.stretches.empty()) counts("fine-nodes", a, data.full_rate.nodes[a]);
  }
  if (with_path) blobs += data_script(prefix + "path", packed_counts(data.path_milli));
  blobs += data_script(prefix + "data-blocks", packed(text::json_line(block_columns(data))));
  blobs += data_script(prefix + "data-program", packed(h.program_text));
  blobs += data_script(prefix + "data-settings", packed(h.settings_toml));
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
                     {"windows", windows_json(data.full_rate)},
                     {"has_path", with_path},
                     {"events", events_json(data)},
                     {"events_left_out", data.events_left_out}};
  return json_script(prefix + "meta", text::json_line(meta)) + blobs;
}

}  // namespace kadr::log_tools
