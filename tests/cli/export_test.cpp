#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/programs.h"
#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::kSquare;
using kadr::test::Scratch;
using Json = nlohmann::json;

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) out.push_back(part);
  return out;
}

/// The square's log: 20 mm a side at 10 mm/s, with a dwell; one for all tests.
struct SquareLog {
  Scratch scratch;
  SquareLog() {
    scratch.write("square.ngc", kSquare);
    REQUIRE(call({"run", "square.ngc", "-o", "a.lcmlog", "-q"}, scratch.path()).code == 0);
  }
  Finished kadr(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin() + 1, "a.lcmlog");
    return call(arguments, scratch.path());
  }
  Json info() const { return Json::parse(kadr({"info", "--json"}).out)[0]; }
};

const SquareLog& square() {
  static const SquareLog log;
  return log;
}

}  // namespace

TEST_CASE(
    "kadr export --csv has a head with units and a row a control tick, each number as it stands in the log") {
  const Finished run =
      square().kadr({"export", "--csv", "--signals", "feed.commanded*,axis.X.steps,axis.X.step_rate*"});
  CHECK(run.code == 0);
  const std::vector<std::string> lines = split(run.out, '\n');
  CHECK(lines[0] == "t_s,feed.commanded_mm_s,axis.X.steps,axis.X.step_rate_hz");
  const Json info = square().info();
  CHECK(static_cast<std::int64_t>(lines.size()) - 1 == info["control_ticks"].get<std::int64_t>());
  // 10 mm/s at a jerk of 40 000 mm/s3 on each axis; the first control tick ends at 1 ms
  CHECK(split(lines[1], ',')[0] == "0.001");
  double pulses = 0, peak = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto cells = split(lines[i], ',');
    pulses += std::stod(cells[3]) * 0.001;
    peak = std::max(peak, std::stod(cells[1]));
  }
  CHECK(std::llround(pulses) == info["axes"][0]["pulses"].get<std::int64_t>());
  CHECK(peak > 9.9);
  // the last node is the machine's position: X10 at 0.0025 mm a step
  CHECK(split(lines.back(), ',')[2] == "4000");
}

TEST_CASE("a window and a rate take rows out, and the forms for a spreadsheet differ by their marks alone") {
  const auto rows = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"export", "--csv", "--signals", "feed.line"});
    const auto lines = split(square().kadr(more).out, '\n');
    return std::pair{lines[1], lines.size() - 1};
  };
  CHECK(rows({"--from", "0.1", "--to", "0.2"}) == std::pair{std::string("0.1,3"), std::size_t{101}});
  CHECK(rows({"--from", "0.1", "--to", "0.2", "--rate-hz", "100"}).second == 10);
  const Finished excel = square().kadr({"export", "--excel", "--signals", "feed.line", "--to", "0.002"});
  CHECK(excel.out == "\xEF\xBB\xBFt_s;feed.line\n0,001;3\n0,002;3\n");
  CHECK(square().kadr({"export", "--csv", "-o", "-"}).out == square().kadr({"export", "--csv"}).out);
}

TEST_CASE("kadr export --json is an object a line, and events are told whatever the rate") {
  const Finished run = square().kadr({"export", "--json", "--signals", "feed.*", "--rate-hz", "1"});
  CHECK(run.code == 0);
  std::vector<Json> all;
  for (const std::string& line : split(run.out, '\n')) all.push_back(Json::parse(line));
  CHECK(all.front()["channel"] == "KADR_RUN");
  CHECK(all.front()["units"]["feed.jerk_mm_s3"] == "mm/s3");
  CHECK(all.back()["channel"] == "KADR_SUMMARY");
  const auto count = [&](const char* channel) {
    return std::count_if(all.begin(), all.end(), [&](const Json& j) { return j["channel"] == channel; });
  };
  const Json info = square().info();
  CHECK(count("KADR_EVENT") == info["events"].get<int>());
  CHECK(count("KADR_BLOCK") == info["blocks"].get<int>());
  CHECK(all.back()["steps_hash"] == info["steps_hash"]);
}

