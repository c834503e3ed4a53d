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

TEST_CASE("a technology point at a length of the path cuts the move there, and changes no pulse") {
  Job job, free;
  Diagnostics diagnostics;
  REQUIRE(prepared("[[technology]]\nat_path_mm = 75\nmax_mm_s = 20\n", job, diagnostics));
  REQUIRE(prepared("", free, diagnostics));
  // within the second of four moves of 50 mm
  REQUIRE(job.path.size() == free.path.size() + 1);
  CHECK(job.blocks == free.blocks);
  CHECK(job.path.start_s_u[2] == 75.0);
  CHECK(end_feed_mm_s(job, 0) > 99.0);
  CHECK(end_feed_mm_s(job, 1) == doctest::Approx(20.0).epsilon(1e-6));
  CHECK(end_feed_mm_s(job, 2) > 99.0);
  CHECK(planner::verify(job.path, job.plan, job.machine.model).empty());
  // events between moves stay at their joint
  for (std::size_t i = 0; i < free.events.size(); ++i) {
    const std::size_t at = free.events[i].after_segment;
    CHECK(job.path.start_s_u[job.events[i].after_segment] == free.path.start_s_u[at]);
  }
  RunOptions options;
  options.plant = false;
  const auto slow = run(job, nullptr, options), fast = run(free, nullptr, options);
  REQUIRE(slow);
  REQUIRE(fast);
  for (std::size_t c = 0; c < slow->axis.size(); ++c) CHECK(slow->axis[c].pulses == fast->axis[c].pulses);

  SUBCASE("at a joint nothing is cut, at the end nothing is limited") {
    Job at_joint;
    REQUIRE(prepared(
        "[[technology]]\nat_path_mm = 50\nmax_mm_s = 20\n[[technology]]\nat_path_mm = 200\nmax_mm_s = 1\n",
        at_joint, diagnostics));
    CHECK(at_joint.path.size() == free.path.size());
    CHECK(end_feed_mm_s(at_joint, 0) == doctest::Approx(20.0).epsilon(1e-6));
  }
}

TEST_CASE("K3205: a technology point behind the path's end is told with measured and allowed length") {
  Job job;
  Diagnostics diagnostics;
  CHECK_FALSE(prepared("[[technology]]\nat_path_mm = 200.5\nmax_mm_s = 15\n", job, diagnostics));
  REQUIRE(diagnostics.has_errors());
  CHECK(diagnostics.list()[0].code == Code::scenario_technology);
  CHECK(diagnostics.list()[0].label == "is at 200.5 mm of the path");
  CHECK(diagnostics.list()[0].notes[0] == "allowed: 0 to 200 mm, its length");
  CHECK(diagnostics.list()[0].span.line == 6);
}
