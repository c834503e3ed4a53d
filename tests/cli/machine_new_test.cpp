#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Launch;
using kadr::test::run_kadr;
using kadr::test::Scratch;
using MachineJson = nlohmann::json;

namespace {

const std::vector<std::string> kRouter = {
    "machine",    "new",         "router",     "--axes",         "XYZ", "--travel",
    "800,800,80", "--max-speed", "5000mm/min", "--acceleration", "200", "--steps-per-mm",
    "40"};

/// A circle as a CAM system writes it: short lines, approach and retract.
std::string short_lines(double centre_mm, double radius_mm, int lines) {
  std::string text = "G21 G90 G94 G17\nG0 Z5\n";
  for (int i = 0; i <= lines; ++i) {
    const double angle = 6.283185307179586 * i / lines;
    const std::string place = fmt::format("X{:.3f} Y{:.3f}", centre_mm + radius_mm * std::cos(angle),
                                          centre_mm + radius_mm * std::sin(angle));
    text += i == 0 ? "G0 " + place + "\nG1 Z-1 F300\n" : "G1 " + place + (i == 1 ? " F3000\n" : "\n");
  }
  return text + "G0 Z5\nM2\n";
}

}  // namespace

TEST_CASE("kadr machine new from a data sheet: a file that check passes and a program runs on") {
  const Scratch scratch;
  const Finished made = call(kRouter, scratch.path());
  CHECK(made.code == 0);
  CHECK(made.err.empty());
  CHECK(contains(made.out, "wrote router.toml, from a data sheet:\n"));
  CHECK(contains(made.out, "83.33 mm/s (5 000 mm/min)"));
  CHECK(contains(made.out, "defaults that matter"));
  CHECK(contains(made.out, "junction_acceleration_mm_s2"));
  CHECK(call({"machine", "check", "router.toml"}, scratch.path()).out ==
        "router.toml: machine router, axes X Y Z: no errors\n");
  const std::string shown = call({"machine", "show", "router.toml"}, scratch.path()).out;
  for (const char* line :
       {"max_mm_s = 83.33333333333333 ", "max_acceleration_mm_s2 = 200 ", "step_mm = 0.025 ",
        "range_mm = [0, 800] ", "range_mm = [-40, 40] ", "junction_acceleration_mm_s2 = 2600 "})
    CHECK(contains(shown, std::string("\n") + line));
  // the command in the file's head writes the same file
  const std::string text = scratch.read("router.toml");
  CHECK(contains(text,
                 "#   kadr machine new router --axes XYZ --travel 800,800,80 --max-speed 5000mm/min "
                 "--acceleration 200 --steps-per-mm 40\n"));

  scratch.write("part.ngc", short_lines(100, 20, 300));
  const Finished check = call({"check", "part.ngc", "-m", "router.toml", "--json"}, scratch.path());
  CHECK(check.code == 0);
  const auto time_s = [](const Finished& f) {
    return MachineJson::parse(f.out)[0]["check"]["time_s"].get<double>();
  };
  CHECK(call({"run", "part.ngc", "-m", "router.toml", "-q"}, scratch.path()).code == 0);
  // with the axis' own acceleration at corners, the default of the key, time doubles
  std::vector<std::string> slow = {"check", "part.ngc", "-m", "router.toml", "--json"};
  for (const char* axis : {"X", "Y"})
    slow.insert(slow.end(), {"--set", fmt::format("axis.{}.junction_acceleration_mm_s2=200", axis)});
  CHECK(time_s(call(slow, scratch.path())) > 1.5 * time_s(check));
}

TEST_CASE("kadr machine new from a data sheet: JSON, --force, refusals write nothing") {
  const Scratch scratch;
  std::vector<std::string> json = kRouter;
  json.push_back("--json");
  const auto j = MachineJson::parse(call(json, scratch.path()).out);
  CHECK(j["file"] == "router.toml");
  CHECK(j["copied_from"].is_null());
  CHECK(j["axes"][2]["min_u"] == -40);
  CHECK(j["axes"][0]["max_jerk_u_s3"].is_null());
  const Finished again = call(kRouter, scratch.path());
  CHECK(again.code == 2);
  CHECK(contains(again.err, "--force overwrites it"));
  const Finished both = call(
      {"machine", "new", "b", "--travel", "5", "--max-speed", "5mm/s", "--from", "rig1"}, scratch.path());
  CHECK(both.code == 2);
  CHECK(contains(both.err, "--from copies a machine"));
  for (const std::string travel : {"800,800", "-5", "nan"}) {
    const Finished bad =
        call({"machine", "new", "b", "--travel", travel, "--max-speed", "5mm/s"}, scratch.path());
    CHECK(bad.code == 2);
    CHECK(bad.out.empty());
    CHECK(contains(bad.err, "kadr: machine new: --travel"));
  }
  const Finished empty = call({"machine", "new", "b", "--axes", ""}, scratch.path());
  CHECK(empty.code == 2);
  CHECK(contains(empty.err, "kadr machine new: --axes needs a value (LETTERS); got an empty one\n"));
  CHECK_FALSE(scratch.has("b.toml"));
  CHECK(contains(call({"machine", "new", "c"}, scratch.path()).out,
                 "from a data sheet instead: kadr machine new c"));
}

