#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Scratch;
using Json = nlohmann::json;

namespace {

const std::string kHead = "format = 1\n[path]\nprogram = \"part.ngc\"\nmachine = \"mill3\"\n";

/// Solves a problem with that program next to it.
Finished tube(const Scratch& scratch, const std::string& problem, const std::string& program,
              std::vector<std::string> options) {
  scratch.write("part.ngc", program);
  scratch.write("p.toml", problem);
  std::vector<std::string> arguments = {"tube", "p.toml"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return call(arguments, scratch.path());
}

Json solved(const Scratch& scratch, const std::string& problem, const std::string& program,
            const std::string& method = "greedy") {
  const Finished run = tube(scratch, problem, program, {"--json", "--method", method});
  INFO(run.out, run.err);
  REQUIRE(run.code == 0);
  return Json::parse(run.out);
}

double time_s(const Json& j) { return j["methods"][0]["time_s"].get<double>(); }

/// A circle of radius 20 by n lines.
std::string circle(int n) {
  std::string text = "G21 G90\nG0 X20 Y0\nG4 P0.1\nF6000\n";
  char line[64];
  for (int i = 1; i <= n; ++i) {
    std::snprintf(line, sizeof line, "G1 X%.6f Y%.6f\n", 20 * std::cos(2 * M_PI * i / n),
                  20 * std::sin(2 * M_PI * i / n));
    text += line;
  }
  return text + "M2\n";
}

const std::string kBent = "G21 G90\nG1 X40 F6000\nG3 X60 Y20 I0 J20\nG1 X70 Y60 F3600\nM2\n";

}  // namespace

TEST_CASE("one line of a program has the time of the textbook") {
  // 40 mm at F1200 = 20 mm/s, X of mill3 at 2500 mm/s2, whose path allows 2000: 40/20 + 20/2000 = 2.01 s, and
  // a hair more since a ramp of 0.1 mm is 8 intervals
  const Scratch scratch;
  const Json j = solved(scratch, kHead + "[penalty]\nweight_s5_per_mm2 = 0\n", "G21\nG1 X40 F1200\nM2\n");
  CHECK(j["length_mm"] == 40.0);
  CHECK(j["axes"].size() == 3);
  CHECK(j["program"]["machine"] == "mill3");
  CHECK(j["program"]["fit"].is_null());
  CHECK(time_s(j) == doctest::Approx(2.01).epsilon(1e-4));
}

TEST_CASE("a program has the time that it has in a run by the same method") {
  const Scratch scratch;
  for (const char* method : {"certified", "tube"}) {
    const std::string tube_keys =
        std::string(method) == "tube" ? "[tube]\ngrid = \"nominal-kept\"\nlevels = 100\n" : "";
    const Json j = solved(scratch, kHead + tube_keys, kBent, method);
    const Finished run = call({"check", "part.ngc", "-m", "mill3", "--json", "--set",
                               std::string("planner.method=") + method, "--set", "planner.whole_ticks=false"},
                              scratch.path());
    REQUIRE(run.code == 0);
    CHECK(time_s(j) ==
          doctest::Approx(Json::parse(run.out)[0]["check"]["time_s"].get<double>()).epsilon(1e-9));
  }
}

TEST_CASE("limits of a problem go before the machine's: axes, the path, the distance of nodes") {
  const Scratch scratch;
  const std::string line = "G21\nG1 X40 F1200\nM2\n";
  // 10 mm/s at 100 mm/s2: 40/10 + 10/100 = 4.1 s
  const std::string slow = kHead + "max_mm_s = 10\n[[axis]]\nname = \"X\"\nmax_acceleration_mm_s2 = 100\n";
  CHECK(time_s(solved(scratch, slow, line)) == doctest::Approx(4.1).epsilon(1e-3));
  const std::string axis = kHead + "[[axis]]\nname = \"X\"\nmax_mm_s = 8\n";  // 5 s and 8/2000 s
  CHECK(time_s(solved(scratch, axis, line)) == doctest::Approx(5.004).epsilon(1e-4));
  CHECK(solved(scratch, kHead + "node_mm = 0.1\n", line)["nodes"].get<int>() >
        3 * solved(scratch, kHead, line)["nodes"].get<int>());
  // 40 mm of which the last 20 are at 5 mm/s, as a zone of a line, of places, and in the program itself
  const std::string two = "G21\nG1 X20 F1200\nG1 X40\nM2\n";
  const double by_line = time_s(solved(scratch, kHead + "[[zone]]\nat_line = 3\nmax_mm_s = 5\n", two));
  const double by_place = time_s(solved(scratch, kHead + "[[zone]]\nat_mm = 20\nmax_mm_s = 5\n", two));
  const double by_comment = time_s(solved(scratch, kHead, "G21\nG1 X20 F1200\n(TECH s_max=5)\nG1 X40\nM2\n"));
  CHECK(by_line == by_place);
  // set by the program, the slow position has closer nodes next to it
  CHECK(by_line == doctest::Approx(by_comment).epsilon(1e-2));
  CHECK(by_line > time_s(solved(scratch, kHead, two)));
}

TEST_CASE("from_line and to_line choose a stretch, which may begin and end with a speed") {
  const Scratch scratch;
  const std::string program = "G21 G90\nG0 X10\nG4 P0.5\nG1 X30 F1200\nG1 X50\nG4 P0.5\nG0 X0\nM2\n";
  const Finished whole = tube(scratch, kHead, program, {"--method", "greedy"});
  CHECK(whole.code == 2);
  CHECK(contains(whole.err, "the machine stops after this move"));
  CHECK(contains(whole.err, "here are 3: line 2; lines 4 to 5; line 7"));
  const Json j = solved(scratch, kHead + "from_line = 3\nto_line = 6\n", program);
  CHECK(j["program"]["first_line"] == 4);
  CHECK(j["program"]["last_line"] == 5);
  CHECK(j["length_mm"] == 40.0);
  CHECK(time_s(j) == doctest::Approx(2.01).epsilon(1e-4));
  // the second line alone, at 20 mm/s from its beginning: half a ramp less
  const std::string moving = kHead + "from_line = 5\nto_line = 5\nbegin_mm_s = 20\n";
  CHECK(time_s(solved(scratch, moving, program)) == doctest::Approx(1.005).epsilon(1e-4));
}

TEST_CASE("--csv of a program has the line of each node and what holds it in the words of kadr plan") {
  const Scratch scratch;
  REQUIRE(tube(scratch, kHead, kBent, {"--csv", "o.csv", "--page", "o.html", "--method", "certified"}).code ==
          0);
  std::istringstream in(scratch.read("o.csv"));
  std::string row, all;
  std::getline(in, row);
  CHECK(row == "s_mm,line,cap_mm_s,held_by,certified_mm_s,certified_t_s");
  int lines[4] = {}, programmed = 0;
  while (std::getline(in, row)) {
    const auto comma = row.find(',');
    const int line = row[comma + 1] - '0';
    REQUIRE(line >= 2);
    REQUIRE(line <= 4);
    ++lines[line - 2];
    const double cap = std::stod(row.substr(comma + 3));
    programmed += line == 4 && std::fabs(cap - 60) < 1e-9 && contains(row, ",program,");
    all += row + "\n";
  }
  CHECK(lines[0] > 10);
  CHECK(lines[1] > 45);  // 2 degrees an interval
  CHECK(lines[2] > 10);
  CHECK(programmed > 10);
  CHECK(contains(all, ",junction "));
  CHECK(contains(scratch.read("o.html"), "<svg "));
}

TEST_CASE("a circle of lines through a spline takes the time of the arc, and far less than its corners do") {
  const Scratch scratch;
  const std::string stretch = "from_line = 4\n";
  const Json exact = solved(scratch, kHead + stretch, circle(72));
  const Json fitted =
      solved(scratch, kHead + stretch + "fit = \"spline\"\ntolerance_mm = 0.02\n", circle(72));
  const Json arc = solved(scratch, kHead, "G21\nF6000\nG3 X0 Y0 I-20\nM2\n");
  // nodes at the points alone: both ramps of 2.5 mm are 2 intervals
  CHECK(time_s(fitted) == doctest::Approx(time_s(arc)).epsilon(4e-2));
  CHECK(time_s(exact) > 1.5 * time_s(arc));
  const Json fit = fitted["program"]["fit"];
  CHECK(fit["points"] == 73);
  // 20 (1 - cos 2.5 degrees)
  CHECK(fit["deviation_mm"].get<double>() == doctest::Approx(0.019036).epsilon(3e-3));
  CHECK(fitted["nodes"] == 73);
  const Json even =
      solved(scratch, kHead + stretch + "fit = \"spline\"\ntolerance_mm = 0.02\nnodes = 2000\n", circle(72));
  CHECK(even["nodes"] == 2000);
  CHECK(time_s(even) == doctest::Approx(time_s(arc)).epsilon(2e-3));
  const Finished text =
      tube(scratch, kHead + stretch + "fit = \"spline\"\ntolerance_mm = 0.1\nends = \"clamped\"\n",
           circle(72), {"--method", "greedy"});
  CHECK(contains(text.out, "spline   through 73 points, "));
  CHECK(contains(text.out, "allowed 0.1 mm"));
}

TEST_CASE("a spline that leaves the lines is refused with place, measured and allowed distance") {
  const Scratch scratch;
  const std::string keys = "fit = \"spline\"\ntolerance_mm = 0.01\n";
  const Finished coarse = tube(scratch, kHead + "from_line = 4\n" + keys, circle(72), {});
  CHECK(coarse.code == 2);
  CHECK(contains(coarse.err, "the spline is 0.019"));
  CHECK(contains(coarse.err, "allowed: 0.01 mm, path.tolerance_mm"));
  const Finished corner =
      tube(scratch, kHead + keys, "G21\nF600\nG1 X10\nG1 X20\nG1 X30\nG1 X30 Y10\nG1 Y20\nG1 Y30\nM2\n", {});
  CHECK(corner.code == 2);
  CHECK(contains(corner.err, "part.ngc:5"));
  const Finished arc = tube(scratch, kHead + keys, kBent, {});
  CHECK(arc.code == 2);
  CHECK(contains(arc.err, "is not a straight line"));
}

TEST_CASE("warnings of the program are told, its errors end the reading with their place") {
  const Scratch scratch;
  const Finished warned = tube(scratch, kHead, "G21\nG1 X40 F1200\nM62 P1\nM2\n", {"--method", "greedy"});
  CHECK(warned.code == 0);
  CHECK(contains(warned.err, "no motion follows: it never changes"));
  const Finished wrong = tube(scratch, kHead, "G21\nG1 X1,5 F100\nM2\n", {"--method", "greedy"});
  CHECK(wrong.code == 2);
  CHECK(contains(wrong.err, "part.ngc:2"));
  const Finished outside = tube(scratch, kHead, "G21\nG1 X4000 F100\nM2\n", {"--method", "greedy"});
  CHECK(outside.code == 2);
  CHECK(contains(outside.err, "soft limit"));
}
