#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "emulator/scenario/scenario.h"
#include "tests/support/recording_log.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::log;
using namespace kadr::scenario;

namespace {

// the faster an arc may be, the less of the axes' acceleration is left for its ramps
constexpr const char* kArcs =
    "G21 G90 G94 G17 G61\nG1 X6 F800\nG3 X6 Y0 I-6 J0 F1200\nG3 X0 Y0 I-3 J0\nG0 Z5\nM2\n";

/// A scenario of kArcs with further keys, read.
tl::expected<Scenario, Diagnostics> scenario_with(const std::string& keys, SourceSet& sources) {
  // cases run side by side, each in a process of its own
  const auto folder =
      std::filesystem::temp_directory_path() / ("kadr_most_override_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "program.ngc") << kArcs;
  std::ofstream(folder / "scenario.toml")
      << "format = 1\nname = \"arc\"\nprogram = \"program.ngc\"\nmachine = \"mill3\"\n"
      << keys;
  return read_scenario(folder.string(), sources);
}

/// s at the end of each control tick, with the override at 130 % from the beginning.
std::vector<double> ride(const std::string& keys) {
  SourceSet sources;
  const auto scenario = scenario_with(keys + "[[step]]\nat_tick = 0\noverride_pct = 130\n", sources);
  REQUIRE(scenario);
  JobInputs given;
  SourceSet program;
  Diagnostics diagnostics;
  REQUIRE(open_job(*scenario, given, program, diagnostics));
  const auto job = prepare(given, program, diagnostics);
  REQUIRE(job.has_value());
  test::RecordingLog log;
  RunHeader header;
  header.machine = &given.machine.model;
  REQUIRE(log.begin(header).has_value());
  RunOptions options;
  options.plant = false;
  REQUIRE(run(*job, &log, options).has_value());
  std::vector<double> places_u;
  for (const auto& tick : log.ticks) places_u.push_back(tick.motion.s_end_u);
  return places_u;
}

std::string most_override_refusal(const std::string& keys) {
  SourceSet sources;
  const auto scenario = scenario_with(keys, sources);
  if (scenario) return "";
  std::string labels;
  for (const Diagnostic& d : scenario.error().list()) labels += d.label + "; ";
  return labels;
}

}  // namespace

TEST_CASE("without most_override_pct a run is prepared for the highest override of its timeline") {
  CHECK(ride("") == ride("most_override_pct = 130\n"));
}

TEST_CASE("most_override_pct prepares a run for more than its timeline asks for") {
  // arcs are prepared for 40 mm/s in place of 26, so their ramps are flatter
  const auto timeline = ride(""), live = ride("most_override_pct = 200\n");
  CHECK(live != timeline);
  CHECK(live.size() >= timeline.size());
}

TEST_CASE("most_override_pct is 100 to 200, and no step is above it") {
  CHECK(most_override_refusal("most_override_pct = 100\n").empty());
  CHECK(most_override_refusal("most_override_pct = 200\n").empty());
  CHECK(!most_override_refusal("most_override_pct = 99\n").empty());
  CHECK(!most_override_refusal("most_override_pct = 201\n").empty());
  CHECK(most_override_refusal("most_override_pct = 120\n[[step]]\nat_s = 1\noverride_pct = 150\n") ==
        "an override of 150 % is above most_override_pct = 120; ");
  CHECK(most_override_refusal("most_override_pct = 150\n[[step]]\nat_s = 1\noverride_pct = 150\n").empty());
}
