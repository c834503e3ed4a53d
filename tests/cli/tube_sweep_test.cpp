#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::Finished;
using kadr::test::Scratch;
using Json = nlohmann::json;

namespace {

const std::string kTubeDocs = std::string(KADR_SOURCE_DIR) + "/docs/tube";

}  // namespace

TEST_CASE("a sweep of levels has a row each, and each is what the tube finds with that number alone") {
  // times and passes of laying.toml by levels: docs/time_law.md, measured with the levels in the file
  const Finished run =
      call({"tube", kTubeDocs + "/laying.toml", "--sweep-levels", "99..101", "--json"}, kTubeDocs);
  REQUIRE(run.code == 0);
  const Json document = Json::parse(run.out);
  REQUIRE(document["sweep"].size() == 3);
  const Json& row = document["sweep"][1];
  CHECK(row["levels"] == 100);
  CHECK(row["passes"] == 15);
  CHECK(row["capped"] == false);
  CHECK(row["time_s"].get<double>() == doctest::Approx(5.87788).epsilon(1e-6));
  for (const Json& r : document["sweep"])
    CHECK(r["cost_s"].get<double>() >= document["lower_bound_s"].get<double>());
}

TEST_CASE("a sweep as table, CSV and page: the cap on passes is told") {
  const Scratch scratch;
  const std::string problem = kTubeDocs + "/laying.toml";
  const Finished run = call(
      {"tube", problem, "--sweep-levels", "74..75", "--csv", "s.csv", "--page", "s.html"}, scratch.path());
  CHECK(run.code == 0);
  CHECK(run.out.find("2 of 2 ended by the cap on passes or half width, 0 found no law") != std::string::npos);
  const std::string csv = scratch.read("s.csv"), page = scratch.read("s.html");
  CHECK(csv.find("levels,time_s,cost_s,gap_pct,passes,capped\n74,5.86") == 0);
  CHECK(csv.find("\n75,") != std::string::npos);
  CHECK(page.find("<svg") != std::string::npos);
  CHECK(page.find("--sweep-levels 74..75") != std::string::npos);
}

TEST_CASE("a range of levels that is none is refused") {
  for (const char* range : {"50", "50..", "2..10", "60..50", "3..2000", "a..b", "50..60.5"}) {
    CAPTURE(std::string(range));
    const Finished run = call({"tube", kTubeDocs + "/laying.toml", "--sweep-levels", range}, kTubeDocs);
    CHECK(run.code == 2);
    CHECK(run.err.find("takes A..B, levels from 3 to 2000") != std::string::npos);
  }
}
