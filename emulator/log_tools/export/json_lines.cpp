#include <cmath>

#include "emulator/log_tools/export/export.h"
#include "emulator/text/json.h"
#include "machine/base/hash.h"

namespace kadr::log_tools {
namespace {

using text::Json;

Json run_json(const log::LogHeader& h, const LogSamples& log) {
  Json axes = Json::array();
  for (const log::LogAxis& axis : h.axis)
    axes.push_back(
        {{"axis", axis.name}, {"unit", axis.unit}, {"step_u", axis.step_u}, {"home_u", axis.home_u}});
  Json units = Json::object();
  for (const Signal& signal : log.chosen()) units[signal.name] = signal.unit;
  return {{"channel", "KADR_RUN"},
          {"kadr", h.kadr_version},
          {"program", h.program_name},
          {"machine", h.machine_name},
          {"base_hz", h.base_hz},
          {"control_tick_s", log.control_tick_s()},
          {"every_control_ticks", log.every()},
          {"inputs_hash", hash_text(h.inputs_hash)},
          {"axes", std::move(axes)},
          {"units", std::move(units)}};
}

/// The axis that a record names, as its letter; null: none.
Json axis_json(int axis, const log::LogHeader& h) {
  if (axis < 0 || static_cast<std::size_t>(axis) >= h.axis.size()) return nullptr;
  return h.axis[static_cast<std::size_t>(axis)].name;
}

Json json_of(const log::BlockRecord& b, const log::LogHeader& h) {
  return {{"channel", "KADR_BLOCK"},
          {"tick", b.tick.value},
          {"t_s", h.seconds(b.tick)},
          {"block", b.block},
          {"line", b.span.line},
          {"text", b.text},
          {"motion", b.motion},
          {"length_u", b.length_u},
          {"programmed_u_s", b.programmed_u_s},
          {"planned_peak_u_s", b.planned_peak_u_s},
          {"planned_end_u_s", b.planned_end_u_s},
          {"planned_s", b.planned_s},
          {"limited_by", b.limited_by}};
}

Json json_of(const log::EventRecord& e, const log::LogHeader& h) {
  Json j = {{"channel", "KADR_EVENT"}, {"tick", e.tick.value}, {"t_s", h.seconds(e.tick)},
            {"block", e.block},        {"line", e.span.line},  {"kind", e.kind.text()}};
  j["code"] = static_cast<int>(e.code) == 0 ? Json(nullptr) : Json(code_name(e.code));
  j["axis"] = axis_json(e.axis, h);
  j["value"] = e.value;
  j["limit"] = e.limit;
  j["text"] = e.text;
  return j;
}

Json json_of(const log::LogDiagnostic& d, const log::LogHeader& h) {
  // a log may hold a number that is no severity
  const Severity severity = kSeverities.at(static_cast<std::int64_t>(d.severity)).value_or(Severity::error);
  Json j = {{"channel", "KADR_DIAG"}, {"tick", d.tick.value}};
  j["t_s"] = d.tick.value < 0 ? Json(nullptr) : Json(h.seconds(d.tick));
  j["severity"] = kSeverities.word(severity);
  j["code"] = d.code;
  j["line"] = d.span.line;
  j["text"] = d.message;
  j["label"] = d.label;
  j["notes"] = d.notes;
  j["help"] = d.help;
  return j;
}

Json json_of(const log::LogSummary& s, const log::LogHeader& h) {
  const log::RunSummary& r = s.run;
  Json limits = Json::object();
  for (const log::LimitShare& share : r.limited_by) limits[share.limited_by] = share.time_s;
  Json j = {{"channel", "KADR_SUMMARY"},
            {"tick", r.ticks.value},
            {"t_s", h.seconds(r.ticks)},
            {"outcome", r.outcome.text()},
            {"path_u", r.path_u},
            {"motion_s", r.motion_s},
            {"dwell_s", r.dwell_s},
            {"peak_feed_u_s", r.peak_feed_u_s},
            {"path_error_um", 1000 * r.path_error_u},
            {"pulses", r.pulses},
            {"steps_hash", hash_text(r.steps_hash)},
            {"limited_by_s", std::move(limits)},
            {"alarms", r.alarms},
            {"exit_code", r.exit_code}};
  return j;
}

}  // namespace

void write_json_lines(LogSamples& log, const Sink& sink) {
  const log::LogHeader& header = log.header();
  const auto line = [&](const Json& json) { sink(text::json_line(json) + '\n'); };
  line(run_json(header, log));
  // events are written at full rate, also where a lower rate leaves out their control ticks
  log.watch([&](const LogFrame& frame) {
    for (const LogItem& item : frame.items)
      std::visit([&](const auto& record) { line(json_of(record, header)); }, item);
  });
  for (Sample sample; log.next(sample);) {
    Json j = {{"channel", "KADR_TICKS"}, {"tick", sample.end.value}, {"t_s", sample.t_s}};
    for (std::size_t k = 0; k < sample.value.size(); ++k) {
      const Signal& signal = log.chosen()[k];
      j[signal.name] = std::isnan(sample.value[k]) ? Json(nullptr)
                       : signal.whole              ? Json(static_cast<std::int64_t>(sample.value[k]))
                                                   : Json(sample.value[k]);
    }
    line(j);
  }
  if (log.summary()) line(json_of(*log.summary(), header));
}

}  // namespace kadr::log_tools
