#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "emulator/scenario/scenario.h"
#include "planner/planner.h"

using namespace kadr;
using namespace kadr::emulator;

namespace {

// the output switches where the second G1 begins, at X50
constexpr const char* kProgram =
    "G21\nG1 X50 F6000\nM62 P1\nG1 X100\nM63 P1\nG1 X150\nM67 E2 Q0.5\nG1 X200\nM2\n";

/// Plans kProgram by a scenario with further keys. @return whether it could be planned
bool prepared(const std::string& keys, Job& job, Diagnostics& diagnostics) {
  // cases run side by side, each in a process of its own
  const auto folder =
      std::filesystem::temp_directory_path() / ("kadr_technology_rule_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "program.ngc") << kProgram;
  std::ofstream(folder / "scenario.toml")
      << "format = 1\nname = \"points\"\nprogram = \"program.ngc\"\nmachine = \"mill3\"\n"
      << keys;
  SourceSet sources;
  const auto scenario = read_scenario(folder.string(), sources);
  REQUIRE(scenario);
  return open_job(*scenario, job, diagnostics) && prepare(job, diagnostics);
}

double end_feed_mm_s(const Job& job, std::size_t segment) { return job.plan.segments[segment].end_u_s; }

}  // namespace

TEST_CASE("a technology rule limits the joint where its output changes, and no other") {
  Job job;
  Diagnostics diagnostics;
  REQUIRE(prepared(
      "[[technology]]\non = \"M62 P1\"\nmax_mm_s = 20\n[[technology]]\non = \"m67 e2\"\nmax_mm_s = 30\n", job,
      diagnostics));
  CHECK(job.machine.model.technology.size() == 2);
  CHECK(end_feed_mm_s(job, 0) == doctest::Approx(20.0).epsilon(1e-6));
  CHECK(end_feed_mm_s(job, 1) > 99.0);  // M63 is another code; whole control ticks take a hair
  CHECK(end_feed_mm_s(job, 2) == doctest::Approx(30.0).epsilon(1e-6));
  CHECK(planner::verify(job.path, job.plan, job.machine.model).empty());
  Job free;
  REQUIRE(prepared("", free, diagnostics));
  CHECK(end_feed_mm_s(free, 0) > 99.0);
  // the plan without the rule is seen to break it
  CHECK(!planner::verify(job.path, free.plan, job.machine.model).empty());
}

TEST_CASE("a technology point of a scenario lies where the first motion of its line begins") {
  Job job;
  Diagnostics diagnostics;
  REQUIRE(prepared("[[technology]]\nat_line = 6\nmax_mm_s = 15\n", job, diagnostics));
  CHECK(end_feed_mm_s(job, 0) > 99.0);
  CHECK(end_feed_mm_s(job, 1) == doctest::Approx(15.0).epsilon(1e-6));
}

TEST_CASE("K3205: a technology point on a line that begins no motion is told with its place") {
  Job job;
  Diagnostics diagnostics;
  CHECK_FALSE(prepared("[[technology]]\nat_line = 1\nmax_mm_s = 15\n", job, diagnostics));
  REQUIRE(diagnostics.has_errors());
  CHECK(diagnostics.list()[0].code == Code::scenario_technology);
  CHECK(diagnostics.list()[0].label == "no motion begins on line 1");
  CHECK(diagnostics.list()[0].span.line == 6);
}
