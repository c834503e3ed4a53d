#include "emulator/text/json.h"

namespace kadr::text {
namespace {

Json place_json(const Span& span, const SourceSet& sources) {
  const bool placed = has_place(span, sources);
  const Place place = placed ? place_of(span, sources) : Place{};
  Json j;
  j["file"] = placed ? Json(sources[span.file].name()) : Json(nullptr);
  j["line"] = placed ? span.line : 0;
  j["column"] = placed ? place.column : 0;
  j["length"] = place.end_column - place.column;
  return j;
}

}  // namespace

Json json_of(const Diagnostic& d, const SourceSet& sources) {
  Json j = place_json(d.span, sources);
  j["code"] = code_name(d.code);
  j["severity"] = kSeverities.word(d.severity);
  j["message"] = d.message.empty() ? std::string(code_entry(d.code).title) : d.message;
  j["label"] = d.label;
  j["notes"] = d.notes;
  j["help"] = d.help;
  j["calls"] = Json::array();
  for (const Span& call : d.calls) j["calls"].push_back(place_json(call, sources));
  j["calls_left_out"] = d.calls_left_out;
  return j;
}

Json json_of(const Diagnostics& diagnostics, const SourceSet& sources) {
  Json list = Json::array();
  for (const Diagnostic& d : diagnostics.list()) list.push_back(json_of(d, sources));
  return list;
}

std::string json_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace); }
std::string json_line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace kadr::text
