#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "emulator/log/log_reader.h"
#include "tests/cli/programs.h"
#include "tests/cli/run_kadr.h"

namespace test = kadr::test;
using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Scratch;
using Json = nlohmann::json;

namespace {

/// The summary without its last line, the only one with wall-clock figures.
std::string without_wall(const std::string& summary) {
  const auto at = summary.rfind("\nwall ");
  REQUIRE(at != std::string::npos);
  return summary.substr(0, at + 1);
}

}  // namespace

TEST_CASE("kadr run prints a summary and writes PROG.lcmlog in the current folder") {
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  const Finished run = call({"run", "square.ngc"}, scratch.path());
  CHECK(run.code == 0);
  CHECK(contains(run.out, "square.ngc on mill3 (shipped, the default; -m names another)"));
  CHECK(contains(run.out, "steps hash"));
  CHECK(contains(run.err, "log square.lcmlog, about "));
  CHECK(scratch.has("square.lcmlog"));
  CHECK(!scratch.has("square.lcmlog.part"));
  CHECK(!contains(run.out, "\x1b"));
  // the wall-clock line is the last
  CHECK(run.out.find("\nwall ") + 1 == run.out.rfind('\n', run.out.size() - 2) + 1);
}

TEST_CASE(
    "the same run twice gives the same log, byte for byte, and the same summary but for its last line") {
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  const Finished first = call({"run", "square.ngc"}, scratch.path());
  const std::string log = scratch.read("square.lcmlog");
  CHECK(log.size() > 10'000);
  const Finished second = call({"run", "square.ngc", "--threads", "2"}, scratch.path());
  CHECK(scratch.read("square.lcmlog") == log);
  CHECK(without_wall(first.out) == without_wall(second.out));
}

TEST_CASE("options of kadr run: other log, no log, no plant, --until") {
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  SUBCASE("-o") {
    CHECK(call({"run", "square.ngc", "-o", "other.lcmlog"}, scratch.path()).code == 0);
    CHECK(scratch.has("other.lcmlog"));
    CHECK(!scratch.has("square.lcmlog"));
  }
  SUBCASE("--no-log, options before the program") {
    const Finished run = call({"run", "--no-log", "square.ngc"}, scratch.path());
    CHECK(run.code == 0);
    CHECK(!scratch.has("square.lcmlog"));
    CHECK(!contains(run.out, "\nlog "));
    CHECK(run.err.empty());
  }
  SUBCASE("--no-plant gives the same pulses and no load") {
    const Json with = Json::parse(call({"run", "square.ngc", "--no-log", "--json"}, scratch.path()).out);
    const Json without =
        Json::parse(call({"run", "square.ngc", "--no-log", "--no-plant", "--json"}, scratch.path()).out);
    CHECK(with["run"]["steps_hash"] == without["run"]["steps_hash"]);
    CHECK(with["run"]["axes"][0]["load"].is_object());
    CHECK(without["run"]["axes"][0]["load"].is_null());
  }
  SUBCASE("--until stops at that machine time") {
    const Finished run = call({"run", "square.ngc", "--no-log", "--until", "0.5", "--json"}, scratch.path());
    CHECK(run.code == 0);
    const Json j = Json::parse(run.out);
    CHECK(j["run"]["time_s"] == doctest::Approx(0.5));
    CHECK(j["run"]["outcome"] == "stopped by --until");
  }
  SUBCASE("--set changes a value of the machine") {
    const Json slow = Json::parse(
        call({"run", "square.ngc", "--no-log", "--json", "--set", "feed.max_mm_s=5"}, scratch.path()).out);
    // 80 mm at 5 mm/s take 16 s, without acceleration and the move to the start
    CHECK(slow["run"]["time_s"] > 16.0);
    CHECK(slow["run"]["time_s"] < 20.0);
  }
}

TEST_CASE("programs that can't be read: exit 2, path and reason, no log") {
  const Scratch scratch;
  for (const std::string command : {"run", "check", "plan", "canon"}) {
    CAPTURE(command);
    const Finished missing = call({command, "missing.ngc"}, scratch.path());
    CHECK(missing.code == 2);
    CHECK(missing.out.empty());
    CHECK(missing.err == "kadr: missing.ngc: No such file or directory\n");
    const Finished folder = call({command, "."}, scratch.path());
    CHECK(folder.code == 2);
    CHECK(folder.err == "kadr: .: Is a directory\n");
  }
  CHECK(!scratch.has("missing.lcmlog"));
}

TEST_CASE("an empty program, a program of comments and a file of 0 bytes run and take no time") {
  const Scratch scratch;
  for (const std::string text : {"", "(nothing)\n", "\n\n", "%\n%\n"}) {
    CAPTURE(text);
    scratch.write("empty.ngc", text);
    const Finished run = call({"run", "empty.ngc", "--json"}, scratch.path());
    CHECK(run.code == 0);
    const Json j = Json::parse(run.out);
    CHECK(j["run"]["pulses"] == 0);
    CHECK(j["run"]["blocks"] == 0);
    CHECK(j["run"]["motion_s"] == 0);
    CHECK(call({"run", "empty.ngc"}, scratch.path()).code == 0);
    CHECK(call({"check", "empty.ngc"}, scratch.path()).code == 0);
    CHECK(call({"plan", "empty.ngc"}, scratch.path()).code == 0);
    CHECK(call({"canon", "empty.ngc"}, scratch.path()).code == 0);
    CHECK(call({"info", "empty.lcmlog"}, scratch.path()).code == 0);
  }
}

TEST_CASE("a program from standard input runs as one from a file") {
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  const Json file = Json::parse(call({"run", "square.ngc", "--no-log", "--json"}, scratch.path()).out);
  const Finished run = call({"run", "-", "--json"}, scratch.path(), test::kSquare);
  CHECK(run.code == 0);
  CHECK(scratch.has("stdin.lcmlog"));
  CHECK(Json::parse(run.out)["run"]["steps_hash"] == file["run"]["steps_hash"]);
  const Finished canon = call({"canon", "-"}, scratch.path(), test::kSquare);
  CHECK(canon.out == call({"canon", "square.ngc"}, scratch.path()).out);
}

TEST_CASE("the summary of a log has the warnings of the program and the answer of kadr run") {
  const Scratch scratch;
  scratch.write("far.ngc", "G21 G90\nG1 X100000 F6000\nM2\n");
  scratch.write("square.ngc", test::kSquare);
  const auto summary = [&](const std::string& log) {
    auto reader = kadr::log::LogReader::open(scratch.file(log));
    REQUIRE(reader.has_value());
    kadr::log::LogMessage message;
    std::optional<kadr::log::RunSummary> found;
    while (reader->next(message))
      if (const auto* last = std::get_if<kadr::log::LogSummary>(&message)) found = last->run;
    REQUIRE(found);
    return *found;
  };
  const Finished far = call({"run", "far.ngc", "--no-plant", "--until", "20", "--json"}, scratch.path());
  CHECK(far.code == 3);
  CHECK(summary("far.lcmlog").exit_code == 3);
  CHECK(summary("far.lcmlog").warnings == Json::parse(far.out)["diagnostics"].size());
  CHECK(summary("far.lcmlog").warnings > 0);
  CHECK(call({"run", "square.ngc", "--no-plant", "-q"}, scratch.path()).code == 0);
  CHECK(summary("square.lcmlog").exit_code == 0);
  CHECK(summary("square.lcmlog").warnings == 0);
}

TEST_CASE("kadr info tells what a log holds and that its hashes agree") {
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  const Json run = Json::parse(call({"run", "square.ngc", "--json"}, scratch.path()).out);
  const Finished info = call({"info", "square.lcmlog"}, scratch.path());
  CHECK(info.code == 0);
  CHECK(contains(info.out, "KADR_TICKS"));
  const Json j = Json::parse(call({"info", "square.lcmlog", "--json"}, scratch.path()).out)[0];
  CHECK(j["state"] == "complete");
  CHECK(j["steps_hash"] == run["run"]["steps_hash"]);
  CHECK(j["steps_hash_agrees"] == true);
  CHECK(j["content_hash_agrees"] == true);
  CHECK(j["axes"][0]["pulses"] == run["run"]["axes"][0]["pulses"]);
  CHECK(j["file_bytes"] == run["run"]["log"]["bytes"]);
  CHECK(j["control_ticks"] == run["run"]["control_ticks"]);
}

TEST_CASE("the inputs hash of a log follows the inputs and not the place they lie in") {
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  const auto hash = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"-o", "x.lcmlog", "-q"});
    REQUIRE(call(arguments, scratch.path()).code == 0);
    return Json::parse(call({"info", "x.lcmlog", "--json"}, scratch.path()).out)[0]["inputs_hash"]
        .get<std::string>();
  };
  const std::string plain = hash({"run", "square.ngc"});
  CHECK(hash({"run", "./square.ngc"}) == plain);
  CHECK(hash({"run", "square.ngc", "-m", "mill3"}) == plain);
  CHECK(hash({"run", "square.ngc", "--threads", "2"}) == plain);
  CHECK(hash({"run", "square.ngc", "--no-plant"}) != plain);
  CHECK(hash({"run", "square.ngc", "--set", "feed.max_mm_s=5"}) != plain);
  CHECK(hash({"run", "square.ngc", "--dialect", "linuxcnc"}) == plain);
  CHECK(hash({"run", "square.ngc", "--dialect", "grbl"}) != plain);
  scratch.write("tools.tbl", "T1 P1 Z10\n");
  scratch.write("remarks.tbl", ";the same tools\nt1 p1 z10.0 ;drill\n");
  scratch.write("longer.tbl", "T1 P1 Z11\n");
  const std::string with_tools = hash({"run", "square.ngc", "--tools", "tools.tbl"});
  CHECK(with_tools != plain);
  CHECK(hash({"run", "square.ngc", "--tools", "remarks.tbl"}) == with_tools);
  CHECK(hash({"run", "square.ngc", "--tools", "longer.tbl"}) != with_tools);
}

