#include <doctest/doctest.h>

#include <cmath>
#include <map>
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

std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string word; in >> word;) out.push_back(word);
  return out;
}

Finished teach(const std::string& text, const std::string& folder = ".") {
  std::vector<std::string> arguments = words(text);
  arguments.insert(arguments.begin(), "teach");
  return call(std::move(arguments), folder);
}

std::vector<int> column(const Json& j, const char* key) {
  std::vector<int> out;
  for (const Json& row : j["rows"]) out.push_back(row[key]);
  return out;
}

/// A rise of STEP with the level of DIR there.
struct Rise {
  std::int64_t at;
  bool positive;
  bool operator==(const Rise&) const = default;
};

/// A value change dump as read back: every edge of every wire.
struct Dump {
  std::string timescale;
  std::map<std::string, std::vector<Rise>> rises;                ///< by axis
  std::map<std::string, std::vector<std::int64_t>> falls;        ///< of STEP
  std::map<std::string, std::vector<std::int64_t>> dir_changes;  ///< behind the initial level
};

Dump read_vcd(const std::string& text) {
  Dump out;
  std::map<char, std::string> name;
  std::map<char, bool> level;
  std::istringstream in(text);
  std::int64_t now = -1;
  for (std::string line; std::getline(in, line);) {
    const auto w = words(line);
    if (w.empty()) continue;
    if (w[0] == "$timescale") out.timescale = w[1] + w[2];
    if (w[0] == "$var") name[w[3][0]] = w[4];
    if (w[0][0] == '#') {
      REQUIRE(std::stoll(w[0].substr(1)) > now);
      now = std::stoll(w[0].substr(1));
    }
    if (w[0].size() != 2 || (w[0][0] != '0' && w[0][0] != '1')) continue;
    const char wire = w[0][1];
    const bool high = w[0][0] == '1', first = level.count(wire) == 0;
    const std::string axis = name.at(wire).substr(name.at(wire).find('_') + 1);
    REQUIRE((first || level[wire] != high));  // every change changes
    level[wire] = high;
    if (first) continue;
    if (name.at(wire).starts_with("DIR")) {
      out.dir_changes[axis].push_back(now);
    } else if (high) {
      char dir = 0;
      for (const auto& [id, n] : name)
        if (n == "DIR_" + axis) dir = id;
      out.rises[axis].push_back({now, level.at(dir)});
    } else {
      out.falls[axis].push_back(now);
    }
  }
  return out;
}

/// Pulses of a table in JSON, by axis: slot i at place(i, axis, number of the axis's pulse).
template <class Place>
std::map<std::string, std::vector<Rise>> pulses_of(const Json& j, Place&& place) {
  std::map<std::string, std::vector<Rise>> out;
  for (std::size_t i = 0; i < j["rows"].size(); ++i) {
    const Json& step = j["rows"][i]["step"];
    for (std::size_t k = 0; k < step.size(); ++k) {
      const std::string axis(1, "XYZABC"[k]);
      if (step[k] != 0) out[axis].push_back({std::llround(place(i, k, out[axis].size())), step[k] > 0});
    }
  }
  return out;
}

}  // namespace

TEST_CASE("kadr teach table prints the golden tables of line 7 x 4 and the quarter of R = 7") {
  const Finished line = teach("table line 7 4 --method half_step");
  CHECK(line.code == 0);
  CHECK(contains(line.out,
                 " i  x  y   F  G=2F'  move  deviation\n"
                 " 0  0  0   0      3    +X      0.000\n"
                 " 1  1  0  -4     -5    +Y     -0.496\n"
                 " 2  1  1   3      9    +X     +0.372\n"
                 " 3  2  1  -1      1    +X     -0.124\n"
                 " 4  3  1  -5     -7    +Y     -0.620\n"));
  CHECK(contains(line.out, "end (7, 4) reached"));
  const Json j = Json::parse(teach("table line 7 4 --method diagonal --json").out);
  CHECK(column(j, "tested") == std::vector<int>{1, -5, 3, -3, 5, -1, 7});
  const Finished arc = teach("table arc 7 0 0 7 ccw --method classic");
  CHECK(contains(arc.out,
                 " i  x  y    F  move  deviation\n"
                 " 0  7  0    0    -X      0.000\n"
                 " 1  6  0  -13    +Y     -1.000\n"
                 " 2  6  1  -12    +Y     -0.917\n"));
  const Json half = Json::parse(teach("table arc 7 0 0 7 --json").out);
  CHECK(column(half, "tested") == std::vector<int>{-7, -5, -1, 5, -7, 1, -9, 1, -7, 5, -1, 13, 9, 7});
  CHECK(half["largest_deviation_steps"].get<double>() == doctest::Approx(0.616).epsilon(1e-3));
}

