#include <doctest/doctest.h>

#include <algorithm>

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
using kadr::test::check_golden;
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

/// "codes in order of line" of a list of diagnostics
std::vector<std::string> codes(const Json& diagnostics) {
  std::vector<std::string> list;
  for (const Json& d : diagnostics) list.push_back(d["code"]);
  return list;
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

TEST_CASE("six mistakes give six diagnostics with carets, exit 1, and nothing moves") {
  const Scratch scratch;
  scratch.write("six.ngc", test::kSixMistakes);
  const Finished run = call({"run", "six.ngc"}, scratch.path());
  CHECK(run.code == 1);
  CHECK(run.out.empty());
  CHECK(!scratch.has("six.lcmlog"));
  CHECK(!scratch.has("six.lcmlog.part"));
  CHECK(contains(run.err, "6 errors in six.ngc\n"));
  check_golden("six_mistakes.txt", run.err);

  const Finished json = call({"run", "six.ngc", "--json"}, scratch.path());
  CHECK(json.code == 1);
  const Json j = Json::parse(json.out);
  CHECK(j["diagnostics"].size() == 6);
  CHECK(j["run"].is_null());
  // one mistake in each of the lines 3 to 8
  for (std::size_t i = 0; i < j["diagnostics"].size(); ++i) CHECK(j["diagnostics"][i]["line"] == i + 3);

  const Finished check = call({"check", "six.ngc", "--json"}, scratch.path());
  CHECK(check.code == 1);
  CHECK(codes(Json::parse(check.out)[0]["diagnostics"]) == codes(j["diagnostics"]));
}

TEST_CASE("the gcc form has one line a diagnostic, --max-errors shows fewer") {
  const Scratch scratch;
  scratch.write("six.ngc", test::kSixMistakes);
  const Finished all = call({"check", "six.ngc", "--format", "gcc"}, scratch.path());
  CHECK(all.code == 1);
  CHECK(std::count(all.out.begin(), all.out.end(), '\n') == 6);
  CHECK(all.out.substr(0, 10) == "six.ngc:3:");
  CHECK(all.err.empty());
  const Finished two = call({"check", "six.ngc", "--format", "gcc", "--max-errors", "2"}, scratch.path());
  CHECK(std::count(two.out.begin(), two.out.end(), '\n') == 2);
  CHECK(contains(two.err, "4 more diagnostics not shown"));
  const Finished lines = call({"check", "six.ngc", "--format", "json"}, scratch.path());
  CHECK(std::count(lines.out.begin(), lines.out.end(), '\n') == 6);
  CHECK(Json::parse(lines.out.substr(0, lines.out.find('\n')))["line"] == 3);
}

TEST_CASE("how many diagnostics are not shown is said in every form, and no more than that") {
  const Scratch scratch;
  const std::string& folder = scratch.path();
  std::string axes, mistakes, warnings = "F1\n";
  for (int i = 0; i < 3000; ++i) axes += "[[axis]]\nname = \"Q\"\n";
  for (int i = 0; i < 3000; ++i) mistakes += "G1 X\n";
  for (int i = 0; i < 3000; ++i) warnings += "G4 P200\n";
  scratch.write("m.toml", axes);
  scratch.write("e.ngc", mistakes);
  scratch.write("w.ngc", warnings + "M2\n");
  const auto last_lines = [](const std::string& text, std::size_t count) {
    std::size_t at = text.size() - 1;
    for (; count > 0 && at != std::string::npos; --count) at = text.rfind('\n', at - 1);
    return text.substr(at + 1);
  };
  // readers that stop
  CHECK(last_lines(call({"check", "e.ngc"}, folder).out, 2) ==
        "at least 980 more not shown (--max-errors 0 shows 980 of them)\nat least 1000 errors in e.ngc\n");
  for (const char* most : {"0", "5"}) {
    CAPTURE(most);
    CHECK(contains(call({"check", "e.ngc", "--max-errors", most}, folder).out,
                   "reading stopped here after 1000 errors"));
    CHECK(contains(call({"check", "e.ngc", "--max-errors", most, "--format", "json"}, folder).out,
                   "reading stopped here after 1000 errors"));
    CHECK(contains(call({"check", "e.ngc", "--max-errors", most, "--format", "sarif"}, folder).out,
                   "reading stopped here after 1000 errors"));
    CHECK(contains(call({"machine", "check", "m.toml", "--max-errors", most}, folder).out,
                   "reading stopped here after 20"));
  }
  CHECK(contains(call({"check", "e.ngc", "--json"}, folder).out, "reading stopped here after 1000 errors"));
  CHECK(contains(call({"check", "e.ngc", "--max-errors", "5", "--format", "sarif"}, folder).out,
                 "at least 995 more diagnostics not shown"));
  // one that reads on: all are counted
  const Finished many = call({"check", "w.ngc"}, folder);
  CHECK(contains(many.out, "2980 more not shown (--max-errors 0 shows 980 of them)\n"));
  CHECK(contains(many.out, "3000 warnings in w.ngc\n"));
  for (const char* form : {"human", "json", "sarif", "gcc"})
    CHECK(contains(call({"check", "w.ngc", "--max-errors", "0", "--format", form}, folder).out,
                   "2000 more warnings are not shown"));
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
    CHECK(contains(dialect.err, "linuxcnc, grbl, marlin, fanuc"));
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

TEST_CASE("a machine file with mistakes: exit 2 of kadr run, exit 1 of kadr machine check, carets in both") {
  const Scratch scratch;
  call({"machine", "new", "shop"}, scratch.path());
  scratch.write("bad.toml", scratch.read("shop.toml") + "\n[nonsense]\nfoo = 1\n");
  scratch.write("square.ngc", test::kSquare);
  const Finished run = call({"run", "square.ngc", "-m", "bad.toml"}, scratch.path());
  CHECK(run.code == 2);
  CHECK(run.out.empty());
  CHECK(contains(run.err, "error[K3"));
  CHECK(contains(run.err, "--> bad.toml:"));
  CHECK(contains(run.err, "^"));
  CHECK(!scratch.has("square.lcmlog"));
  const Finished check = call({"machine", "check", "bad.toml"}, scratch.path());
  CHECK(check.code == 1);
  CHECK(contains(check.out, "error[K3"));
  const Finished unknown = call({"run", "square.ngc", "-m", "mill4"}, scratch.path());
  CHECK(unknown.code == 2);
  CHECK(unknown.err ==
        "kadr: machine mill4: No such file or directory; machines that ship with kadr: mill3, winder4, rig1, "
        "robot7\n");
  const Finished set = call({"run", "square.ngc", "--set", "path.no_such_key=1"}, scratch.path());
  CHECK(set.code == 2);
  CHECK(contains(set.err, "no_such_key"));
  const Json json = Json::parse(call({"run", "square.ngc", "-m", "bad.toml", "--json"}, scratch.path()).out);
  CHECK(json["exit_code"] == 2);
  CHECK(json["diagnostics"].size() >= 1);
}

TEST_CASE("kadr explain tells about a code, lists all, refuses unknown ones") {
  const Finished one = call({"explain", "K4101"});
  CHECK(one.code == 0);
  CHECK(one.out.substr(0, 7) == "K4101: ");
  CHECK(call({"explain", "4101"}).out == one.out);
  const Finished list = call({"explain", "--list"});
  CHECK(contains(list.out, "\nK5105  motor lost steps\n"));
  const Json all = Json::parse(call({"explain", "--list", "--json"}).out);
  CHECK(all.size() >= 20);
  for (const Json& entry : all) CHECK(entry["explanation"].get<std::string>().size() > 20);
  const Finished unknown = call({"explain", "K0001"});
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "there is no diagnostic 'K0001'"));
  CHECK(call({"explain"}).code == 2);
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

TEST_CASE("an M66 that waits in vain and an output that no motion follows are warnings with a place") {
  const Scratch scratch;
  scratch.write("outputs.ngc", "G21 G90\nG1 X10 F600\nM66 P3 L3 Q5\nM63 P1\nM2\n");
  const Finished check = call({"check", "outputs.ngc", "--format", "human"}, scratch.path());
  CHECK(check.code == 0);
  check_golden("check_outputs.txt", check.out);
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