TEST_CASE(
    "kadr export --vcd has every pulse as a rising edge, in ascending order of time, with its direction") {
  const Finished run = square().kadr({"export", "--vcd", "--signals", "feed.line"});
  CHECK(run.code == 0);
  // 10 MHz: a base tick is 100 ns, ten units of 10 ns
  CHECK(contains(run.out, "$timescale 10 ns $end"));
  CHECK(contains(run.out, "$var real 64 "));
  std::map<std::string, std::string> names;  // identifier to name
  std::map<std::string, std::int64_t> rises;
  std::map<std::string, int> level;
  std::int64_t time = -1, net_x = 0;
  bool ascending = true;
  for (const std::string& line : split(run.out, '\n')) {
    if (line.rfind("$var wire", 0) == 0) names[split(line, ' ')[3]] = split(line, ' ')[4];
    if (line[0] == '#') {
      ascending &= std::stoll(line.substr(1)) > time;
      time = std::stoll(line.substr(1));
    }
    if (line[0] != '0' && line[0] != '1') continue;
    const std::string& name = names[line.substr(1)];
    level[name] = line[0] - '0';
    if (line[0] != '1') continue;
    ++rises[name];
    if (name == "X_step") net_x += level["X_dir"] ? 1 : -1;
  }
  CHECK(ascending);
  const Json info = square().info();
  for (const Json& axis : info["axes"])
    CHECK(rises[axis["axis"].get<std::string>() + "_step"] == axis["pulses"].get<std::int64_t>());
  CHECK(net_x == 4000);  // from X0 to X10
  CHECK(rises["moving"] >= 2);
  CHECK(time >= info["valid_until_tick"].get<std::int64_t>() * 10);
}

TEST_CASE("kadr export --svg is one document that needs nothing from elsewhere") {
  const Finished run = square().kadr({"export", "--svg"});
  CHECK(run.code == 0);
  CHECK(run.out.rfind("<svg xmlns=", 0) == 0);
  CHECK(contains(run.out, ">feed.commanded_mm_s<"));
  CHECK(contains(run.out, ">um<"));
  CHECK_FALSE(contains(run.out, "nan"));
  CHECK_FALSE(contains(run.out, "<script"));
}

TEST_CASE("--list names the log's signals with their units; a run without plant has none of the load") {
  const std::string all = square().kadr({"export", "--list"}).out;
  CHECK(contains(all, "\naxis.X.following_um  "));
  CHECK(contains(all, "path.error_um"));
  const Scratch scratch;
  scratch.write("square.ngc", kSquare);
  REQUIRE(call({"run", "square.ngc", "--no-plant", "-o", "b.lcmlog", "-q"}, scratch.path()).code == 0);
  const std::string rigid = call({"export", "b.lcmlog", "--list"}, scratch.path()).out;
  CHECK(contains(rigid, "axis.X.speed_mm_s"));
  CHECK_FALSE(contains(rigid, "following"));
  CHECK(call({"plot", "b.lcmlog"}, scratch.path()).code == 0);
}

TEST_CASE("what can't be exported is refused with the way out") {
  const auto refused = [](std::vector<std::string> arguments, const std::string& reason) {
    arguments.insert(arguments.begin(), "export");
    const Finished run = square().kadr(arguments);
    CHECK(run.code == 2);
    CHECK(run.out.empty());
    CHECK_MESSAGE(contains(run.err, reason), run.err);
  };
  refused({"--csv", "--signals", "feed.commanded*,speed"},
          "the log has no signal 'speed' (`kadr export LOG --list`");
  refused({"--csv", "--from", "2", "--to", "1"}, "--from 2 s is after --to 1 s");
  refused({"--vcd", "--rate-hz", "10"}, "--vcd contains every pulse");
  refused({"--csv", "--json"}, "");
  refused({}, "");
  refused({"--csv", "--from", "1,5"}, "--from takes a number");
  CHECK(call({"export", "none.lcmlog", "--csv"}, square().scratch.path()).code == 2);
}

