#include <doctest/doctest.h>

#include <algorithm>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/programs.h"
#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::kSquare;
using kadr::test::Scratch;
using Json = nlohmann::json;

namespace {

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// The square's log, and a second one of the same program with other settings.
struct Logs {
  Scratch scratch;
  explicit Logs(std::vector<std::string> settings = {}) {
    scratch.write("square.ngc", kSquare);
    REQUIRE(call({"run", "square.ngc", "-o", "a.lcmlog", "-q"}, scratch.path()).code == 0);
    std::vector<std::string> arguments = {"run", "square.ngc", "-o", "b.lcmlog", "-q"};
    arguments.insert(arguments.end(), settings.begin(), settings.end());
    REQUIRE(call(arguments, scratch.path()).code == 0);
  }
  Finished diff(std::vector<std::string> options = {}, const std::string& a = "a.lcmlog",
                const std::string& b = "b.lcmlog") const {
    options.insert(options.begin(), {"diff", a, b});
    return call(options, scratch.path());
  }
};

}  // namespace

TEST_CASE("kadr diff of two equal runs answers yes, by tick and by path") {
  const Logs logs;
  const Finished same = logs.diff();
  CHECK(same.code == 0);
  CHECK(contains(same.out, "no difference in "));
  CHECK(same.err.empty());
  CHECK(logs.diff({"--align", "path"}).code == 0);
  CHECK(logs.diff({"--strict"}).code == 0);
  CHECK(logs.diff({"--all"}).out == same.out);
  const Json j = Json::parse(logs.diff({"--json"}).out);
  CHECK(j["differ"] == false);
  CHECK(j["first"].is_null());
}

TEST_CASE("kadr diff names the program line at which two runs part, and the inputs that do") {
  // F600 is 10 mm/s; held to 9 mm/s the feed parts while the first line of 20 mm is under way
  const Logs logs({"--set", "feed.max_mm_s=9"});
  const Finished diff = logs.diff({"--ignore", "KADR_BLOCK"});
  CHECK(diff.code == 1);
  CHECK(diff.out.rfind("inputs differ\n", 0) == 0);
  CHECK(contains(diff.out, "[feed] 'max_mm_s = 110' | 'max_mm_s = 9'"));
  CHECK(contains(diff.out, "logs differ: first at control tick "));
  CHECK(contains(diff.out, ", KADR_TICKS, block 1, square.ngc:4\n  4 | G1 X30 F600\n"));
  CHECK(contains(diff.out, "around it: feed_u_s, mm/s\n"));

  const Json j = Json::parse(logs.diff({"--ignore", "KADR_BLOCK", "--json", "--context", "1"}).out);
  CHECK(j["differ"] == true);
  CHECK(j["first"]["channel"] == "KADR_TICKS");
  CHECK(j["first"]["place_a"]["line"] == 4);
  CHECK(j["first"]["fields"][0]["field"] == "feed_u_s");
  CHECK(j["first"]["around"]["rows"].size() == 3);
  CHECK(j["inputs"][2]["input"] == "settings");
  CHECK(j["inputs"][2]["same"] == false);
}

TEST_CASE("--all prints every difference, and stays one JSON document") {
  const Logs logs({"--set", "axis.X.plant.link_damping_Ns_per_m=130"});
  const Finished first = logs.diff(), all = logs.diff({"--all"});
  CHECK(all.code == first.code);
  CHECK(lines(all.out) >= lines(first.out));
  const Json j = Json::parse(logs.diff({"--all", "--json"}).out);
  std::size_t differing = 0;
  for (const Json& t : j["totals"])
    differing = std::max<std::size_t>(differing, t["differing"].get<std::size_t>());
  CHECK(j["differences"].size() >= differing);
  CHECK(Json::parse(logs.diff({"--all", "--json", "--align", "path"}).out)["differences"].is_array());
}

