#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Launch;
using kadr::test::run_kadr;
using kadr::test::Scratch;
using Json = nlohmann::json;

namespace {

const std::string kDocs = std::string(KADR_SOURCE_DIR) + "/docs/tube";

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
  return n;
}

Finished tube(std::vector<std::string> arguments, const std::string& folder = kDocs) {
  arguments.insert(arguments.begin(), "tube");
  return call(std::move(arguments), folder);
}

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) out.push_back(field);
  return out;
}

Json method(const Json& document, const std::string& name) {
  for (const Json& m : document["methods"])
    if (m["method"] == name) return m;
  FAIL("no method ", name);
  return {};
}

}  // namespace

TEST_CASE("kadr tube prints the loop as paper 000 does, a row a method and what the check found") {
  const Finished run = tube({"laying.toml"});
  CHECK(run.code == 0);
  CHECK(run.err.empty());
  CHECK(contains(run.out,
                 "Pass 1. Time per length 0.0030722 s/mm (total 8.7463 s)\n"
                 "Pass 2. Time per length 0.0026894 s/mm (total 7.6564 s)\n"
                 "Half width of the tube: 54.545 mm/s\nPass 3."));
  CHECK(contains(run.out,
                 "Pass 15. Time per length 0.0020647 s/mm (total 5.8779 s)\n"
                 "Half width of the tube: 3.4091 mm/s\n> No touches.\n>> No touches twice in a row.\n"
                 "--- >>> Calculation ended <<< ---\n"));
  CHECK(contains(run.out, ">> FINAL TIME OF THE PATH: 5.8779 s\n>> Half width of the tube: 1.7045 mm/s\n"));
  for (const char* name :
       {"\nclassical ", "\ntube ", "\ngreedy ", "\noptimum ", "\ncertified ", "\njerk-limited "})
    CHECK(count(run.out, name) == 1);
  CHECK(contains(run.out, "has J below 5.924880 s"));
  CHECK(contains(run.out, "\nlimits   every law found keeps every limit"));
  CHECK_FALSE(contains(run.out, "wall"));
}

TEST_CASE(
    "two runs of kadr tube give the same bytes: output, JSON, CSV and page; a terminal changes nothing") {
  const Scratch scratch;
  std::vector<std::string> files;
  std::string text[2], json[2];
  for (const std::string run : {"a", "b"}) {
    const std::size_t i = run == "b";
    const Finished out =
        tube({kDocs + "/layer.toml", "--csv", run + ".csv", "--page", run + ".html"}, scratch.path());
    CHECK(out.code == 0);
    text[i] = out.out;
    json[i] = tube({"layer.toml", "--json"}).out;
    CHECK_FALSE(scratch.has(run + ".csv.part"));
  }
  CHECK(text[0] == text[1]);
  CHECK(json[0] == json[1]);
  CHECK(scratch.read("a.csv") == scratch.read("b.csv"));
  CHECK(scratch.read("a.html") == scratch.read("b.html"));

  Launch launch;
  launch.arguments = {"tube", kDocs + "/layer.toml", "-q"};
  launch.folder = scratch.path();
  CHECK(run_kadr(launch).out.empty());
  launch.arguments = {"tube", kDocs + "/layer.toml", "--timing", "--method", "greedy"};
  CHECK(contains(run_kadr(launch).out, "wall ms"));
}

TEST_CASE("--method chooses; without a method that proves a bound there is no gap") {
  const Finished run = tube({"laying.toml", "--method", "greedy", "--method", "classical"});
  CHECK(run.code == 0);
  CHECK_FALSE(contains(run.out, "Pass 1."));
  CHECK_FALSE(contains(run.out, "bound "));
  const auto classical = run.out.find("\nclassical"), greedy = run.out.find("\ngreedy");
  CHECK(classical < greedy);
  CHECK(contains(run.out, "\ngreedy     5.86615  5.92530      -  "));
}