TEST_CASE("kadr teach follows every kind of case; what comes out is within the bounds of its method") {
  for (const char* text : {"line -7 -4", "line 5 3 -2 7", "polyline 3 4 7 4 0 0", "arc 3 4 -4 3 cw",
                           "circle 12", "ellipse 20 9 cw", "parabola 5 -20 20", "parabola -5 20 -20",
                           "bezier 10 0 10 10", "bezier --axes 3 9 1 0 4 8 7 6 5 -9"}) {
    const Finished run = teach(std::string("table ") + text + " --json");
    CAPTURE(text);
    REQUIRE(run.code == 0);
    const Json j = Json::parse(run.out);
    CHECK(j["end_reached"] == true);
    CHECK(j["largest_deviation_steps"].get<double>() <= std::sqrt(j["axes"].get<double>()) / 2 + 1e-9);
  }
  const Finished curve =
      call({"teach", "table", "curve", "6400 y - x^3", "-120", "-270", "120", "270", "cw"});
  CHECK(curve.code == 0);
  CHECK(contains(curve.out, "end (120, 270) reached"));
  const Json ptp = Json::parse(teach("table polyline 3 4 7 4 0 0 --mode ptp --json").out);
  CHECK(ptp["method"] == "ptp");
  CHECK(ptp["slots"] == 4 + 4 + 7);
}

TEST_CASE("kadr teach table --csv has a row a slot and one for the end") {
  const Finished run = teach("table line 2 1 --csv");
  CHECK(run.out ==
        "i,x,y,value,tested,tested_y,t,move,forced,deviation_steps\n"
        "0,0,0,0,1,0,,+X,0,0\n1,1,0,-1,-1,0,,+Y,0,-0.4472135954999579\n2,1,1,1,3,0,,+X,0,0.4472135954999579\n"
        "3,2,1,,,,,end,,0\n");
}

TEST_CASE("kadr teach compare shows up to four methods side by side, those as printed failing") {
  const Finished run =
      teach("compare line 100 37 --method printed_difference --method magnitudes --method half_step");
  CHECK(run.code == 0);
  CHECK(contains(run.out, "printed_difference    137     137     0       0  47.5402"));
  CHECK(contains(run.out, "missed: at (137, 0)"));
  const Json j =
      Json::parse(teach("compare arc 50 0 0 50 --method printed_half_step --method half_step --json").out);
  CHECK(j["methods"][0]["end_reached"] == false);
  CHECK(j["methods"][0]["largest_deviation_steps"].get<double>() == doctest::Approx(21.42).epsilon(1e-3));
  CHECK(j["methods"][1]["larger_axis_deviation_steps"].get<double>() <= 0.5);
  CHECK(contains(teach("compare line 7 4").out,
                 "\nhalf_step     XYXXYXYXXYX\ndiagonal      XY X XY X XY X XY\n"));
}

