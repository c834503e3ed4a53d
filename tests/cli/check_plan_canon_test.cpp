#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/programs.h"
#include "tests/cli/run_kadr.h"

namespace test = kadr::test;
using kadr::test::call;
using kadr::test::check_golden;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Scratch;
using Json = nlohmann::json;

// Commands that read a program and move nothing.

TEST_CASE("kadr check tells time, travel and what limits the feed, and has no log") {
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  const Finished check = call({"check", "square.ngc"}, scratch.path());
  CHECK(check.code == 0);
  CHECK(check.err.empty());
  check_golden("check_square.txt", check.out);
  CHECK(!scratch.has("square.lcmlog"));
  const Json j = Json::parse(call({"check", "square.ngc", "--json"}, scratch.path()).out)[0];
  CHECK(j["check"]["dwell_s"] == 0.5);
  CHECK(j["check"]["axes"][0]["max_u"] == 30.0);
  double shared_s = 0;
  for (const Json& share : j["check"]["limited_by"]) shared_s += share["time_s"].get<double>();
  CHECK(shared_s == doctest::Approx(j["check"]["time_s"].get<double>()));
}

TEST_CASE("kadr check goes on with the other programs and answers with the worst") {
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  scratch.write("six.ngc", test::kSixMistakes);
  const Finished both = call({"check", "six.ngc", "square.ngc"}, scratch.path());
  CHECK(both.code == 1);
  CHECK(contains(both.out, "square.ngc on mill3"));
  const Finished three = call({"check", "missing.ngc", "six.ngc", "square.ngc", "--json"}, scratch.path());
  CHECK(three.code == 2);
  CHECK(Json::parse(three.out).size() == 2);
}

TEST_CASE("a soft limit that a program leaves is an error of kadr check and an alarm of kadr run") {
  const Scratch scratch;
  scratch.write("far.ngc", "G21 G90\nG0 X100\nG1 X100000 F6000\nM2\n");
  const Finished check = call({"check", "far.ngc"}, scratch.path());
  CHECK(check.code == 1);
  CHECK(contains(check.out, "error[K4101]"));
  CHECK(contains(check.out, "OUTSIDE"));
  const Finished run =
      call({"run", "far.ngc", "--no-plant", "--no-log", "--until", "20", "--json"}, scratch.path());
  CHECK(run.code == 3);
  const Json j = Json::parse(run.out);
  CHECK(j["diagnostics"][0]["severity"] == "warning");
  CHECK(j["run"]["alarm_counts"].contains("K5101"));
  CHECK(j["run"]["alarm_list"][0]["line"] == 3);
  CHECK(j["exit_code"] == 3);
  const Finished strict = call({"run", "far.ngc", "--strict"}, scratch.path());
  CHECK(strict.code == 1);
  CHECK(!scratch.has("far.lcmlog"));
}

TEST_CASE("kadr plan prints a row a block, as table, CSV and JSON with the same numbers") {
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  const Finished table = call({"plan", "square.ngc"}, scratch.path());
  CHECK(table.code == 0);
  check_golden("plan_square.txt", table.out);
  const Finished csv = call({"plan", "square.ngc", "--csv"}, scratch.path());
  CHECK(csv.code == 0);
  CHECK(csv.out.substr(0, csv.out.find('\n')) ==
        "line,motion,unit,length_u,begin_s,time_s,programmed_u_s,peak_u_s,end_u_s,limited_by,text");
  // rapid, four sides and a dwell
  CHECK(std::count(csv.out.begin(), csv.out.end(), '\n') == 7);
  const Json j = Json::parse(call({"plan", "square.ngc", "--json"}, scratch.path()).out);
  REQUIRE(j["rows"].size() == 6);
  CHECK(j["rows"][1]["length_u"] == 20.0);
  CHECK(j["rows"][1]["programmed_u_s"] == 10.0);
  CHECK(j["rows"][3]["motion"] == "dwell");
  CHECK(j["rows"][3]["time_s"] == 0.5);
  SUBCASE("block by block also how each block came to whole control ticks") {
    const std::vector<std::string> blockwise = {"plan", "square.ngc", "--set", "planner.scheduler=blockwise"};
    const auto with = [&](const std::string& option) {
      auto arguments = blockwise;
      if (!option.empty()) arguments.push_back(option);
      return call(arguments, scratch.path()).out;
    };
    check_golden("plan_square_blockwise.txt", with(""));
    CHECK(contains(with("--csv"), "limited_by,rule,kl,end_jump_u_s,text\n"));
    const Json rows = Json::parse(with("--json"))["rows"];
    CHECK(rows[1]["rule"] == "a");
    CHECK(rows[1]["kl"] == 1.0);
    CHECK(rows[1]["end_jump_u_s"] == 0.0);
    CHECK(rows[3]["rule"].is_null());
  }
  // each row begins where the one before it ends
  double end_s = 0;
  for (const Json& row : j["rows"]) {
    CHECK(row["begin_s"] == doctest::Approx(end_s));
    end_s = row["begin_s"].get<double>() + row["time_s"].get<double>();
  }
  CHECK(end_s == doctest::Approx(j["time_s"].get<double>()));
  CHECK(Json::parse(call({"plan", "-", "--json"}, scratch.path(), "").out)["rows"].empty());
}