TEST_CASE("kadr machine new refuses a name that a machine file can't have, as a data sheet and as a copy") {
  const Scratch scratch;
  const std::vector<std::string> sheet = {"--travel", "5", "--max-speed", "5mm/s"};
  const struct {
    std::string name, complaint;
  } names[] = {{std::string(101, 'm'), "101 characters; allowed: up to 100\n"},
               {"-mill", "a name that begins with - reads as an option; begin with a letter, a digit or _\n"},
               {"a/b", "letters, digits, _ and - make a name"}};
  for (const auto& [name, complaint] : names) {
    for (const bool copy : {false, true}) {
      std::vector<std::string> words = {"machine", "new"};
      if (!copy) words.insert(words.end(), sheet.begin(), sheet.end());
      words.insert(words.end(), {"--", name});
      const Finished made = call(words, scratch.path());
      CHECK(made.code == 2);
      CHECK(contains(made.err, "kadr: machine name '" + name + "': "));
      CHECK(contains(made.err, complaint));
      CHECK_FALSE(scratch.has(name + ".toml"));
    }
  }
  const std::string longest(100, 'm');
  CHECK(call({"machine", "new", longest}, scratch.path()).code == 0);
  CHECK(call({"machine", "check", longest + ".toml"}, scratch.path()).code == 0);
}

TEST_CASE("kadr machine new: programs run on machines of random data sheets") {
  const Scratch scratch;
  const auto seed = kadr::test::seed_or(16);
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return low * std::pow(high / low, std::uniform_real_distribution<double>(0, 1)(random));
  };
  scratch.write("part.ngc", short_lines(60, 10, 40));
  for (int round = 0; round < kadr::test::count_or(5); ++round) {
    const std::vector<std::string> make = {"machine",
                                           "new",
                                           "m",
                                           "--force",
                                           "--travel",
                                           "100,100,50",
                                           "--max-speed",
                                           fmt::format("{:.3g}mm/min", uniform(200, 60'000)),
                                           "--acceleration",
                                           fmt::format("{:.3g}", uniform(20, 20'000)),
                                           "--steps-per-mm",
                                           fmt::format("{:.3g}", uniform(5, 2000)),
                                           "--jerk",
                                           round % 2 == 0 ? "inf" : fmt::format("{:.3g}", uniform(1e3, 1e6))};
    CAPTURE(fmt::format("{}", fmt::join(make, " ")));
    REQUIRE(call(make, scratch.path()).code == 0);
    const Finished run = call({"run", "part.ngc", "-m", "m.toml", "--no-log", "--json"}, scratch.path());
    CHECK(run.code == 0);
    if (run.code != 0) continue;
    const auto j = MachineJson::parse(run.out);
    CHECK(j["run"]["outcome"] == "complete");
    CHECK(j["run"]["time_s"].get<double>() > 1.0);
  }
}

TEST_CASE("kadr machine new --ask asks on a terminal, and does not hang in a script") {
  const Scratch scratch;
  const Finished script = call({"machine", "new", "shop", "--ask"}, scratch.path(), "XYZ\n800\n");
  CHECK(script.code == 2);
  CHECK(contains(script.err, "--ask needs a terminal"));
  CHECK_FALSE(scratch.has("shop.toml"));

  if (kadr::test::lacks_terminals()) return;
  // given values are checked before the first question
  for (const auto& [option, value, complaint] :
       {std::array{"--acceleration", "5parsec", "unit 'parsec' is not known"},
        std::array{"--axes", "XX", "X is given twice"},
        std::array{"--tool-change", "-1", "--tool-change is -1"},
        std::array{"--max-speed", "5000", "add the unit"}}) {
    Launch wrong;
    wrong.arguments = {"machine", "new", "shop", "--ask", std::string(option) + '=' + value};
    wrong.folder = scratch.path();
    wrong.terminal = wrong.terminal_input = true;
    const Finished refused = run_kadr(wrong);
    CAPTURE(refused.out);
    CHECK(refused.code == 2);
    CHECK(contains(refused.out, complaint));
    CHECK_FALSE(contains(refused.out, "Travel of each axis"));
  }
  Launch launch;
  launch.arguments = {"machine", "new", "shop", "--ask", "--steps-per-mm", "40"};
  launch.folder = scratch.path();
  launch.terminal = true;
  launch.terminal_input = true;
  launch.input = "XYX\n\n800,800\n800,800,80\n5000\n5000mm/min\n\n\n";
  const Finished asked = run_kadr(launch);
  CAPTURE(asked.out);
  CHECK(asked.code == 0);
  CHECK(contains(asked.out, "X is given twice"));
  CHECK(contains(asked.out, "got 2: '800,800'"));
  CHECK(contains(asked.out, "add the unit"));
  CHECK(contains(asked.out, "Acceleration in mm/s2 or deg/s2 [500]: "));
  CHECK(contains(asked.out, "wrote shop.toml"));
  CHECK(contains(scratch.read("shop.toml"), "max_acceleration_mm_s2 = 500 "));
  CHECK(contains(scratch.read("shop.toml"), "steps_per_mm = 40 "));
}