TEST_CASE("a bad or missing tool table and an unknown dialect keep every command from starting: exit 2") {
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  scratch.write("bad.tbl", "T1 P1 Z1,5\n");
  for (const std::string command : {"canon", "check", "plan", "run"}) {
    CAPTURE(command);
    const Finished bad = call({command, "square.ngc", "--tools", "bad.tbl"}, scratch.path());
    CHECK(bad.code == 2);
    CHECK(contains(bad.err, "--> bad.tbl:1:7"));
    CHECK(contains(bad.err, "1 error in bad.tbl"));
    CHECK(bad.out.empty());
    const Finished missing = call({command, "square.ngc", "--tools", "none.tbl"}, scratch.path());
    CHECK(missing.code == 2);
    CHECK(contains(missing.err, "none.tbl"));
    const Finished dialect = call({command, "square.ngc", "--dialect", "heidenhain"}, scratch.path());
    CHECK(dialect.code == 2);
    CHECK(contains(dialect.err, "linuxcnc, grbl, mach3, marlin, reprap, fanuc, haas, auto"));
  }
}

TEST_CASE("kadr info refuses what is no log: exit 2") {
  const Scratch scratch;
  scratch.write("text.lcmlog", "this is no log\n");
  scratch.write("empty.lcmlog", "");
  for (const std::string file : {"text.lcmlog", "empty.lcmlog", "missing.lcmlog"}) {
    CAPTURE(file);
    const Finished info = call({"info", file}, scratch.path());
    CHECK(info.code == 2);
    CHECK(contains(info.err, file));
    CHECK(info.out.empty());
  }
}