TEST_CASE("a log that breaks off is exported up to there, and the answer is no") {
  const std::string whole = square().scratch.read("a.lcmlog");
  square().scratch.write("cut.lcmlog", whole.substr(0, whole.size() / 2));
  const Finished run = call({"export", "cut.lcmlog", "--csv", "-o", "cut.csv"}, square().scratch.path());
  CHECK(run.code == 1);
  CHECK(contains(run.err, "; what was written ends at "));
  const std::string part = square().scratch.read("cut.csv");
  CHECK(part.size() > 1000);
  // what is there is what the whole log gives
  CHECK(square().kadr({"export", "--csv"}).out.rfind(part, 0) == 0);
}

TEST_CASE("kadr plot draws within the width asked for, in Braille or ASCII, the same on every call") {
  const Finished plot =
      square().kadr({"plot", "--signals", "feed.commanded*", "--ascii", "--width", "60", "--height", "5"});
  CHECK(plot.code == 0);
  const auto lines = split(plot.out, '\n');
  REQUIRE(lines.size() == 7);
  CHECK(lines[0].rfind("feed.commanded_mm_s   0 .. ", 0) == 0);
  for (const std::string& line : lines) CHECK(line.size() <= 62);  // the frame's sign is three bytes
  CHECK(contains(lines[1], "#"));
  CHECK(contains(lines[6], "0.000 s"));
  CHECK(contains(square().kadr({"plot", "--path"}).out,
                 "path in X and Y   X 0.000 .. 30.000 mm, Y 0.000 .. 30.000 mm\n"));
  CHECK(square().kadr({"plot"}).out == square().kadr({"plot"}).out);
}

TEST_CASE("kadr plot --path fills the rows asked for and no more, and calls a low end of dust 0") {
  const Scratch scratch;
  // 100 mm by 20 mm, from a home that is 0 up to rounding
  scratch.write("flat.ngc", "G21 G90\nG1 X100 Y10 F6000\nX0 Y20\nM2\n");
  REQUIRE(call({"run", "flat.ngc", "--set", "axis.Y.home_mm=7.07e-6", "-q"}, scratch.path()).code == 0);
  for (const std::string ascii : {"", "--ascii"}) {
    CAPTURE(ascii);
    // 69 columns for 100 mm: 20 mm are 6.8 cells of double height up from the first: 28 Braille dots, or 8 cells
    const std::size_t rows = ascii.empty() ? 7 : 8;
    std::vector<std::string> plot = {"plot", "flat.lcmlog", "--path"};
    if (!ascii.empty()) plot.push_back(ascii);
    const auto wide = split(call(plot, scratch.path()).out, '\n');
    REQUIRE(wide.size() == 2 + rows);
    CHECK(wide[1].size() > 12);
    CHECK(wide[rows].rfind("        0 ┤", 0) == 0);
    CHECK(wide[rows].size() > 12);
    plot.insert(plot.end(), {"--height", "4"});
    CHECK(split(call(plot, scratch.path()).out, '\n').size() == 2 + 4);
  }
}

TEST_CASE("kadr export --list ends with the meaning of every code that the log can hold") {
  const auto list = square().kadr({"export", "--list"}).out;
  CHECK(contains(list, "\nfeed.limited_by: 0 program, 1 rapid, 2 path feed, "));
  const auto at = list.find("\nfeed.limited_by: ");
  REQUIRE(at != std::string::npos);
  const std::string line = list.substr(at + 1, list.find('\n', at + 1) - at - 1);
  std::map<std::string, int> seen;
  for (const std::string& value :
       split(square().kadr({"export", "--csv", "--signals", "feed.limited_by"}).out, '\n'))
    if (const auto comma = value.find(','); value.rfind("t_s", 0) != 0) ++seen[value.substr(comma + 1)];
  CHECK(seen.size() >= 3);
  for (const auto& [code, count] : seen) CHECK(contains(line, " " + code + " "));
}
