#include <algorithm>
#include <cmath>

#include "emulator/log/log_info.h"
#include "emulator/log_tools/diff/diff_report.h"
#include "machine/base/hash.h"

namespace kadr::log_tools {
namespace {

using text::Json;

/// JSON has no NaN and no infinity.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json place_json(const ProgramPlace& place) {
  if (place.line == 0) return nullptr;
  return {{"file", place.file.empty() ? Json(nullptr) : Json(place.file)},
          {"line", place.line},
          {"text", place.text}};
}

Json field_json(const FieldDifference& f, const log::LogHeader& header) {
  Json j;
  j["channel"] = channel_name(f.channel);
  j["field"] = f.field;
  j["axis"] = f.axis.empty() ? Json(nullptr) : Json(f.axis);
  j["unit"] = f.unit.empty() ? Json(nullptr) : Json(f.unit);
  j["a"] = f.a;
  j["b"] = f.b;
  j["difference"] = f.difference ? number(*f.difference) : Json(nullptr);
  j["tick"] = f.tick.value;
  j["at_s"] = header.seconds(f.tick);
  return j;
}

Json fields_json(const std::vector<FieldDifference>& fields, const log::LogHeader& header) {
  Json list = Json::array();
  for (const FieldDifference& f : fields) list.push_back(field_json(f, header));
  return list;
}

Json first_json(const FirstDifference& first, const log::LogHeader& header) {
  Json j = json_of(first.tick, header);
  j["input_before"] = first.input.empty() ? Json(nullptr) : Json(first.input);
  j["event_before"] = first.event.empty() ? Json(nullptr) : Json(first.event);
  Json rows = Json::array();
  for (const ContextRow& row : first.rows)
    rows.push_back({{"control_tick", row.control_tick}, {"place", row.place}, {"a", row.a}, {"b", row.b}});
  j["around"] = {{"field", first.context_name}, {"unit", first.context_unit}, {"rows", std::move(rows)}};
  return j;
}

Json point_json(const FeedPoint& p, const log::LogHeader& header) {
  return {{"feed_u_s", number(p.feed_u_s)},
          {"override_used", number(p.override_used)},
          {"limited_by", p.limited_by},
          {"at_s", header.seconds(p.tick)}};
}

/// How the logs end, which is known only after they have been read.
Json end_json(const LogSide& side) {
  return {{"state", log::log_state_name(side.end.state)},
          {"detail", side.end.detail},
          {"valid_until_tick", side.end.valid_until.value},
          {"control_ticks", side.control_ticks}};
}

}  // namespace

Json json_of(const std::vector<InputDifference>& inputs) {
  Json list = Json::array();
  for (const InputDifference& input : inputs)
    list.push_back({{"input", input.name},
                    {"same", input.same},
                    {"detail", input.detail.empty() ? Json(nullptr) : Json(input.detail)}});
  return list;
}

Json json_of(const LogSide& side) {
  return {{"file", side.path},
          {"program", side.header.program_name},
          {"machine", side.header.machine_name},
          {"kadr", side.header.kadr_version},
          {"base_hz", side.header.base_hz},
          {"control_tick_ticks", side.header.control_tick_ticks},
          {"inputs_hash", hash_text(side.header.inputs_hash)}};
}

Json json_of(const TickDifference& d, const log::LogHeader& header) {
  Json j;
  j["control_tick"] = d.control_tick;
  j["from_s"] = header.seconds(Ticks{d.control_tick * header.control_tick_ticks});
  j["channel"] = channel_name(d.fields.front().channel);
  j["block"] = d.block;
  j["place_a"] = place_json(d.place_a);
  j["place_b"] = place_json(d.place_b);
  j["fields"] = fields_json(d.fields, header);
  return j;
}

