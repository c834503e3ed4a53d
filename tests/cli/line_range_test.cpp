#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Scratch;
using Json = nlohmann::json;

TEST_CASE("--from-line and --to-line cut a program, and name what can't be cut") {
  const Scratch scratch;
  scratch.write("p.ngc", "G21 G90 F600\nG1 X10\nG1 Y10\n(turn)\nG1 X20\nM2\n");
  const Finished check = call({"check", "p.ngc", "--from-line", "5"}, scratch.path());
  CHECK(check.code == 0);
  CHECK(contains(check.out, "   1 block\n  approach     "));
  CHECK(contains(check.out, "X Y, to where line 5 begins\n"));
  CHECK(contains(check.out, "path         10.000 mm"));
  const Json j =
      Json::parse(call({"check", "p.ngc", "--from-line", "5", "--json"}, scratch.path()).out)[0]["check"];
  CHECK(j["blocks"] == 1);
  CHECK(j["path_u"] == doctest::Approx(10));
  CHECK(j["approach"]["axes"] == Json::array({"XY"}));
  CHECK(j["approach"]["line"] == 5);
  CHECK(j["time_s"].get<double>() > j["approach"]["time_s"].get<double>() + 1);
  CHECK_FALSE(
      Json::parse(call({"check", "p.ngc", "--json"}, scratch.path()).out)[0]["check"].contains("approach"));
  const Finished plan = call({"plan", "p.ngc", "--from-line", "3", "--to-line", "3"}, scratch.path());
  CHECK(contains(plan.out, "  approach: X\n"));
  CHECK(contains(plan.out, "2 rows, "));
  const Json rows =
      Json::parse(call({"plan", "p.ngc", "--from-line", "3", "--json"}, scratch.path()).out)["rows"];
  CHECK(rows[0]["motion"] == "approach");
  CHECK(rows[0]["axes"] == Json::array({"X"}));
  CHECK(contains(call({"plan", "p.ngc", "--from-line", "3", "--csv"}, scratch.path()).out, "\n3,approach,,"));
  const Finished canon = call({"canon", "p.ngc", "--from-line", "3", "--to-line", "3"}, scratch.path());
  CHECK(contains(canon.out, "APPROACH 10.000000 0.000000 "));
  CHECK(contains(canon.out, "PROGRAM_END @3\n"));
  const Finished summary =
      call({"run", "p.ngc", "--no-log", "--no-plant", "--from-line", "5"}, scratch.path());
  CHECK(contains(summary.out, "\napproach        "));
  const Finished refused = call({"check", "p.ngc", "--from-line", "4"}, scratch.path());
  CHECK(refused.code == 1);
  CHECK(contains(refused.out, "error[K1070]"));
  CHECK(contains(refused.out, "the nearest lines that can be entered are 3 and 5"));
  CHECK(call({"check", "p.ngc", "--from-line", "5", "--to-line", "3"}, scratch.path()).code == 1);
  for (const char* bad : {"0", "-3", "x", "1.5", "9999999999"}) {
    CAPTURE(bad);
    const Finished told = call({"plan", "p.ngc", "--from-line", bad}, scratch.path());
    CHECK(told.code == 2);
    CHECK(contains(told.err, "--from-line takes a line number of the program, 1 or above; got"));
  }
}

TEST_CASE("a log keeps the lines between which its program was run, and has the approach") {
  const Scratch scratch;
  scratch.write("p.ngc", "G21 G90 F600\nG1 X10\nG1 Y10\nG1 X20\nM2\n");
  scratch.write(
      "scenario.toml",
      "format = 1\nname = \"part\"\nprogram = \"p.ngc\"\nmachine = \"mill3\"\nfrom_line = 4\nto_line = 4\n");
  const auto log_of = [&](std::vector<std::string> arguments, const std::string& log) {
    arguments.insert(arguments.end(), {"--no-plant", "-o", log});
    CHECK(call(arguments, scratch.path()).code == 0);
    CHECK(contains(call({"info", log}, scratch.path()).out, "records     2 blocks"));
  };
  log_of({"run", "p.ngc", "--from-line", "4"}, "a.lcmlog");
  log_of({"run", "p.ngc", "--from-line", "3", "--to-line", "3"}, "b.lcmlog");
  log_of({"run", "-s", "scenario.toml"}, "c.lcmlog");
  log_of({"run", "-s", "scenario.toml", "--from-line", "3", "--to-line", "3"}, "d.lcmlog");
  CHECK(contains(call({"diff", "a.lcmlog", "b.lcmlog"}, scratch.path()).out, "from_line = "));
  CHECK(contains(call({"diff", "a.lcmlog", "c.lcmlog"}, scratch.path()).out, "to_line = "));
  CHECK(call({"scenario", "run", "scenario.toml"}, scratch.path()).code == 0);
}
