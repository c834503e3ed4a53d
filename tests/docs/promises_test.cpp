#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/docs/console_blocks.h"

// What docs/promises.md names as proof is there, and no page with commands is left unrun.

namespace fs = std::filesystem;

using kadr::docs::text_of;

namespace {

/// All files of a folder with one ending, one after the other.
std::string texts_of(const fs::path& folder, const std::string& ending) {
  std::string all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ending) all += text_of(entry.path());
  return all;
}

/// Names of all cases in a source; adjacent string literals are one.
std::set<std::string> cases_of(const std::string& source) {
  constexpr std::string_view head = "TEST_CASE(";
  std::set<std::string> names;
  for (auto at = source.find(head); at != std::string::npos; at = source.find(head, at + 1)) {
    std::string name;
    auto next = source.find_first_not_of(" \n", at + head.size());
    while (next != std::string::npos && source[next] == '"') {
      for (++next; next < source.size() && source[next] != '"'; ++next)
        name += source[next] == '\\' ? source[++next] : source[next];
      next = source.find_first_not_of(" \n", next + 1);
    }
    if (!name.empty()) names.insert(name);
  }
  return names;
}

std::vector<std::string> matches_of(const std::string& text, const std::string& pattern) {
  std::vector<std::string> found;
  const std::regex regex(pattern);
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it)
    found.push_back((*it)[1]);
  return found;
}

const fs::path kRoot = KADR_SOURCE_DIR;

/// Names of docs/promises.md that are nothing: of tests, of pages' tests, of scenarios and of files.
std::vector<std::string> empty_promises(const std::string& page) {
  static const std::set<std::string> cases = cases_of(texts_of(kRoot / "tests", ".cpp"));
  static const std::string pages = texts_of(kRoot / "tests/web", ".mjs");
  std::vector<std::string> empty;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.front() != '|') continue;
    for (const std::string& name : matches_of(line, "\"([^\"]+)\"")) {
      const std::string quoted = "\"" + name + "\"";
      const bool is_page = line.find("page " + quoted) != std::string::npos;
      const bool is_scenario = line.find("scenario " + quoted) != std::string::npos;
      const bool there = is_page       ? pages.find("test('" + name) != std::string::npos
                         : is_scenario ? fs::exists(kRoot / "scenarios" / name / "scenario.toml")
                                       : cases.count(name) > 0;
      if (!there) empty.push_back(name);
    }
    for (const std::string& file : matches_of(line, "`((?:tools|tests)/[^`]+)`"))
      if (!fs::exists(kRoot / file)) empty.push_back(file);
  }
  return empty;
}

}  // namespace

TEST_CASE("docs/promises.md names tests, scenarios and tools that exist") {
  const std::string page = text_of(kRoot / "docs/promises.md");
  CHECK(matches_of(page, "\"([^\"]+)\"").size() > 50);
  for (const std::string& name : empty_promises(page)) FAIL_CHECK("docs/promises.md: there is no " << name);
}

TEST_CASE("a promise whose test is gone is seen") {
  CHECK(
      empty_promises(
          "| a | \"nobody tests this\" |\n| b | page \"nor that\", scenario \"99_none\", `tools/none` |\n") ==
      std::vector<std::string>{"nobody tests this", "nor that", "99_none", "tools/none"});
  CHECK(empty_promises("\"not in a table\"\n").empty());
}

TEST_CASE("every page with commands has a case that runs them") {
  const std::string cases = text_of(kRoot / "tests/docs/documents_test.cpp");
  std::vector<fs::path> pages = {kRoot / "README.md"};
  for (const auto& entry : fs::directory_iterator(kRoot / "docs"))
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  for (const fs::path& page : pages) {
    if (text_of(page).find("\n```console\n") == std::string::npos) continue;
    const std::string name = fs::relative(page, kRoot).string();
    CHECK_MESSAGE(cases.find("check_document(\"" + name + "\")") != std::string::npos, name);
  }
}