Json json_of(const LogDiff& diff) {
  const log::LogHeader& header = diff.a.header;
  Json j;
  j["differ"] = diff.differ();
  j["inputs_differ"] = diff.inputs_differ();
  j["compared"] = diff.compared;
  if (!diff.compared) return j;
  j["control_ticks"] = diff.both;
  j["end_a"] = end_json(diff.a);
  j["end_b"] = end_json(diff.b);
  j["first"] = diff.first ? first_json(*diff.first, header) : Json(nullptr);
  Json totals = Json::array();
  for (std::size_t c = 0; c < kDiffChannels; ++c) {
    const ChannelTotals& t = diff.channels[c];
    const auto channel = static_cast<DiffChannel>(c);
    if (channel == DiffChannel::summary) continue;
    totals.push_back({{"channel", channel_name(channel)},
                      {"load", channel == DiffChannel::load},
                      {"differing", t.differing},
                      {"first_control_tick", t.first ? Json(t.first_control_tick) : Json(nullptr)},
                      {"first", t.first ? field_json(*t.first, header) : Json(nullptr)}});
  }
  j["totals"] = std::move(totals);
  Json peaks = Json::array();
  for (const LoadPeak& p : diff.load_peaks)
    peaks.push_back({{"axis", p.axis},
                     {"field", p.field},
                     {"unit", p.unit},
                     {"difference", number(p.difference)},
                     {"control_tick", p.control_tick}});
  j["load_peaks"] = std::move(peaks);
  j["summary"] = fields_json(diff.summary, header);
  return j;
}

Json json_of(const BlockDifference& d, const log::LogHeader& header) {
  Json j;
  j["block"] = d.a.block;
  j["place"] = place_json(place_of(header, d.a));
  Json counts = Json::array();
  for (const auto& count : d.counts)
    counts.push_back({{"axis", count.axis}, {"pulses_a", count.a}, {"pulses_b", count.b}});
  j["counts"] = std::move(counts);
  j["order"] = d.order.empty() ? Json(nullptr) : Json(d.order);
  j["geometry"] = d.geometry.empty() ? Json(nullptr) : Json(d.geometry);
  return j;
}

Json json_of(const FeedSpan& span, const log::LogHeader& header) {
  Json j;
  j["from_u"] = number(span.from_u);
  j["to_u"] = number(span.to_u);
  j["block"] = span.a.block ? Json(span.a.block->block) : Json(nullptr);
  j["place"] = span.a.block ? place_json(place_of(header, *span.a.block)) : Json(nullptr);
  j["a"] = point_json(span.a, header);
  j["b"] = point_json(span.b, header);
  j["largest_u_s"] = number(span.largest_u_s);
  j["largest_at_u"] = number(span.largest_at_u);
  return j;
}

Json json_of(const PathDiff& d) {
  const log::LogHeader& header = d.a.header;
  Json j;
  j["differ"] = d.differ();
  j["inputs_differ"] = d.inputs_differ();
  j["unit"] = d.unit;
  j["path_a_u"] = number(d.path_a_u);
  j["path_b_u"] = number(d.path_b_u);
  j["end_a"] = end_json(d.a);
  j["end_b"] = end_json(d.b);
  Json steps;
  steps["compared"] = d.steps_compared;
  steps["blocks"] = d.blocks;
  steps["differing"] = d.blocks_differing;
  steps["given_up"] = d.given_up;
  steps["first"] = d.first_block ? json_of(*d.first_block, header) : Json(nullptr);
  j["steps"] = std::move(steps);
  Json events;
  events["compared"] = d.events_compared;
  events["events"] = d.events;
  events["first"] = d.event ? Json({{"number", d.event->number},
                                    {"place", place_json(d.event->place)},
                                    {"a", d.event->a},
                                    {"b", d.event->b}})
                            : Json(nullptr);
  j["events"] = std::move(events);
  Json feed;
  feed["compared"] = d.feed_compared;
  feed["tolerance_u_s"] = d.tolerance_u_s;
  feed["stretches"] = d.spans;
  feed["length_u"] = number(d.span_length_u);
  feed["first"] = d.first_span ? json_of(*d.first_span, header) : Json(nullptr);
  feed["largest"] = d.largest_span ? json_of(*d.largest_span, header) : Json(nullptr);
  j["feed"] = std::move(feed);
  return j;
}

}  // namespace kadr::log_tools
