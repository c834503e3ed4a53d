#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/run_kadr.h"

// The shipped paths on the machine robot7: figures as measured when the methods were built, and what holds
// each path where.

using kadr::test::call;
using Json = nlohmann::json;

namespace {

Json tube(const std::string& name, const std::vector<std::string>& methods) {
  std::vector<std::string> arguments = {"tube", "docs/tube/" + name, "--json", "--allow", "scenarios"};
  for (const std::string& method : methods) {
    arguments.push_back("--method");
    arguments.push_back(method);
  }
  const auto run = call(arguments, KADR_SOURCE_DIR);
  INFO(run.err);
  REQUIRE(run.code == 0);
  return Json::parse(run.out);
}

Json method(const Json& document, const std::string& name) {
  for (const Json& m : document["methods"])
    if (m["method"] == name) return m;
  FAIL("no method ", name);
  return {};
}

double time_s(const Json& document, const std::string& name) { return method(document, name)["time_s"]; }

/// Nodes that a limit holds; 0 if it holds none.
int held(const Json& document, const std::string& name, const std::string& limit) {
  const Json m = method(document, name);
  for (const Json& share : m["held_by"])
    if (share["limit"] == limit) return share["nodes"];
  return 0;
}

}  // namespace

TEST_CASE("robot7.toml with the machine's limits has the reference figures to 1e-4 s") {
  const Json j = tube("robot7.toml", {});
  CHECK(j["tube"]["passes"].size() == 15);
  const std::vector<double> passes = {8.7463, 7.6564, 6.9761, 6.5257, 6.2602, 6.1334, 6.0868, 6.0604,
                                      6.0632, 5.9582, 5.9578, 5.9140, 5.8901, 5.8896, 5.8779};
  for (std::size_t i = 0; i < passes.size(); ++i)
    CHECK(std::fabs(j["tube"]["passes"][i]["time_s"].get<double>() - passes[i]) <= 1e-4);
  CHECK(std::fabs(time_s(j, "tube") - 5.87788) <= 1e-4);
  CHECK(std::fabs(time_s(j, "classical") - 5.98279) <= 1e-4);
  CHECK(std::fabs(time_s(j, "greedy") - 5.866147) <= 1e-4);
  CHECK(std::fabs(time_s(j, "optimum") - 5.86666) <= 1e-4);
  CHECK(std::fabs(time_s(j, "jerk-limited") - 5.9276) <= 1e-4);
  CHECK(std::fabs(j["lower_bound_s"].get<double>() - 5.924880) <= 1e-4);
  // 892 nodes behind the first: the joints hold nearly all, rail and acceleration along the path none
  CHECK(held(j, "greedy", "A acceleration") == 223);
  CHECK(held(j, "greedy", "W acceleration") == 193);
  CHECK(held(j, "greedy", "A speed") == 21);
  CHECK(held(j, "greedy", "path speed") == 5);
  CHECK(held(j, "greedy", "zone") == 4);
  for (const char* none : {"X acceleration", "X speed", "path acceleration"})
    CHECK(held(j, "greedy", none) == 0);
}

TEST_CASE("robot7_rail.toml is held by the rail and by the acceleration along the path") {
  const Json j = tube("robot7_rail.toml", {"greedy", "certified"});
  CHECK(j["nodes"] == 941);
  const int rail = held(j, "greedy", "X acceleration"), fast = held(j, "greedy", "X speed");
  const int path = held(j, "greedy", "path acceleration"), cap = held(j, "greedy", "path speed");
  MESSAGE("of 940: rail acceleration ", rail, ", rail speed ", fast, ", path acceleration ", path,
          ", path speed ", cap);
  CHECK(rail > 564);  // 60 %
  CHECK(fast > 47);   // 5 %
  CHECK(path > 94);   // 10 %
  CHECK(cap > 47);
  CHECK(rail + fast + path + cap > 930);
  CHECK(held(j, "greedy", "zone") > 0);
  for (const char* joint : {"A", "B", "C", "U", "V", "W"})
    for (const char* limit : {" acceleration", " speed"})
      CHECK(held(j, "greedy", std::string(joint) + limit) == 0);
  CHECK(std::fabs(time_s(j, "greedy") - 4.86712) <= 1e-4);
  CHECK(method(j, "certified")["gap_to_bound"].get<double>() <= 2e-4);
}

TEST_CASE("the points of robot7.toml through a spline have the time of its formula to 0.3 %") {
  // the formula with limits at both nodes: 5.880580 s
  const Json j = tube("robot7_points.toml", {"greedy"});
  CHECK(j["program"]["fit"]["points"] == 893);
  CHECK(j["program"]["fit"]["deviation_mm"].get<double>() < 0.001);
  CHECK(std::fabs(time_s(j, "greedy") / 5.880580 - 1.0) <= 3e-3);
  CHECK(held(j, "greedy", "A acceleration") > 200);
}
