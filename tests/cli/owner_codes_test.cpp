#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/programs.h"
#include "tests/cli/run_kadr.h"

namespace test = kadr::test;
using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Scratch;
using Json = nlohmann::json;

// --ignore, --ini and --hal, [codes] of a machine file, and the keys of scenarios.

namespace {

/// mill3 with lines behind it.
void write_machine(const Scratch& scratch, const std::string& more) {
  const Finished shown = call({"machine", "show", "mill3"}, scratch.path());
  REQUIRE(shown.code == 0);
  scratch.write("m.toml", shown.out + more);
}

Json run_of(const Scratch& scratch, std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--json", "--no-plant"});
  const Finished run = call(arguments, scratch.path());
  CAPTURE(run.err);
  REQUIRE(run.code == 0);
  return Json::parse(run.out);
}

std::string inputs_hash(const Scratch& scratch, std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"-o", "x.lcmlog", "-q"});
  REQUIRE(call(arguments, scratch.path()).code == 0);
  return Json::parse(call({"info", "x.lcmlog", "--json"}, scratch.path()).out)[0]["inputs_hash"]
      .get<std::string>();
}

}  // namespace

TEST_CASE("--ignore passes codes over in every command that reads programs") {
  const Scratch scratch;
  scratch.write("p.ngc", "G21 G90\nM31\nM101 P2\nG0 X1\nM31\nM2\n");
  for (const std::string command : {"canon", "check", "plan", "run"}) {
    CAPTURE(command);
    CHECK(call({command, "p.ngc"}, scratch.path()).code == 1);
    CHECK(call({command, "p.ngc", "--ignore", "M101,M31"}, scratch.path()).code == 0);
    CHECK(call({command, "p.ngc", "--ignore", "M101", "--ignore", "m31"}, scratch.path()).code == 0);
    for (const char* bad : {"M31,M31", "T5", "", "M101,"}) {
      CAPTURE(bad);
      CHECK(call({command, "p.ngc", "--ignore", bad}, scratch.path()).code == 2);
    }
    const Finished run_itself = call({command, "p.ngc", "--ignore", "M31,M101,M8"}, scratch.path());
    CHECK(run_itself.code == 1);
    CHECK(contains(run_itself.out + run_itself.err, "kadr runs M8"));
  }
}

TEST_CASE("a scenario names codes, INI file and HAL pins as the command line does") {
  const Scratch scratch;
  scratch.write("p.ngc", "G21 G90\nM31\nG1 X#<_ini[A]X> F#<_hal[plasmac.feed]>\nM2\n");
  scratch.write("m.ini", "[A]\nX = 3\n");
  const std::string head = "format = 1\nname = \"s\"\nprogram = \"p.ngc\"\nmachine = \"mill3\"\n";
  scratch.write("s.toml", head +
                              "ini = \"m.ini\"\nignore = [\"M31\"]\n[hal]\nplasmac.feed = "
                              "600\n[expect]\ndiagnostics = [\"K1140\"]\n");
  const Json scenario = run_of(scratch, {"run", "-s", "s.toml", "--no-log"});
  const Json options = run_of(scratch, {"run", "p.ngc", "--no-log", "--ini", "m.ini", "--ignore", "M31",
                                        "--hal", "plasmac.feed=600"});
  CHECK(scenario["run"]["steps_hash"] == options["run"]["steps_hash"]);
  CHECK(call({"scenario", "run", "s.toml"}, scratch.path()).code == 0);
  // the command line's value of a pin counts
  const Json slower = run_of(scratch, {"run", "-s", "s.toml", "--no-log", "--hal", "plasmac.feed=60"});
  CHECK(slower["run"]["time_s"] > options["run"]["time_s"]);
  scratch.write("bad.toml", head + "ignore = [\"M31\", \"M031\"]\n[hal]\n\"a b\" = 1\n");
  const Finished bad = call({"run", "-s", "bad.toml", "--no-log"}, scratch.path());
  CHECK(bad.code == 2);
  CHECK(contains(bad.err, "M31 is given twice"));
  CHECK(contains(bad.err, "'a b' is no name of a pin"));
}