TEST_CASE("kadr machine: list, show, new, check") {
  const Scratch scratch;
  const Json list = Json::parse(call({"machine", "list", "--json"}, scratch.path()).out);
  REQUIRE(list.size() == 4);
  CHECK(list[0]["name"] == "mill3");
  CHECK(contains(call({"machine", "list"}, scratch.path()).out, "winder4"));

  const Finished made = call({"machine", "new", "shop", "--from", "winder4"}, scratch.path());
  CHECK(made.code == 0);
  REQUIRE(scratch.has("shop.toml"));
  const Finished check = call({"machine", "check", "shop.toml"}, scratch.path());
  CHECK(check.code == 0);
  CHECK(check.out == "shop.toml: machine shop, axes X Y A B: no errors\n");
  CHECK(call({"machine", "new", "shop"}, scratch.path()).code == 2);
  CHECK(call({"machine", "new", "shop", "--force"}, scratch.path()).code == 0);
  CHECK(call({"machine", "new", "../shop"}, scratch.path()).code == 2);

  const Finished show = call({"machine", "show", "shop.toml"}, scratch.path());
  CHECK(show.code == 0);
  // the output is a machine file again
  scratch.write("again.toml", show.out);
  CHECK(call({"machine", "check", "again.toml"}, scratch.path()).code == 0);
  scratch.write("square.ngc", test::kSquare);
  CHECK(contains(call({"run", "square.ngc", "-m", "shop.toml", "--no-log"}, scratch.path()).out,
                 "square.ngc on shop (shop.toml)"));
}

