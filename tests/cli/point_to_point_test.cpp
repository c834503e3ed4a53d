#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/run_kadr.h"

using Json = nlohmann::json;

// `kadr law`. Reference figures are those of 40-digit calculations and of the tables in docs/motion_laws.md.
namespace {

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Scratch;

Finished law(std::vector<std::string> arguments, const std::string& folder = ".") {
  arguments.insert(arguments.begin(), "law");
  return call(std::move(arguments), folder);
}
Json document(std::vector<std::string> arguments) {
  arguments.emplace_back("--json");
  return Json::parse(law(std::move(arguments)).out);
}
Json row(const Json& j, const std::string& start) {
  for (const Json& r : j["laws"])
    if (r["law"].get<std::string>().starts_with(start)) return r;
  FAIL("no law ", start);
  return {};
}
bool near(const Json& value, double reference, double tolerance) {
  return std::fabs(value.get<double>() - reference) <= tolerance;
}

}  // namespace

TEST_CASE("kadr law answers Table 1 of paper 001: with the printed gravity xi = 0.325, m = 45, 11.189352 J") {
  const Finished run = law({"--printed-gravity"});
  CHECK(run.code == 0);
  CHECK(run.err.empty());
  CHECK(contains(run.out, "optimum  T law of xi = 0.3250000, m = 45: least energy of 24 T laws"));
  CHECK(contains(run.out, "11.189352 J"));
  const Finished damped = law({"--printed-gravity", "--zeta", "0.005"});
  CHECK(contains(damped.out, "xi = 0.3297907, n near 22"));
  CHECK(contains(damped.out, "0.051124 mm"));
}

TEST_CASE("every law of the table has the energy, time and sensitivity that the reference has") {
  const Json j = document({"--printed-gravity", "--xi", "0.36", "--xi", "0.48"});
  struct Reference {
    const char* law;
    double energy_J, accel_m_s2, worst_10_mm;
  };
  for (const Reference& r :
       {Reference{"T, chosen", 11.1894, .9972, .4490}, Reference{"double zero 22,45", 11.1615, .9820, .3485},
        Reference{"asymmetric T 30,36", 16.2516, .9626, .2410}, Reference{"S-curve, 1", 11.7874, 1, .0368},
        Reference{"S-curve, 2", 12.6171, 1, .0273}, Reference{"ZV on", 11.4441, 1, .0374},
        Reference{"ZVD on", 11.7704, 1, .0072}, Reference{"T, xi given", 11.9236, .9494, .3888}}) {
    CAPTURE(r.law);
    const Json found = row(j, r.law);
    CHECK(near(found["energy_J"], r.energy_J, 6e-5));
    CHECK(near(found["peak_accel_m_s2"], r.accel_m_s2, 6e-5));
    CHECK(near(found["worst_10_pct_m"], 1e-3 * r.worst_10_mm, 6e-8));
    CHECK(near(found["residual_m"], 0, 1e-12));
  }
  CHECK(row(j, "ZVD on")["worst_10_pct_m"].get<double>() <= .0075e-3);
}

TEST_CASE("with the gravity there is, energies of the paper's laws change their order") {
  const Json j = document({"--xi", "0.36", "--xi", "0.3333", "--xi", "0.48"});
  std::vector<double> energy_J;
  for (const Json& r : j["laws"])
    if (r["law"] == "T, xi given") energy_J.push_back(r["energy_J"]);
  REQUIRE(energy_J.size() == 3);
  CHECK(std::fabs(energy_J[0] - 17.7914) <= 6e-5);
  CHECK(std::fabs(energy_J[1] - 18.0587) <= 6e-5);
  CHECK(std::fabs(energy_J[2] - 17.1675) <= 6e-5);
}

TEST_CASE("the least time: 3.741720 s for a silent T law, 0.063 ms more than bang-bang") {
  const Finished run = law({"--time-optimal"});
  CHECK(contains(run.out, "optimum  T law of 3.741720 s, n = 31"));
  CHECK(contains(run.out, "0.063 ms more than bang-bang"));
  const Json j = document({"--time-optimal"});
  CHECK(near(row(j, "ZV on")["duration_s"], 3.77166, 6e-6));
  CHECK(near(row(j, "double zero 31,32")["duration_s"], 3.78, 1e-12));
  CHECK(near(row(j, "bang-bang")["worst_10_pct_m"], .4366e-3, 6e-8));
}

