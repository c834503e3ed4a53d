#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "emulator/scenario/scenario.h"
#include "tests/support/golden.h"

using namespace kadr;

namespace {

/// All diagnostics of a scenario file as a person sees them, its folder left out.
std::string refuse(const std::filesystem::path& path) {
  SourceSet sources;
  const auto scenario = scenario::read_scenario(path.string(), sources);
  REQUIRE_FALSE(scenario);
  std::string text;
  for (const Diagnostic& d : scenario.error().list()) text += render_human(d, sources) + '\n';
  const std::string folder = path.parent_path().string() + "/";
  for (auto at = text.find(folder); at != text.npos; at = text.find(folder)) text.erase(at, folder.size());
  const std::string below = "below " + path.parent_path().string();
  for (auto at = text.find(below); at != text.npos; at = text.find(below))
    text.replace(at, below.size(), "below FOLDER");
  return text;
}

}  // namespace

TEST_CASE("each bad scenario file is refused with its golden text") {
  const std::filesystem::path bad = std::filesystem::path(KADR_SOURCE_DIR) / "tests/bad/scenario";
  for (const std::string name :
       {"K3014_outside", "K3201_file_missing", "K3202_program", "K3203_step", "K3204_value"})
    test::check_golden((bad / (name + ".txt")).string(), "tests/emulator/scenario/scenario_refusals_test.cpp",
                       refuse(bad / (name + ".toml")));
}
