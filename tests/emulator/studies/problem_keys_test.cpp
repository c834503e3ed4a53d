#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "emulator/studies/time_law/problem_keys.h"

using namespace kadr;
using namespace kadr::studies;

namespace {

/// A problem with one key more, in the table with that header. Whether its value is right does not matter.
std::string problem_with(const std::string& path, const std::string& header, const std::string& key) {
  const std::string line = key + " = 1\n";
  const bool degrees = key.find("_deg") != key.npos;
  std::string text = header.empty() ? line : "";
  text += "[path]\n" + path + (header == "[path]" ? line : "");
  text += fmt::format("[[axis]]\nunit = \"{}\"\n", degrees ? "deg" : "mm");
  if (header == "[path]" || header.empty()) return text;
  return text + (header == "[[axis]]" ? line : header + "\n" + line);
}

/// Whether a reader takes the key for one that it does not know.
bool is_unknown(const std::string& text, const std::string& key) {
  SourceSet sources;
  const auto problem = read_time_law_problem(sources, sources.add(SourceText("problem.toml", text)));
  if (problem) return false;
  const auto& list = problem.error().list();
  return std::any_of(list.begin(), list.end(), [&](const Diagnostic& d) {
    return (d.code == Code::file_unknown_key || d.code == Code::file_other_unit) &&
           sources[d.span.file].line(d.span.line).substr(d.span.column - 1, d.span.length) == key;
  });
}

/// A path by formula, by table, by the moves of a program and by a spline through their ends.
const std::vector<std::string> kPaths{"length_mm = 10\nnodes = 5\n", "table = \"none.csv\"\n",
                                      "program = \"none.ngc\"\nmachine = \"mill3\"\n",
                                      "program = \"none.ngc\"\nmachine = \"mill3\"\nfit = \"spline\"\n"};

/// Axes are read in full for a formula alone.
bool is_known(const std::string& header, const std::string& key) {
  const auto last = header.starts_with("[[axis") ? kPaths.begin() + 1 : kPaths.end();
  return std::any_of(kPaths.begin(), last, [&](const std::string& path) {
    // given twice it would be a mistake of TOML
    const bool given = header == "[path]" && path.find(key + " = ") != path.npos;
    const std::string text = given ? problem_with(path, "", "format") : problem_with(path, header, key);
    return !is_unknown(text, key);
  });
}

}  // namespace

TEST_CASE("each key of a problem that kadr tube lists is one that its reader knows") {
  std::size_t keys = 0;
  for (const machine::TableDocument& table : problem_keys()) {
    for (const machine::KeyDocument& key : table.keys) {
      std::string name;
      for (std::istringstream names(key.name); std::getline(names >> std::ws, name, ','); ++keys) {
        CAPTURE(table.header);
        CAPTURE(name);
        CHECK(is_known(table.header, name));
      }
    }
  }
  CHECK(keys > 45);
}

TEST_CASE("a key of a problem that kadr tube does not list is refused in every table") {
  for (const machine::TableDocument& table : problem_keys()) {
    CAPTURE(table.header);
    CHECK(is_unknown(problem_with(kPaths.front(), table.header, "nothing"), "nothing"));
  }
}
