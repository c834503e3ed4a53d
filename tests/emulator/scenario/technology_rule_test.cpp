#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "emulator/scenario/scenario.h"
#include "planner/planner.h"
#include "tests/support/run_program.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::scenario;

namespace {

// the output switches where the second G1 begins, at X50
constexpr const char* kProgram =
    "G21\nG1 X50 F6000\nM62 P1\nG1 X100\nM63 P1\nG1 X150\nM67 E2 Q0.5\nG1 X200\nM2\n";

/// Plans kProgram by a scenario with further keys. @return whether it could be planned
bool prepared(const std::string& keys, test::RunResult& r, Diagnostics& diagnostics) {
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
  if (!open_job(*scenario, r.in.given, r.in.sources, diagnostics)) return false;
  auto job = r.in.prepare(diagnostics);
  if (job) r.job.emplace(std::move(*job));
  return job.has_value();
}

double end_feed_mm_s(const test::RunResult& r, std::size_t segment) {
  return r.job->planned.plan.segments[segment].end_u_s;
}

}  // namespace

TEST_CASE("a technology rule limits the joint where its output changes, and no other") {
  test::RunResult r;
  Diagnostics diagnostics;
  REQUIRE(prepared(
      "[[technology]]\non = \"M62 P1\"\nmax_mm_s = 20\n[[technology]]\non = \"m67 e2\"\nmax_mm_s = 30\n", r,
      diagnostics));
  CHECK(r.in.given.machine.model.technology.size() == 2);
  CHECK(end_feed_mm_s(r, 0) == doctest::Approx(20.0).epsilon(1e-6));
  CHECK(end_feed_mm_s(r, 1) > 99.0);  // M63 is another code; whole control ticks take a hair
  CHECK(end_feed_mm_s(r, 2) == doctest::Approx(30.0).epsilon(1e-6));
  CHECK(planner::verify(r.job->read.path, r.job->planned.plan, r.in.given.machine.model).empty());
  test::RunResult free;
  REQUIRE(prepared("", free, diagnostics));
  CHECK(end_feed_mm_s(free, 0) > 99.0);
  // the plan without the rule is seen to break it
  CHECK(!planner::verify(r.job->read.path, free.job->planned.plan, r.in.given.machine.model).empty());
}

TEST_CASE("a technology point of a scenario lies where the first motion of its line begins") {
  test::RunResult r;
  Diagnostics diagnostics;
  REQUIRE(prepared("[[technology]]\nat_line = 6\nmax_mm_s = 15\n", r, diagnostics));
  CHECK(end_feed_mm_s(r, 0) > 99.0);
  CHECK(end_feed_mm_s(r, 1) == doctest::Approx(15.0).epsilon(1e-6));
}

TEST_CASE("K3205: a technology point on a line that begins no motion is told with its place") {
  test::RunResult r;
  Diagnostics diagnostics;
  CHECK_FALSE(prepared("[[technology]]\nat_line = 1\nmax_mm_s = 15\n", r, diagnostics));
  REQUIRE(diagnostics.has_errors());
  CHECK(diagnostics.list()[0].code == Code::scenario_technology);
  CHECK(diagnostics.list()[0].label == "no motion begins on line 1");
  CHECK(diagnostics.list()[0].span.line == 6);
}

TEST_CASE("a technology point at a length of the path cuts the move there, and changes no pulse") {
  test::RunResult r, free;
  Diagnostics diagnostics;
  REQUIRE(prepared("[[technology]]\nat_path_mm = 75\nmax_mm_s = 20\n", r, diagnostics));
  REQUIRE(prepared("", free, diagnostics));
  // within the second of four moves of 50 mm
  REQUIRE(r.job->read.path.size() == free.job->read.path.size() + 1);
  CHECK(r.job->read.blocks == free.job->read.blocks);
  CHECK(r.job->read.path.start_s_u[2] == 75.0);
  CHECK(end_feed_mm_s(r, 0) > 99.0);
  CHECK(end_feed_mm_s(r, 1) == doctest::Approx(20.0).epsilon(1e-6));
  CHECK(end_feed_mm_s(r, 2) > 99.0);
  CHECK(planner::verify(r.job->read.path, r.job->planned.plan, r.in.given.machine.model).empty());
  // events between moves stay at their joint
  for (std::size_t i = 0; i < free.job->read.events.size(); ++i) {
    const std::size_t at = free.job->read.events[i].after_segment;
    CHECK(r.job->read.path.start_s_u[r.job->read.events[i].after_segment] ==
          free.job->read.path.start_s_u[at]);
  }
  RunOptions options;
  options.plant = false;
  const auto slow = run(*r.job, nullptr, options), fast = run(*free.job, nullptr, options);
  REQUIRE(slow);
  REQUIRE(fast);
  for (std::size_t c = 0; c < slow->axis.size(); ++c) CHECK(slow->axis[c].pulses == fast->axis[c].pulses);

  SUBCASE("at a joint nothing is cut, at the end nothing is limited") {
    test::RunResult at_joint;
    REQUIRE(prepared(
        "[[technology]]\nat_path_mm = 50\nmax_mm_s = 20\n[[technology]]\nat_path_mm = 200\nmax_mm_s = 1\n",
        at_joint, diagnostics));
    CHECK(at_joint.job->read.path.size() == free.job->read.path.size());
    CHECK(end_feed_mm_s(at_joint, 0) == doctest::Approx(20.0).epsilon(1e-6));
  }
}

TEST_CASE("K3205: a technology point behind the path's end is told with measured and allowed length") {
  test::RunResult r;
  Diagnostics diagnostics;
  CHECK_FALSE(prepared("[[technology]]\nat_path_mm = 200.5\nmax_mm_s = 15\n", r, diagnostics));
  REQUIRE(diagnostics.has_errors());
  CHECK(diagnostics.list()[0].code == Code::scenario_technology);
  CHECK(diagnostics.list()[0].label == "is at 200.5 mm of the path");
  CHECK(diagnostics.list()[0].notes[0] == "allowed: 0 to 200 mm, its length");
  CHECK(diagnostics.list()[0].span.line == 6);
}