TEST_CASE("usage mistakes: exit 2, a complaint and nothing on standard output") {
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{}, "which command?"},
      {{"frobnicate"}, "there is no command 'frobnicate'"},
      {{"run"}, "PROG"},
      {{"run", "square.ngc", "--bogus"}, "--bogus"},
      {{"run", "square.ngc", "other.ngc"}, "PROG"},
      {{"run", "square.ngc", "--until", "soon"}, "--until takes seconds"},
      {{"run", "square.ngc", "--until", "-1"}, "--until"},
      {{"run", "square.ngc", "--until", "nan"}, "--until takes seconds"},
      {{"run", "square.ngc", "--until", "1,5"}, "--until takes seconds"},
      {{"run", "square.ngc", "--threads", "3"}, "takes 1 or 2"},
      {{"run", "square.ngc", "--progress", "loud"}, "--progress takes one of"},
      {{"run", "square.ngc", "-o", "-", "--json"}, "standard output"},
      {{"run", "square.ngc", "-o", "."}, "is a folder"},
      {{"run", "square.ngc", "-o", "square.ngc"}, "would overwrite"},
      {{"run", "square.ngc", "-o", "no/such/folder/x.lcmlog"}, "No such file or directory"},
      {{"run", "square.ngc", "--no-log", "--publish", "bogus://x"}, "bogus://x"},
      {{"canon", "square.ngc", "--lines", "5-2"}, "--lines takes"},
      {{"machine"}, "kadr machine: which command? show, list, keys, check, new\n"},
      {{"check", "square.ngc", "--format", "xml"}, "--format takes one of"},
  };
  for (const auto& [arguments, complaint] : cases) {
    std::string line;
    for (const std::string& a : arguments) line += a + ' ';
    CAPTURE(line);
    const Finished run = call(arguments, scratch.path());
    CHECK(run.code == 2);
    CHECK(run.out.empty());
    CAPTURE(run.err);
    CHECK(contains(run.err, complaint));
  }
  CHECK(scratch.read("square.ngc") == test::kSquare);
}

TEST_CASE("help texts go to standard output, name every command and the units of their numbers") {
  const Finished help = call({"--help"});
  CHECK(help.code == 0);
  CHECK(help.err.empty());
  for (const std::string command : {"run", "check", "plan", "canon", "info", "machine", "explain", "scenario",
                                    "wind", "version", "completion", "man"})
    CHECK(contains(help.out, "\n  " + command + " "));
  const Finished run = call({"run", "--help"});
  CHECK(run.code == 0);
  CHECK(contains(run.out, "Usage: kadr run "));
  CHECK(contains(run.out, "seconds of machine time"));
  CHECK(contains(run.out, "feed.max_mm_s=80"));
  const Finished plan = call({"plan", "-h"});
  CHECK(contains(plan.out, "mm/s"));
  CHECK(contains(plan.out, "deg/s"));
  CHECK(contains(call({"canon", "--help"}).out, "mm/min"));
  CHECK(contains(call({"info", "--help"}).out, "in s"));
  CHECK(call({"machine", "new", "--help"}).code == 0);
}

TEST_CASE("-q leaves out everything but data and errors") {
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  scratch.write("six.ngc", test::kSixMistakes);
  const Finished run = call({"run", "square.ngc", "-q"}, scratch.path());
  CHECK(run.code == 0);
  CHECK(run.out.empty());
  CHECK(run.err.empty());
  CHECK(contains(call({"run", "six.ngc", "-q"}, scratch.path()).err, "6 errors"));
  CHECK(!call({"plan", "square.ngc", "-q"}, scratch.path()).out.empty());
}

TEST_CASE("a scenario whose timeline has a highest override and no step is run under an operator") {
  // the first KADR_TICKS has the overrides that were requested, as with a step that asks for 100 %
  const auto tick_bytes = [](const std::string& steps) {
    const Scratch scratch;
    scratch.write("square.ngc", test::kSquare);
    scratch.write("scenario.toml",
                  "format = 1\nname = \"s\"\nprogram = \"square.ngc\"\nmachine = \"mill3\"\n" + steps);
    const Finished run =
        call({"run", "-s", "scenario.toml", "-q", "--no-plant", "-o", "s.lcmlog"}, scratch.path());
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    auto reader = kadr::log::LogReader::open(scratch.file("s.lcmlog"));
    REQUIRE(reader);
    for (kadr::log::LogMessage message; reader->next(message);)
      if (std::holds_alternative<kadr::log::TickBlock>(message)) return reader->event().data.size();
    return std::size_t{0};
  };
  const std::string most = "most_override_pct = 150\n";
  const std::size_t bytes = tick_bytes(most);
  CHECK(bytes == tick_bytes(most + "[[step]]\nat_tick = 0\noverride_pct = 100\n"));
  CHECK(bytes > tick_bytes(""));
}
