#include "emulator/text/sarif.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "emulator/text/text.h"
#include "machine/base/hash.h"
#include "machine/base/utf8.h"

namespace kadr::text {
namespace {

/// Cells of a source line that a snippet shows: generated programs have lines of any length.
constexpr std::size_t kSnippet = 200;
constexpr std::size_t kLongLine_bytes = 4096;
/// Exit codes that mean that kadr could not do its work (docs of the command line).
constexpr int kNotStarted = 2;
constexpr int kInternal = 70;

Json text_json(const std::string& text) { return {{"text", text}}; }

/// SARIF's levels are spelled as ours are.
std::string_view level(Severity severity) { return kSeverities.word(severity); }

/// "arc_end_off_circle" as "ArcEndOffCircle", the usual form of a rule's name.
std::string rule_name(std::string_view name) {
  std::string out;
  bool capital = true;
  for (const char c : name) {
    if (c == '_') {
      capital = true;
      continue;
    }
    out += capital ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    capital = false;
  }
  return out;
}

Json rule(Code code) {
  const CodeEntry& entry = code_entry(code);
  const std::string explanation(entry.explanation);
  Json j;
  j["id"] = code_name(code);
  j["name"] = rule_name(entry.name);
  j["shortDescription"] = text_json(std::string(entry.title));
  j["fullDescription"] = text_json(explanation);
  j["help"] = text_json(fmt::format("{}\n\nkadr explain {}", explanation, code_name(code)));
  return j;
}

/// Headline and measured value, then notes and help on their own lines.
std::string message(const Diagnostic& d) {
  std::string text = d.message.empty() ? std::string(code_entry(d.code).title) : d.message;
  if (!d.label.empty()) text += ": " + d.label;
  for (const std::string& note : d.notes) text += "\n" + note;
  if (!d.help.empty()) text += "\nhelp: " + d.help;
  return text;
}

/// A path as the path of a URI: bytes that have a meaning there are escaped.
std::string escaped(std::string_view path) {
  constexpr std::string_view kPlain = "-._~/!$&'()*+,;=@";
  std::string out;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = byte < 0x80 && (std::isalnum(byte) != 0 || kPlain.find(c) != std::string_view::npos);
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return out;
}

}  // namespace

std::string SarifLog::uri(const std::string& name) const {
  namespace fs = std::filesystem;
  if (name == "-") return "stdin";
  const fs::path path = fs::path(name).lexically_normal();
  if (!path.is_absolute()) return escaped(path.generic_string());
  const fs::path relative = path.lexically_relative(folder_);
  const bool below = !relative.empty() && *relative.begin() != "..";
  return below ? escaped(relative.generic_string()) : "file://" + escaped(path.generic_string());
}

Json SarifLog::location(const Span& span, const SourceSet& sources) const {
  const SourceText& source = sources[span.file];
  const Place place = place_of(span, sources);
  Json region;
  region["startLine"] = span.line;
  region["startColumn"] = place.column;
  region["endColumn"] = place.end_column;
  const std::string_view line = source.line(span.line);
  const std::size_t begin = std::min<std::size_t>(span.column > 0 ? span.column - 1 : 0, line.size());
  region["snippet"] = text_json(one_line(line.substr(begin, span.length), kSnippet));
  Json context;
  context["startLine"] = span.line;
  context["snippet"] = text_json(one_line(line, kSnippet));
  Json physical;
  physical["artifactLocation"] = {{"uri", uri(source.name())}};
  physical["region"] = std::move(region);
  physical["contextRegion"] = std::move(context);
  return {{"physicalLocation", std::move(physical)}};
}

std::string SarifLog::fingerprint(const Diagnostic& d, const SourceSet& sources) {
  const SourceText& source = sources[d.span.file];
  const std::string_view whole = source.line(d.span.line);
  // a long line is hashed once for each code, however many mistakes it has
  std::string once;
  std::string& text = whole.size() < kLongLine_bytes
                          ? once
                          : line_hashes_[std::tuple(d.code, source.name(), d.span.line, whole.size())];
  if (text.empty()) {
    const std::string line = one_line(whole, whole.size() + kSnippet);
    Hash64 hash;
    hash.integer(static_cast<std::int64_t>(d.code));
    hash.bytes(line.data(), line.size());
    text = hash_text(hash.digest());
  }
  // identical texts in a file are numbered in order
  return fmt::format("{}:{}", text, ++seen_[source.name() + '\n' + text]);
}

void SarifLog::add(const Diagnostic& d, const SourceSet& sources) {
  codes_.insert(d.code);
  Json j;
  j["ruleId"] = code_name(d.code);
  j["ruleIndex"] = 0;
  j["level"] = level(d.severity);
  j["message"] = text_json(message(d));
  j["locations"] = Json::array();
  Json frames = Json::array();
  if (has_place(d.span, sources)) {
    j["locations"].push_back(location(d.span, sources));
    j["partialFingerprints"] = {{"primaryLocationLineHash", fingerprint(d, sources)}};
    frames.push_back({{"location", location(d.span, sources)}});
  }

  Json related = Json::array();
  for (const Span& call : d.calls) {
    if (!has_place(call, sources)) continue;
    Json place = location(call, sources);
    frames.push_back({{"location", place}});
    place["id"] = related.size() + 1;
    place["message"] = text_json("called from here");
    related.push_back(std::move(place));
  }
  if (!related.empty()) {
    const std::string left_out =
        d.calls_left_out > 0 ? fmt::format(", {} in the middle left out", d.calls_left_out) : "";
    j["relatedLocations"] = std::move(related);
    j["stacks"] = Json::array({{{"message", text_json("calls" + left_out)}, {"frames", std::move(frames)}}});
  }
  results_.push_back({d.severity, d.code, std::move(j)});
}

Json SarifLog::document(int exit_code) const {
  Json rules = Json::array();
  for (const Code code : codes_) rules.push_back(rule(code));

  // viewers truncate long lists: emit errors first
  std::vector<const Result*> sorted;
  for (const Result& result : results_) sorted.push_back(&result);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Result* a, const Result* b) { return a->severity > b->severity; });
  Json results = Json::array();
  for (const Result* result : sorted) {
    results.push_back(result->json);
    results.back()["ruleIndex"] = std::distance(codes_.begin(), codes_.find(result->code));
  }

  Json driver;
  driver["name"] = "kadr";
  driver["version"] = KADR_VERSION;
  driver["semanticVersion"] = KADR_VERSION;
  driver["rules"] = std::move(rules);
  Json run;
  run["tool"] = {{"driver", std::move(driver)}};
  run["invocations"] =
      Json::array({{{"executionSuccessful", exit_code != kNotStarted && exit_code < kInternal},
                    {"exitCode", exit_code}}});
  run["columnKind"] = "unicodeCodePoints";
  run["results"] = std::move(results);
  Json j;
  j["$schema"] = "https://json.schemastore.org/sarif-2.1.0.json";
  j["version"] = "2.1.0";
  j["runs"] = Json::array({std::move(run)});
  return j;
}

}  // namespace kadr::text