TEST_CASE("a force-driven axis is tuned to the frequency of base against load, and told so") {
  const Finished run = law({"--drive", "force"});
  CHECK(contains(run.out, "tuned   to 115.772 rad/s"));
  CHECK(contains(run.out, "a force moves base and load"));
  CHECK(contains(law({}).out, "tuned   to 104.720 rad/s"));
}

TEST_CASE("kadr law --paper prints 40 of the 42 cells of Table 2 to the digit, two within 1e-4") {
  const Finished run = law({"--paper"});
  CHECK(contains(run.out, "40 of 42 cells"));
  const Json cells = document({"--paper"})["table2"];
  REQUIRE(cells.size() == 42);
  int agree = 0;
  for (const Json& cell : cells) {
    agree += cell["agrees"].get<bool>();
    CHECK(std::fabs(cell["as_printed"].get<double>() - cell["printed"].get<double>()) <= 1e-4);
    if (!cell["agrees"].get<bool>()) CHECK(cell["quantity"] == "Pmax");
  }
  CHECK(agree == 40);
}

TEST_CASE("two runs of kadr law give the same bytes: CSV a row a law, a page without script") {
  const Scratch scratch;
  for (const std::string run : {"a", "b"}) {
    const Finished out = law({"--csv", run + ".csv", "--page", run + ".html", "-q"}, scratch.path());
    CHECK(out.code == 0);
    CHECK(out.out.empty());
  }
  const std::string csv = scratch.read("a.csv"), page = scratch.read("a.html");
  CHECK(csv == scratch.read("b.csv"));
  CHECK(page == scratch.read("b.html"));
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  CHECK(line.starts_with("law,xi,duration_s,peak_accel_m_s2,"));
  const auto columns = std::count(line.begin(), line.end(), ',');
  int rows = 0;
  // a name in quotes may contain a comma
  for (; std::getline(lines, line); ++rows) {
    const std::string values = line.substr(line.find('"', 1));
    CHECK(std::count(values.begin(), values.end(), ',') == columns);
  }
  CHECK(rows >= 8);
  CHECK_FALSE(contains(page, "<script"));
  for (const char* title : {">Acceleration<", ">Speed<", ">Power of the drive<", ">Load<", ">What is left<"})
    CHECK(contains(page, title));
}

TEST_CASE("what can't be asked is refused with what was given and what is allowed, exit 2") {
  struct Refusal {
    std::vector<std::string> arguments;
    const char* message;
  };
  const Refusal refusals[] = {
      {{"--time-s", "3.7"}, "time of 3.7 s is too short: the shortest within these limits is 3.741657 s"},
      {{"--zeta", "1"}, "damping ratio is 1: it has to be 0 or more and below 1"},
      {{"--zeta", "-0.1"}, "damping ratio is -0.1: it has to be 0 or more"},
      {{"--distance-m", "-3"}, "distance is -3 m: it has to be a number above 0"},
      {{"--accel-m-s2", "0"}, "acceleration limit is 0 m/s2: it has to be a number above 0"},
      {{"--omega-rad-s", "1e9"}, "periods of the vibration in the motion: there are"},
      {{"--mass-kg", "0"}, "mass of the load is 0 kg"},
      {{"--counterweight-ratio", "1.5"}, "counterweight ratio is 1.5: it may be 1 at most"},
      {{"--gravity-m-s2", "-9.81"}, "gravity is -9.81 m/s2: it may be 0 m/s2 at least"},
      {{"--uncertainty-pct", "200"}, "uncertainty of the frequency is 2: it may be 1 at most"},
      {{"--time-s", "-4"}, "time is -4 s: it has to be a number above 0"},
      {{"--xi", "0.3"}, "xi is 0.3: it may be 0.3232233 at least"},
      {{"--xi", "0.6"}, "xi is 0.6: it may be 0.5 at most"},
      {{"--distance-m", "far"}, "--distance-m takes a number; got 'far'"},
      {{"--drive", "rope"}, "--drive takes one of force, position; got 'rope'"},
  };
  for (const Refusal& r : refusals) {
    const Finished run = law(r.arguments);
    CAPTURE(run.err);
    CHECK(run.code == 2);
    CHECK(run.out.empty());
    CHECK(contains(run.err, r.message));
  }
  const Json refused = document({"--time-s", "3.7"});
  CHECK(refused["exit_code"] == 2);
  CHECK(near(refused["refused"]["allowed"], 2 * std::sqrt(3.5), 1e-12));
}
