#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "machine/base/diagnostic.h"

/// What the tables say, for programs: English keys in a fixed order, each real number with its unit in the
/// key. `_u` is the unit that "unit" beside it names (mm or deg). No wall clock, so equal runs give equal bytes.
namespace kadr::text {

using Json = nlohmann::ordered_json;

/// {"file", "line", "column", "length", "code", "severity", "message", "label", "notes", "help", "calls",
/// "calls_left_out"}; column and length in code points, column from 1; line 0: no place. "calls" holds the
/// places of the calls that led here, innermost first; the ones left out stand between its two halves.
Json json_of(const Diagnostic& d, const SourceSet& sources);
Json json_of(const Diagnostics& diagnostics, const SourceSet& sources);
/// Indented by two; bytes that are not UTF-8 become U+FFFD, and what a terminal may not be shown is escaped (\u202e).
std::string json_text(const Json& json);
/// The same on one line, without line end.
std::string json_line(const Json& json);

}  // namespace kadr::text