TEST_CASE("by path, other feeds give the same steps: --ignore feed answers yes, --strict no") {
  const Logs logs({"--set", "feed.max_mm_s=7"});
  const Finished path = logs.diff({"--align", "path"});
  CHECK(path.code == 1);
  CHECK(contains(path.out, "steps: the same sequence in "));
  CHECK(contains(path.out, "feed: differs on "));
  CHECK(contains(path.out, "square.ngc:4: G1 X30 F600"));
  CHECK(logs.diff({"--align", "path", "--ignore", "feed"}).code == 0);
  CHECK(logs.diff({"--align", "path", "--ignore", "feed", "--strict"}).code == 1);
  CHECK(logs.diff({"--align", "path", "--tolerance", "feed=200mm/s"}).code == 0);
  const Json j = Json::parse(logs.diff({"--align", "path", "--json"}).out);
  CHECK(j["steps"]["differing"] == 0);
  CHECK(j["feed"]["first"]["place"]["line"] == 4);
}

TEST_CASE("-q prints nothing and answers") {
  const Logs logs({"--set", "feed.max_mm_s=9"});
  const Finished quiet = logs.diff({"-q"});
  CHECK(quiet.code == 1);
  CHECK(quiet.out.empty());
  CHECK(quiet.err.empty());
}

TEST_CASE("a log that was cut off is compared as far as it goes, and that is said") {
  const Logs logs;
  const std::string bytes = logs.scratch.read("a.lcmlog");
  logs.scratch.write("cut.lcmlog", bytes.substr(0, bytes.size() / 2));
  const Finished cut = logs.diff({}, "cut.lcmlog");
  CHECK(cut.code == 1);
  CHECK(contains(cut.out, "cut.lcmlog: cut off: "));
  CHECK(contains(cut.out, "control ticks more than cut.lcmlog; the "));
}

TEST_CASE("kadr diff refuses what it can't read, exit 2, with path and reason") {
  const Logs logs;
  logs.scratch.write("text.lcmlog", "no log\n");
  logs.scratch.write("empty.lcmlog", "");
  for (const std::string bad : {"missing.lcmlog", "text.lcmlog", "empty.lcmlog", "."}) {
    for (const char* align : {"tick", "path"}) {
      CHECK(logs.diff({"--align", align}, "a.lcmlog", bad).code == 2);
      const Finished refused = logs.diff({"--align", align, "--json"}, bad, "b.lcmlog");
      CHECK(refused.code == 2);
      CHECK(refused.out.empty());
      CHECK(contains(refused.err, "kadr: " + bad + ": "));
    }
  }
}

TEST_CASE("mistakes in the options of kadr diff are told, exit 2") {
  const Logs logs;
  const auto complaint = [&](std::vector<std::string> options) {
    const Finished wrong = logs.diff(std::move(options));
    CHECK(wrong.code == 2);
    CHECK(wrong.out.empty());
    return wrong.err;
  };
  CHECK(contains(complaint({"--tolerance", "load=0.5"}),
                 "load takes a number >= 0 with a unit (nm, um, mm, mdeg, deg)"));
  CHECK(contains(complaint({"--tolerance", "weight=1um"}), "KEY one of load, base, link"));
  CHECK(contains(complaint({"--tolerance", "feed=1mm/s"}), "--tolerance feed needs --align path"));
  CHECK(contains(complaint({"--ignore", "KADR_TICKS/speed"}),
                 "there is no field 'speed' in KADR_TICKS; it has feed_u_s,"));
  CHECK(contains(complaint({"--ignore", "plant"}), "--ignore takes CHANNEL or CHANNEL/field"));
  CHECK(contains(complaint({"--context", "-1"}), "--context"));
  CHECK(contains(complaint({"--context", "many"}),
                 "--context takes a whole number from 0 to 1000; got 'many'"));
  CHECK(contains(complaint({"--align", "time"}), "--align takes one of path, tick; got 'time'"));
  CHECK(call({"diff", "a.lcmlog"}, logs.scratch.path()).code == 2);
  CHECK(call({"diff", "a.lcmlog", "b.lcmlog", "c.lcmlog"}, logs.scratch.path()).code == 2);
}