TEST_CASE("every edge of a VCD is the pulse that the table says, one slot a pulse") {
  const Scratch scratch;
  for (const char* text :
       {"line 1000 618", "line 9 -4 6 --method diagonal", "circle 20 cw --method extra_points",
        "bezier 60 -10 -40 50 20 20", "line 7 4 --method dda"}) {
    const Finished run = teach(std::string("table ") + text + " --vcd a.vcd --json", scratch.path());
    CAPTURE(text);
    REQUIRE(run.code == 0);
    const Json j = Json::parse(run.out);
    const Dump dump = read_vcd(scratch.read("a.vcd"));
    CHECK(dump.timescale == "100ns");
    // 1000 slots per second: slot i at (i + 1) ms
    const auto expected = pulses_of(
        j, [](std::size_t i, std::size_t, std::size_t) { return static_cast<double>(i + 1) * 10'000.0; });
    CHECK(dump.rises == expected);
    for (const auto& [axis, rises] : dump.rises) {
      REQUIRE(dump.falls.at(axis).size() == rises.size());
      for (std::size_t i = 0; i < rises.size(); ++i) CHECK(dump.falls.at(axis)[i] == rises[i].at + 20);
      // DIR changes once between two pulses of different sign, and nowhere else
      std::vector<std::pair<std::int64_t, std::int64_t>> reversals;
      for (std::size_t i = 1; i < rises.size(); ++i)
        if (rises[i].positive != rises[i - 1].positive)
          reversals.emplace_back(rises[i - 1].at + 20, rises[i].at);
      const auto changes =
          dump.dir_changes.count(axis) ? dump.dir_changes.at(axis) : std::vector<std::int64_t>();
      REQUIRE(changes.size() == reversals.size());
      for (std::size_t i = 0; i < changes.size(); ++i) {
        CHECK(changes[i] > reversals[i].first);
        CHECK(changes[i] < reversals[i].second);
      }
    }
  }
}

TEST_CASE("pulses at their crossings are even on every axis of a line; one slot a pulse they are not") {
  const Scratch scratch;
  const Finished run = teach("table line 1000 618 --timing crossing --vcd b.vcd --json", scratch.path());
  REQUIRE(run.code == 0);
  const Json j = Json::parse(run.out);
  // (2i + 1)/2d of the way, 1000 steps/s along the path, ticks of 0.1 us
  const double length = std::hypot(1000.0, 618.0);
  const auto expected = pulses_of(j, [&](std::size_t, std::size_t k, std::size_t n) {
    return (static_cast<double>(n) + 0.5) / (k == 0 ? 1000 : 618) * length * 10'000;
  });
  CHECK(read_vcd(scratch.read("b.vcd")).rises == expected);
  for (const Json& axis : j["timing"]["axes"])
    CHECK(axis["most_spacing_ticks"].get<int>() - axis["least_spacing_ticks"].get<int>() <= 1);
  // section 3.5: X 1 to 2 slots, Y 2 to 3
  const Json slots = Json::parse(teach("table line 1000 618 --spacing --json").out)["timing"]["axes"];
  CHECK(slots[0]["least_spacing_ticks"] == 10'000);
  CHECK(slots[0]["most_spacing_ticks"] == 20'000);
  CHECK(slots[1]["least_spacing_ticks"] == 20'000);
  CHECK(slots[1]["most_spacing_ticks"] == 30'000);
  // a full circle at its crossings takes 2 pi R
  const Json circle = Json::parse(teach("table circle 50 --timing crossing --spacing --json").out);
  CHECK(circle["timing"]["duration_ticks"] == std::llround(2 * M_PI * 50 * 10'000));
  CHECK(circle["timing"]["axes"][0]["pulses"] == 200);
  for (const char* text :
       {"ellipse 30 12", "parabola 6 30 -30", "bezier 60 -10 -40 50 20 20", "bezier 20 5 30 30"}) {
    CAPTURE(text);
    CHECK(teach(std::string("table ") + text + " --timing crossing --spacing").code == 0);
  }
}

TEST_CASE("kadr teach bezier examines the example of paper 004") {
  const std::vector<std::string> example = {"teach", "bezier", "0,0,0 2,2,4 5,-0.5,2",
                                            "5,-0.5,2 8,-3,0 11,-1,-2 12,1,-1"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = example;
    all.insert(all.end(), more.begin(), more.end());
    return call(all);
  };
  const Finished run = with({});
  CHECK(run.code == 0);
  for (const char* text :
       {"x(t) = t^2 + 4 t mm", "y(t) = -4.5 t^2 + 4 t mm", "z(t) = -6 t^2 + 8 t mm",
        "x(t) = -2 t^3 + 9 t + 5 mm", "y(t) = -4.5 t^3 + 13.5 t^2 - 7.5 t - 0.5 mm",
        "z(t) = 3 t^3 - 6 t + 2 mm", "length 6.840304 mm", "length 9.170659 mm",
        "R_min 1.906851 mm at t = 0.54148", "R_min 2.512307 mm at t = 1.00000",
        "G1: ratio of |dB/dt| 1.5, curvature 0.120309 and 0.128070 1/mm, normals 106.65 deg apart",
        "jumps by 0.199269 1/mm, 38 % of the largest curvature", "third point (8.6818, -6.3182, -4.4545) mm",
        "second point (7, -2.1667, 0.6667) mm, third point (9.3333, -5.3333, -2.6667) mm"})
    CHECK_MESSAGE(contains(run.out, text), text);
  // v = sqrt(a R) = sqrt(8 1.906851) = 3.906 mm/s
  const Finished fast = with({"--feed", "5", "--accel", "8"});
  CHECK(fast.code == 1);
  CHECK(contains(fast.out, "at 8 mm/s2 across the path 3.906 mm/s are allowed: F asks 5, too fast"));
  CHECK(contains(fast.out, "acceleration steps by 5.0 mm/s2, 62 % of the limit"));
  CHECK(with({"--feed", "3", "--accel", "8"}).code == 0);
  const Json j = Json::parse(with({"--paper", "--json"}).out);
  const Json& newton8 = j["curves"][0]["t_of_length"][3];
  CHECK(newton8["method"] == "Newton degree 8");
  CHECK(newton8["feed_error"].get<double>() == doctest::Approx(0.2217).epsilon(0.02));
  CHECK(j["joints"][0]["normal_angle_deg"].get<double>() == doctest::Approx(106.65).epsilon(1e-4));
  // joined as C2 proposes, nothing jumps
  const Finished repaired = call({"teach", "bezier", "0,0,0 2,2,4 5,-0.5,2",
                                  "5,-0.5,2 7,-2.1666666666666667,0.6666666666666667 "
                                  "9.333333333333334,-5.333333333333333,-2.666666666666667 12,1,-1"});
  CHECK(contains(repaired.out, "  C2: ratio of |dB/dt| 1,"));
  CHECK_FALSE(contains(repaired.out, "jumps"));
  CHECK(contains(call({"teach", "bezier", "0,0 1,1", "2,2 3,3"}).out, "error: a gap of 1.4142 mm"));
  CHECK(call({"teach", "bezier", "0,0 1,1", "2,2 3,3"}).code == 1);
  CHECK(contains(call({"teach", "bezier", "0,0 1,0", "1,0 1,1"}).out, "a corner of 90.0000 deg"));
}

TEST_CASE("kadr teach tells what is wrong with a case, with measured and allowed values") {
  const struct {
    std::vector<std::string> arguments;
    const char* text;
  } rows[] = {
      {{"table", "spiral", "3"}, "a case begins with one of line, polyline, arc, circle"},
      {{"table", "line", "7"}, "line takes DX DY [DZ ...]; got 1 number"},
      {{"table", "line", "7.5", "4"}, "'7.5' is not a whole number of steps"},
      {{"table", "line", "0", "0"}, "both ends are the same node"},
      {{"table", "line", "1152921504606846977", "1"},
       "beyond what half_step counts in integers, 1152921504606846976"},
      {{"table", "line", "99999999999999999999", "1"}, "is not a whole number of steps"},
      {{"table", "line", "7", "4", "cw"}, "line takes no ccw or cw"},
      {{"table", "arc", "10", "0", "0", "11"}, "more than 0.707 steps off the circle"},
      {{"table", "arc", "50", "0", "-50", "0", "--method", "printed_half_step"}, "the end is in another one"},
      {{"table", "ellipse", "60", "3"}, "no end after 100000 slots, allowed 100000"},
      {{"table", "line", "7", "4", "--method", "chords"},
       "line is not followed by chords; methods for it: classic"},
      {{"table", "line", "7", "4", "--method", "half-step"}, "--method takes one of classic, half_step"},
      {{"table", "line", "7", "4", "--method", "classic", "--method", "dda"}, "is taken once at most"},
      {{"table", "line", "7", "4", "--bits", "61"}, "--bits takes a whole number from 1 to 60; got '61'"},
      {{"table", "line", "7", "4", "--feed", "0"}, "--feed takes a number from 0.001 to 10000000; got '0'"},
      {{"table", "line", "7", "4", "--method", "classic", "--timing", "crossing", "--spacing"},
       "goes with half_step and crossing, whose pulses are crossings; got classic"},
      {{"table", "line", "900", "4", "--feed", "9e6", "--spacing"}, "ticks of 10000000 Hz apart, at least 4"},
      {{"table", "curve", "x^7", "0", "0", "1", "1"}, "can't be read from character"},
      {{"table", "curve", "x y z", "0", "0", "1", "1"}, "can't be read from character 5"},
      {{"table", "bezier", "5", "5", "10", "10", "--method", "half_step"}, "use --method crossing"},
      {{"table", "bezier", "1", "2", "3"}, "bezier takes X1 Y1"},
      {{"bezier", "0,0 1"}, "point '1' of '0,0 1' has 1 coordinate, 2 are needed"},
      {{"bezier", "0,0 1,a"}, "'a' in '0,0 1,a' is not a number"},
      {{"bezier", "0,0"}, "has 1 point; a curve takes 2 to 4"},
      {{"bezier", "1,1 1,1"}, "has no length"},
  };
  for (const auto& row : rows) {
    std::vector<std::string> arguments = {"teach"};
    arguments.insert(arguments.end(), row.arguments.begin(), row.arguments.end());
    const Finished run = call(arguments);
    CAPTURE(row.text);
    CHECK(run.code == 2);
    CHECK_MESSAGE(contains(run.err, row.text), run.err);
  }
}
