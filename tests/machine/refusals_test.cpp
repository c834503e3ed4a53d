#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "machine/machine.h"
#include "machine/machine_file.h"
#include "tests/support/golden.h"

using namespace kadr;
using namespace kadr::machine;

namespace {

std::vector<std::filesystem::path> bad_files() {
  std::vector<std::filesystem::path> list;
  for (const auto& entry : std::filesystem::directory_iterator(KADR_SOURCE_DIR "/tests/bad/machine"))
    if (entry.path().extension() == ".toml") list.push_back(entry.path());
  std::sort(list.begin(), list.end());
  return list;
}

/// Settings of the command line are in the first lines of a bad file: "# setting: key=value".
std::vector<std::string> settings_of(const SourceText& source) {
  constexpr std::string_view mark = "# setting: ";
  std::vector<std::string> list;
  for (std::uint32_t line = 1; source.line(line).starts_with(mark); ++line)
    list.emplace_back(source.line(line).substr(mark.size()));
  return list;
}

struct Refusal {
  Diagnostics diagnostics;
  std::string text;  ///< all diagnostics as a person sees them
};

Refusal refuse(const std::filesystem::path& path) {
  const SourceText on_disk = SourceText::open(path.string(), 0);
  SourceSet sources;
  const auto file = read_machine(SourceText(path.filename().string(), std::string(on_disk.text())), sources,
                                 settings_of(on_disk));
  CAPTURE(path.string());
  REQUIRE_FALSE(file);
  Refusal r{file.error(), ""};
  for (const Diagnostic& d : r.diagnostics.list()) r.text += render_human(d, sources) + '\n';
  r.text += count_text(r.diagnostics.errors(), r.diagnostics.warnings()) + '\n';
  return r;
}

}  // namespace

TEST_CASE("each bad machine file is refused with its golden text") {
  const auto files = bad_files();
  CHECK(files.size() >= 20);
  for (const auto& path : files)
    test::check_golden(std::filesystem::path(path).replace_extension(".txt").string(),
                       "tests/machine/refusals_test.cpp", refuse(path).text);
}

TEST_CASE("a bad file named after a code of machine files is refused with that code") {
  for (const auto& path : bad_files()) {
    CAPTURE(path.string());
    const std::string stem = path.stem().string();
    const Diagnostics found = refuse(path).diagnostics;
    const auto codes = all_codes();
    const auto named =
        std::find_if(codes.begin(), codes.end(), [&](const CodeEntry& e) { return e.name == stem; });
    if (named == codes.end()) continue;  // a second example of a code, named differently
    CHECK(std::any_of(found.list().begin(), found.list().end(),
                      [&](const Diagnostic& d) { return d.code == named->code; }));
  }
}

TEST_CASE("every code from K3001 to K3199 has a bad machine file that brings it about") {
  std::set<Code> seen;
  for (const auto& path : bad_files()) {
    const Refusal refusal = refuse(path);
    for (const Diagnostic& d : refusal.diagnostics.list()) seen.insert(d.code);
  }
  for (const CodeEntry& e : all_codes()) {
    const int number = static_cast<int>(e.code);
    // a machine file names no other file: tests/bad/scenario has one that does
    if (e.code == Code::file_outside) continue;
    if (number >= 3000 && number < 3200) CHECK_MESSAGE(seen.count(e.code) == 1, e.name);
  }
}
