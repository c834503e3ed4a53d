#include <fmt/format.h>

#include "emulator/text/json.h"
#include "machine/base/terminal_text.h"
#include "machine/base/utf8.h"

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

std::string escape(char32_t c) {
  const auto value = static_cast<std::uint32_t>(c);
  if (value <= 0xFFFF) return fmt::format("\\u{:04x}", value);
  const std::uint32_t beyond = value - 0x10000;
  return fmt::format("\\u{:04x}\\u{:04x}", 0xD800 + (beyond >> 10), 0xDC00 + (beyond & 0x3FF));
}

/// A document in which whatever a terminal may not be shown is escaped: only its texts can hold such characters.
std::string with_escapes(std::string json) {
  std::size_t at = shown_bytes(json);
  if (at == json.size()) return json;
  std::string out = json.substr(0, at);
  while (at < json.size()) {
    const CodePoint c = decode_utf8(json, at);
    out += escape(c.value);
    at += c.bytes;
    const std::size_t shown = shown_bytes(std::string_view(json).substr(at));
    out.append(json, at, shown);
    at += shown;
  }
  return out;
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

std::string json_text(const Json& json) {
  return with_escapes(json.dump(2, ' ', false, Json::error_handler_t::replace));
}
std::string json_line(const Json& json) {
  return with_escapes(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace kadr::text
