#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/docs/console_blocks.h"

namespace fs = std::filesystem;

using kadr::docs::text_of;

namespace {

const fs::path kProject = KADR_SOURCE_DIR;

/// Markdown files of the project; builds and packages of npm are not the project's.
std::vector<fs::path> markdown_files() {
  std::vector<fs::path> files;
  for (auto entry = fs::recursive_directory_iterator(kProject); entry != fs::recursive_directory_iterator();
       ++entry) {
    const std::string name = entry->path().filename().string();
    if (entry->is_directory() && (name == "build" || name == "node_modules" || name == ".git"))
      entry.disable_recursion_pending();
    else if (entry->path().extension() == ".md")
      files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// The text without code: neither fenced blocks nor `code` hold links.
std::string prose_of(const std::string& text) {
  std::istringstream lines(text);
  std::string prose, line;
  for (bool fenced = false; std::getline(lines, line);) {
    if (line.starts_with("```")) fenced = !fenced;
    prose += fenced ? "\n" : line + "\n";
  }
  return std::regex_replace(prose, std::regex("`[^`\n]*`"), "");
}

/// Targets of [text](target) and ![text](target).
std::vector<std::string> links_of(const std::string& prose) {
  static const std::regex kLink(R"(\]\(([^)\s]+)\))");
  std::vector<std::string> links;
  for (std::sregex_iterator i(prose.begin(), prose.end(), kLink), end; i != end; ++i)
    links.push_back((*i)[1]);
  return links;
}

/// Anchors of a document's headings as GitHub makes them: lower case, blanks to hyphens, no punctuation.
std::set<std::string> anchors_of(const std::string& text) {
  std::set<std::string> anchors;
  std::istringstream lines(text);
  std::string line;
  for (bool fenced = false; std::getline(lines, line);) {
    if (line.starts_with("```")) fenced = !fenced;
    if (fenced || !line.starts_with("#")) continue;
    std::string anchor;
    for (const char c : line.substr(std::min(line.find_first_not_of("# "), line.size()))) {
      const auto byte = static_cast<unsigned char>(c);
      if (c == ' ') anchor += '-';
      if (std::isalnum(byte) || c == '-' || c == '_' || byte >= 128)
        anchor += static_cast<char>(std::tolower(byte));
    }
    anchors.insert(anchor);
  }
  return anchors;
}

/// What is wrong with a link of a document, empty if nothing is. Web addresses are not looked up.
std::string fault_of(const fs::path& document, const std::string& link) {
  if (std::regex_search(link, std::regex("^[a-z]+:"))) return {};
  const std::size_t hash = link.find('#');
  const std::string file = link.substr(0, hash);
  const fs::path target = file.empty() ? document : document.parent_path() / file;
  if (!fs::exists(target)) return "no such file";
  const fs::path inside = fs::relative(fs::weakly_canonical(target), fs::weakly_canonical(kProject));
  if (*inside.begin() == "..") return "outside of the project";
  if (hash == std::string::npos || target.extension() != ".md") return {};
  return anchors_of(text_of(target)).contains(link.substr(hash + 1)) ? "" : "no such heading";
}

/// Words of one kind in a text, such as `tools/run`: the pattern's first group.
std::set<std::string> words_of(const std::string& text, const std::regex& word) {
  std::set<std::string> words;
  for (std::sregex_iterator i(text.begin(), text.end(), word), end; i != end; ++i) words.insert((*i)[1]);
  return words;
}

void check_same(const std::set<std::string>& named, const std::set<std::string>& there) {
  for (const std::string& name : named) CHECK_MESSAGE(there.contains(name), name, " is named, but not there");
  for (const std::string& name : there) CHECK_MESSAGE(named.contains(name), name, " is there, but not named");
}

}  // namespace

TEST_CASE("every relative link of every Markdown file leads to a file and heading of the project") {
  std::size_t count = 0;
  for (const fs::path& document : markdown_files())
    for (const std::string& link : links_of(prose_of(text_of(document)))) {
      const std::string where = fs::relative(document, kProject).string() + ": " + link;
      CHECK_MESSAGE(fault_of(document, link) == "", where);
      ++count;
    }
  // README.md and scenarios/README.md alone have more
  CHECK(count > 50);
}

TEST_CASE("a broken link is seen: missing file, missing heading, a way out of the project") {
  const fs::path readme = kProject / "README.md";
  CHECK(fault_of(readme, "docs/pipeline.md") == "");
  CHECK(fault_of(readme, "docs/HACKING.md#presets") == "");
  CHECK(fault_of(readme, "https://example.org/nothing") == "");
  CHECK(fault_of(readme, "docs/no_such_page.md") == "no such file");
  CHECK(fault_of(readme, "docs/HACKING.md#no-such-heading") == "no such heading");
  CHECK(fault_of(readme, "..") == "outside of the project");
  CHECK(links_of(prose_of("[a](b) `[c](d)` ![e](f.png)\n```\n[g](h)\n```\n")) ==
        std::vector<std::string>{"b", "f.png"});
}

TEST_CASE("docs/HACKING.md names every tool and every preset that there is, and no other") {
  const std::string page = text_of(kProject / "docs/HACKING.md");
  std::set<std::string> tools;
  // lists and what is sourced are no commands
  for (const auto& entry : fs::directory_iterator(kProject / "tools"))
    if (!entry.path().has_extension() && entry.path().filename() != "packages")
      tools.insert(entry.path().filename().string());
  check_same(words_of(page, std::regex(R"(\| `tools/([^`]+)` \|)")), tools);

  // a preset for a person has a build preset of the same name; those of the matrix are one row
  const std::string presets = text_of(kProject / "CMakePresets.json");
  std::set<std::string> names = words_of(presets, std::regex(R"re("configurePreset": "([^"]+)")re"));
  std::erase_if(names, [](const std::string& name) { return name.starts_with("matrix-"); });
  names.insert("matrix-*");
  check_same(words_of(page, std::regex(R"(\| `([a-z0-9*-]+)` \|)")), names);
}

TEST_CASE("the hosted checks call tools that there are") {
  const std::string checks = text_of(kProject / ".github/workflows/ci.yml");
  const std::set<std::string> tools = words_of(checks, std::regex("run: tools/([a-z0-9-]+)"));
  CHECK(tools.size() > 3);
  for (const std::string& tool : tools) CHECK_MESSAGE(fs::exists(kProject / "tools" / tool), tool);
}

TEST_CASE("CITATION.cff cites this version, and CHANGELOG.md has a section for it") {
  const std::string version = KADR_VERSION;
  CHECK(text_of(kProject / "CITATION.cff").find("\nversion: " + version + "\n") != std::string::npos);
  CHECK(text_of(kProject / "CHANGELOG.md").find("\n## " + version + " - ") != std::string::npos);
}