TEST_CASE("an INI file that is broken or missing keeps every command from starting: exit 2") {
  const Scratch scratch;
  scratch.write("p.ngc", test::kSquare);
  scratch.write("bad.ini", "[A]\nX 3\n");
  for (const std::string command : {"canon", "check", "plan", "run"}) {
    CAPTURE(command);
    const Finished bad = call({command, "p.ngc", "--ini", "bad.ini"}, scratch.path());
    CHECK(bad.code == 2);
    CHECK(contains(bad.err, "--> bad.ini:2:1"));
    CHECK(contains(bad.err, "1 error in bad.ini"));
    CHECK(call({command, "p.ngc", "--ini", "none.ini"}, scratch.path()).code == 2);
    CHECK(call({command, "p.ngc", "--ini", "."}, scratch.path()).code == 2);
  }
}

TEST_CASE("the log lists the INI file, and its numbers are inputs of the run") {
  const Scratch scratch;
  scratch.write("p.ngc", test::kSquare);
  scratch.write("a.ini", "[A]\nX = 3\n");
  scratch.write("b.ini", "# the same\n[A]\nX=3.0\n");
  scratch.write("c.ini", "[A]\nX = 4\n");
  const std::string plain = inputs_hash(scratch, {"run", "p.ngc"});
  const std::string a = inputs_hash(scratch, {"run", "p.ngc", "--ini", "a.ini"});
  CHECK(contains(call({"info", "x.lcmlog"}, scratch.path()).out, "a.ini"));
  CHECK(a != plain);
  CHECK(inputs_hash(scratch, {"run", "p.ngc", "--ini", "b.ini"}) == a);
  CHECK(inputs_hash(scratch, {"run", "p.ngc", "--ini", "c.ini"}) != a);
  CHECK(inputs_hash(scratch, {"run", "p.ngc", "--hal", "a=1"}) != plain);
  CHECK(inputs_hash(scratch, {"run", "p.ngc", "--ignore", "M31"}) != plain);
}

TEST_CASE("the machine file gives codes of the owner their time, and M6 the time of a tool change") {
  const Scratch scratch;
  scratch.write("p.ngc", "G21 G90\nT1 M6\nM3 S100\nM10\nG0 X1\nM5\nM2\n");
  const auto seconds = [&](const std::string& codes) {
    write_machine(scratch, "[codes]\n" + codes);
    return run_of(scratch, {"run", "p.ngc", "-m", "m.toml", "--no-log"})["run"]["time_s"].get<double>();
  };
  const double without = seconds("ignore = [\"M10\"]\n");
  CHECK(seconds("M10 = { time_s = 1.5 }\n") == doctest::Approx(without + 1.5));
  CHECK(seconds("M10 = { output = 3 }\nM3 = { time_s = 2 }\n") == doctest::Approx(without + 2));
  // mill3 shows planner.tool_change_s = 0: with an entry for M6 as well, the file says it twice
  write_machine(scratch, "[codes]\nM6 = { time_s = 12 }\n");
  const Finished twice = call({"machine", "check", "m.toml"}, scratch.path());
  CHECK(twice.code != 0);
  CHECK(contains(twice.err + twice.out, "planner.tool_change_s gives the time of M6, too"));
}

TEST_CASE("an entry of [codes] for a code that kadr runs is told at its place in the machine file") {
  const Scratch scratch;
  scratch.write("p.ngc", test::kSquare);
  write_machine(scratch, "[codes]\nignore = [\"M8\"]\nM62 = { time_s = 1 }\n");
  const Finished check = call({"check", "p.ngc", "-m", "m.toml", "--format", "gcc"}, scratch.path());
  CHECK(check.code == 1);
  CHECK(contains(check.err + check.out, "kadr runs M8 itself"));
  CHECK(contains(check.err + check.out, "kadr runs M62 itself"));
  CHECK(contains(check.err + check.out, "m.toml:"));
}