TEST_CASE("kadr plan names the code for which a motion stops") {
  const Scratch scratch;
  scratch.write("p.ngc", "G21 G90 F3000\nS100 M3\nG1 X10\nM3\nG1 X20\nM8\nG1 X30\nM2\n");
  const Finished plan = call({"plan", "p.ngc"}, scratch.path());
  CHECK(plan.code == 0);
  CHECK(contains(plan.out, "stops for spindle clockwise (line 4)\n"));
  const Json rows = Json::parse(call({"plan", "p.ngc", "--json"}, scratch.path()).out)["rows"];
  CHECK(rows[0]["stops_for"] == "spindle clockwise (line 4)");
  CHECK(rows[1]["stops_for"] == "flood on (line 6)");
  // the end of the program needs no word
  CHECK_FALSE(rows[2].contains("stops_for"));
}

TEST_CASE("--offset and units of the machine hold before the first line") {
  const Scratch scratch;
  scratch.write("p.ngc", "G0 X1\nM2\n");
  const Finished twice = call({"canon", "p.ngc", "--offset", "G54=1", "--offset", "G54=5"}, scratch.path());
  CHECK(twice.code == 2);
  CHECK(contains(twice.err, "--offset gives G54 twice"));
  const Finished canon = call({"canon", "p.ngc", "--offset", "G54=10,20,-30"}, scratch.path());
  CHECK(contains(canon.out, "STRAIGHT_TRAVERSE 11.000000 0.000000 0.000000 "));
  CHECK(contains(canon.err, "[K1125]"));
  const Finished inch = call({"check", "p.ngc", "--set", "units=inch", "--strict"}, scratch.path());
  CHECK(inch.code == 0);
  CHECK(contains(inch.out, "X   0.000  25.400"));
  CHECK(call({"check", "p.ngc", "--strict"}, scratch.path()).code == 1);
  CHECK(call({"run", "p.ngc", "--no-plant", "--offset", "G55=1", "-o", "a.lcmlog"}, scratch.path()).code ==
        0);
  CHECK(call({"run", "p.ngc", "--no-plant", "-o", "b.lcmlog"}, scratch.path()).code == 0);
  // the offset is an input, even of a work system that moves nothing
  const auto inputs = [&](const char* log) {
    const std::string out = call({"info", log}, scratch.path()).out;
    const std::size_t at = out.find("inputs");
    return out.substr(at, out.find('\n', at) - at);
  };
  CHECK(inputs("a.lcmlog") != inputs("b.lcmlog"));
  for (const char* bad :
       {"G53=1", "G54", "G54=", "G54=1,", "G54=1;2", "G54=1e300", "G54=0,0,0,0,0,0,0,0,0,0", "54=1"}) {
    CAPTURE(bad);
    const Finished refused = call({"canon", "p.ngc", "--offset", bad}, scratch.path());
    CHECK(refused.code == 2);
    CHECK(contains(refused.err, "G54=10,10,-30"));
  }
}

TEST_CASE("--offset of an axis that the machine lacks is refused, unless it is 0") {
  const Scratch scratch;
  scratch.write("p.ngc", "G21 G0 X1\nM2\n");
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"check", "p.ngc"}, {"plan", "p.ngc"}, {"run", "p.ngc", "--no-log"}}) {
    CAPTURE(command.front());
    const auto with = [&](const char* offset) {
      std::vector<std::string> arguments = command;
      arguments.insert(arguments.end(), {"--offset", offset});
      return call(arguments, scratch.path());
    };
    CHECK(with("G54=1,2,3,0").code == 0);
    const Finished refused = with("G54=1,2,3,90");
    CHECK(refused.code == 2);
    CHECK(contains(refused.err,
                   "--offset gives A the zero 90, and machine mill3 has no such axis; its axes: XYZ"));
  }
}

TEST_CASE("kadr canon prints one call a line, in mm, and leaves out / lines on demand") {
  const Scratch scratch;
  scratch.write("part.ngc", "G20 G90\n/G0 X2\nG1 X1 F10 (MSG, hi)\nM2\n");
  const Finished all = call({"canon", "part.ngc"}, scratch.path());
  CHECK(all.code == 0);
  CHECK(contains(all.out, "STRAIGHT_TRAVERSE 50.800000 0.000000"));
  CHECK(contains(all.out, "STRAIGHT_FEED 25.400000 0.000000"));
  check_golden("canon_part.txt", all.out);
  const Finished some = call({"canon", "part.ngc", "--block-delete"}, scratch.path());
  CHECK(!contains(some.out, "STRAIGHT_TRAVERSE"));
  const Finished third = call({"canon", "part.ngc", "--lines", "2"}, scratch.path());
  CHECK(std::count(third.out.begin(), third.out.end(), '\n') == 1);
  const Json j = Json::parse(call({"canon", "part.ngc", "--json"}, scratch.path()).out);
  bool found = false;
  for (const Json& call : j["calls"])
    if (call["call"] == "STRAIGHT_FEED") {
      found = true;
      CHECK(call["line"] == 3);
      CHECK(call["arguments"][0] == 25.4);
      CHECK(call["arguments"].size() == 9);
    }
  CHECK(found);
}

TEST_CASE("kadr canon of a program with an error prints the moves before it and an ERROR line") {
  const Scratch scratch;
  scratch.write("bad.ngc", "G21\nG0 X1\nG0 X2 G1 X3\nG0 X4\nM2\n");
  const Finished run = call({"canon", "bad.ngc"}, scratch.path());
  CHECK(run.code == 1);
  CHECK(contains(run.out, "STRAIGHT_TRAVERSE 1.000000"));
  CHECK(!contains(run.out, "STRAIGHT_TRAVERSE 4.000000"));
  const auto last = run.out.rfind('\n', run.out.size() - 2) + 1;
  CHECK(run.out.substr(last, 9) == "ERROR 3 \"");
  CHECK(contains(run.err, "--> bad.ngc:3:"));
  CHECK(Json::parse(call({"canon", "bad.ngc", "--json"}, scratch.path()).out)["exit_code"] == 1);
}