TEST_CASE("--json holds the table with full precision, the passes and the bound") {
  const Json j = Json::parse(tube({"laying.toml", "--json"}).out);
  CHECK(j["command"] == "tube");
  CHECK(j["exit_code"] == 0);
  CHECK(j["nodes"] == 893);
  CHECK(j["axes"][6] == Json({{"name", "X"}, {"unit", "mm"}}));
  CHECK(std::fabs(j["lower_bound_s"].get<double>() - 5.924880) <= 1e-5);
  CHECK(std::fabs(method(j, "tube")["time_s"].get<double>() - 5.8779) <= 1e-4);
  CHECK(std::fabs(method(j, "classical")["time_s"].get<double>() - 5.9828) <= 1e-4);
  CHECK(method(j, "certified")["gap_to_bound"].get<double>() <= 1e-5);
  CHECK(method(j, "jerk-limited")["peak_jerk_mm_s3"].get<double>() <= 20'000 * (1 + 1e-6));
  CHECK(j["tube"]["passes"].size() == 15);
  CHECK(j["tube"]["passes"][14]["touched"] == false);
  CHECK(j["tube"]["passes"][0]["fall_pct"].is_null());
  for (const Json& m : j["methods"]) CHECK(m["broken"].empty());

  const Scratch scratch;
  const Finished bad = call({"tube", "-", "--json"}, scratch.path(), "format = 2\n");
  CHECK(bad.code == 2);
  CHECK(Json::parse(bad.out)["diagnostics"][0]["code"] == "K3002");
}

TEST_CASE("--csv has a row a node: what caps it and what holds the cap, speed and time of every law") {
  const Scratch scratch;
  const Finished run = tube({kDocs + "/laying.toml", "--csv", "out.csv"}, scratch.path());
  REQUIRE(run.code == 0);
  std::istringstream in(scratch.read("out.csv"));
  std::string line;
  std::getline(in, line);
  CHECK(line.rfind("s_mm,cap_mm_s,held_by,classical_mm_s,classical_t_s,tube_mm_s,tube_t_s,greedy_mm_s,", 0) ==
        0);
  CHECK(contains(line, ",jerk_limited_mm_s,jerk_limited_t_s"));
  std::size_t rows = 0, zones = 0, axis2 = 0;
  std::vector<std::string> last;
  for (; std::getline(in, line); ++rows) {
    last = fields(line);
    REQUIRE(last.size() == 15);
    zones += last[2] == "zone";
    axis2 += last[2] == "A2";
    for (std::size_t k = 3; k < 15; k += 2) CHECK(std::stod(last[k]) <= std::stod(last[1]) * (1 + 1e-9));
  }
  CHECK(rows == 893);
  CHECK(zones == 4);
  CHECK(axis2 == 65);
  CHECK(last[3] == "0");
  CHECK(std::fabs(std::stod(last[6]) - 5.8779) <= 1e-4);
}

TEST_CASE("--page is one file without script, whose charts have lines, ticks and a table beside them") {
  const Scratch scratch;
  REQUIRE(tube({kDocs + "/laying.toml", "--page", "p.html"}, scratch.path()).code == 0);
  const std::string page = scratch.read("p.html");
  CHECK(page.size() < 600'000);
  CHECK_FALSE(contains(page, "<script"));
  CHECK_FALSE(contains(page, "http:"));
  CHECK_FALSE(contains(page, "https:"));
  CHECK(contains(page, "default-src 'none'"));
  CHECK(count(page, "<svg ") == 3);
  CHECK(count(page, "</svg>") == 3);
  CHECK(count(page, "aria-labelledby") == 3);
  // 15 passes and the caps, 3 passes and the caps, 6 methods; a swatch in the legend for 4 + 3 + 6 of them
  CHECK(count(page, "<path class=\"line ") == 16 + 4 + 6 + 4 + 3 + 6);
  CHECK(contains(page, ">speed along the path, mm/s<"));
  CHECK(contains(page, ">t, s<"));
  CHECK(count(page, "<details>") == 2);
  CHECK_FALSE(contains(page, "nan"));
  CHECK_FALSE(contains(page, "inf "));

  // without the tube: the methods over the path; a name is text, whatever it holds
  scratch.write(
      "n.toml",
      "format = 1\nname = \"<b> & \\\"x\\\"\"\n[path]\nlength_mm = 100\nnodes = 20\nmax_mm_s = 50\n"
      "[[axis]]\nname = \"X\"\nunit = \"mm\"\nmax_mm_s = 40\nmax_acceleration_mm_s2 = 100\nslope_mm = 90\n");
  REQUIRE(tube({"n.toml", "--page", "n.html", "--method", "greedy"}, scratch.path()).code == 0);
  const std::string plain = scratch.read("n.html");
  CHECK(contains(plain, "<h1>&lt;b&gt; &amp; &quot;x&quot;</h1>"));
  CHECK(count(plain, "<svg ") == 2);
}

TEST_CASE("a straight path at constant limits has the time of the textbook") {
  // X = s: 1000 mm at 100 mm/s2 and 200 mm/s; 2 s up over 200 mm, 600 mm at 200 mm/s in 3 s, 2 s down: 7 s
  const Scratch scratch;
  scratch.write("p.toml",
                "format = 1\n[path]\nlength_mm = 1000\nnodes = 1001\nmax_mm_s = 200\n[[axis]]\nname = \"X\"\n"
                "unit = \"mm\"\nmax_mm_s = 300\nmax_acceleration_mm_s2 = 100\nslope_mm = 1000\n"
                "[penalty]\nweight_s5_per_mm2 = 0\n");
  const Json j = Json::parse(
      tube({"p.toml", "--json", "--method", "greedy", "--method", "optimum"}, scratch.path()).out);
  CHECK(std::fabs(method(j, "greedy")["time_s"].get<double>() - 7.0) <= 1e-6);
  CHECK(std::fabs(method(j, "optimum")["time_s"].get<double>() - 7.0) <= 1e-6);
}

TEST_CASE("the same path by formula and by a table of it has the same law to 1e-4") {
  // X'' of a spline through a sine is off by (k ds)^2/12 = 3.3e-4 of it, k = 4 pi/400 and ds = 2
  const Scratch scratch;
  const std::string limits =
      "max_mm_s = 300\n[[axis]]\nname = \"X\"\nunit = \"mm\"\nmax_mm_s = 200\nmax_acceleration_mm_s2 = 900\n";
  scratch.write("f.toml", "format = 1\n[path]\nlength_mm = 400\nnodes = 201\n" + limits +
                              "slope_mm = 300\nwaves = [{ amplitude_mm = 20, turns = 2 }]\n");
  scratch.write("t.toml", "format = 1\n[path]\ntable = \"t.csv\"\n" + limits);
  std::string rows = "# a comment\r\ns,X\r\n\r\n";
  char line[64];
  for (int i = 0; i <= 200; ++i) {
    std::snprintf(line, sizeof line, " %d , %.9f\r\n", 2 * i,
                  1.5 * i + 20 * std::sin(2 * M_PI * 2 * i / 200.0));
    rows += line;
  }
  scratch.write("t.csv", rows);
  const auto time_s = [&](const char* file) {
    const Json j = Json::parse(tube({file, "--json", "--method", "greedy"}, scratch.path()).out);
    return method(j, "greedy")["time_s"].get<double>();
  };
  CHECK(time_s("t.toml") == doctest::Approx(time_s("f.toml")).epsilon(1e-4));
}
