#include "machine/file/data_sheet.h"
#include "machine/machine_file.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include "machine/base/parse_number.h"
#include "machine/machine_file.h"

using namespace kadr;
using namespace kadr::machine;

namespace {

MachineModel read_back(const DataSheet& sheet, const std::string& name) {
  SourceSet sources;
  const auto file = read_machine(SourceText("sheet.toml", render_data_sheet(sheet, name)), sources);
  REQUIRE(file.has_value());
  return file->model;
}

MachineModel model_of(const DataSheetWords& words) {
  const auto sheet = read_data_sheet(words);
  CAPTURE((sheet ? std::string() : sheet.error()));
  REQUIRE(sheet.has_value());
  return read_back(*sheet, "sheet");
}

std::string complaint(const DataSheetWords& words) {
  const auto sheet = read_data_sheet(words);
  return sheet ? std::string() : sheet.error();
}

DataSheetWords router() {
  DataSheetWords words;
  words.axes = "XYZ";
  words.travel = "800,800,80";
  words.max_speed = "5000mm/min";
  words.acceleration = "200";
  words.steps = "40";
  return words;
}

}  // namespace

TEST_CASE("a router's data sheet makes the machine that it describes") {
  const MachineModel m = model_of(router());
  REQUIRE(m.axis.size() == 3);
  for (const AxisModel& axis : m.axis) {
    CHECK(axis.max_feed_u_s == doctest::Approx(83.3333333).epsilon(1e-9));
    CHECK(axis.max_accel_u_s2 == 200);
    CHECK(axis.step_u == 0.025);
    CHECK(std::isinf(axis.max_jerk_u_s3));
    CHECK(axis.home_u == 0);
    CHECK_FALSE(axis.has_plant);
  }
  CHECK(m.axis[0].soft_min_u == 0);
  CHECK(m.axis[0].soft_max_u == 800);
  // Z has its zero in the middle
  CHECK(m.axis[2].soft_min_u == -40);
  CHECK(m.axis[2].soft_max_u == 40);
  CHECK(m.planner.tool_change_s == 0);
}

TEST_CASE("the default corner speed is grbl's with a junction deviation of 0.01 mm") {
  // grbl with 1000 mm/s2 on both axes passes a square corner at 5.84 mm/s; in kadr 1 ms of this is the jump
  CHECK(default_junction_u_s2(1000) == 5800);
  CHECK(default_junction_u_s2(200) == 2600);
  CHECK(model_of(router()).axis[0].junction_accel_u_s2 == 2600);
}

TEST_CASE("values are read in the units of data sheets") {
  DataSheetWords words = router();
  words.max_speed = "5 m/min, 200in/min,83.5 mm/s";
  words.acceleration = "0.2m/s^2,0.02g,200mm/s\xC2\xB2";
  words.jerk = "inf,10m/s3,5000";
  words.steps = "1016/inch,40,0.04/um";
  words.travel = "0.8m,-10..25.4in,-7.5..0.5cm";
  words.home = "0,-5,-1";
  words.tool_change = "0.5min";
  const MachineModel m = model_of(words);
  CHECK(m.axis[0].max_feed_u_s == doctest::Approx(83.3333333));
  CHECK(m.axis[1].max_feed_u_s == doctest::Approx(84.6666667));
  CHECK(m.axis[2].max_feed_u_s == 83.5);
  CHECK(m.axis[0].max_accel_u_s2 == doctest::Approx(200));
  CHECK(m.axis[1].max_accel_u_s2 == doctest::Approx(196.133));
  CHECK(m.axis[2].max_accel_u_s2 == 200);
  CHECK(m.axis[1].max_jerk_u_s3 == doctest::Approx(10'000));
  CHECK(m.axis[2].max_jerk_u_s3 == 5000);
  for (const AxisModel& axis : m.axis) CHECK(axis.step_u == doctest::Approx(0.025));
  CHECK(m.axis[0].soft_max_u == 800);
  CHECK(m.axis[1].soft_min_u == doctest::Approx(-254));
  CHECK(m.axis[1].soft_max_u == doctest::Approx(645.16));
  CHECK(m.axis[2].soft_min_u == -75);
  CHECK(m.axis[2].home_u == -1);
  CHECK(m.planner.tool_change_s == 30);
}

TEST_CASE("a converted length is the number a person computes, in the table and in the file") {
  DataSheetWords words = router();
  words.travel = "31.5in,31.5in,3.3in";
  const auto sheet = read_data_sheet(words);
  REQUIRE(sheet.has_value());
  CHECK(sheet->axis[0].max_u == 800.1);
  CHECK(sheet->axis[2].min_u == -41.91);
  CHECK(render_data_sheet(*sheet, "m").find("range_mm = [0, 800.1] ") != std::string::npos);
  // numbers with more digits keep them
  CHECK(sheet->axis[0].max_u_s.value == doctest::Approx(5000.0 / 60).epsilon(1e-15));
}

TEST_CASE("a decimal comma is named") {
  DataSheetWords words = router();
  words.max_speed = "83,3mm/s";
  CHECK(complaint(words) ==
        "--max-speed takes one value for all axes, or 3 in the order X,Y,Z; got 2: '83,3mm/s'; the decimal "
        "mark "
        "is a point");
  words = router();
  words.travel = "800,5,800,5,80,5";
  CHECK(complaint(words).find("; the decimal mark is a point") != std::string::npos);
  words.travel = "800,80";
  CHECK(complaint(words).find("point") == std::string::npos);
}

TEST_CASE("a rotary axis takes degrees, turns, or no end of travel") {
  DataSheetWords words = router();
  words.axes = "x,a,b";
  words.travel = "800,inf,-120..120";
  words.max_speed = "5000mm/min,20rpm,7200deg/min";
  words.acceleration = "200,500,5rad/s2";
  words.steps = "40,36000/rev,50";
  const MachineModel m = model_of(words);
  CHECK(m.axis[1].kind == AxisKind::rotary);
  CHECK(std::isinf(m.axis[1].soft_max_u));
  CHECK(m.axis[1].max_feed_u_s == 120);
  CHECK(m.axis[1].step_u == doctest::Approx(0.01));
  CHECK(m.axis[2].soft_min_u == -120);
  CHECK(m.axis[2].max_feed_u_s == 120);
  CHECK(m.axis[2].max_accel_u_s2 == doctest::Approx(286.4788976));
}

TEST_CASE("what a data sheet leaves out is a default, and the file says which") {
  DataSheetWords words;
  words.travel = "300";
  words.max_speed = "1m/min";
  const auto sheet = read_data_sheet(words);
  REQUIRE(sheet.has_value());
  const std::string text = render_data_sheet(*sheet, "bare");
  CHECK(text.find("max_acceleration_mm_s2 = 500           # default, matters; mm/s2\n") != text.npos);
  CHECK(text.find("steps_per_mm = 400                     # default; ") != text.npos);
  CHECK(text.find("# given: 1m/min; mm/s, also the rapid rate\n") != text.npos);
  CHECK(text.find("#   kadr machine new bare --travel 300 --max-speed 1m/min\n") != text.npos);
}

TEST_CASE("a bad data sheet is refused with option, axis, what was given and what is allowed") {
  using Words = DataSheetWords;
  const struct {
    std::string Words::*word;
    const char* value;
    const char* complaint;
  } cases[] = {
      {&Words::axes, "XYX", "each once, e.g. XYZ; got 'XYX': X is given twice"},
      {&Words::axes, "XQ", "--axes takes letters of X Y Z A B C U V W"},
      {&Words::axes, ",", "--axes takes letters"},
      {&Words::travel, "800,800",
       "--travel takes one value for all axes, or 3 in the order X,Y,Z; got 2: '800,800'"},
      {&Words::travel, "800,,80", "--travel of axis Y takes a length or a range"},
      {&Words::travel, "-5", "--travel of axis X is -5 mm; allowed: above 0"},
      {&Words::travel, "0", "allowed: above 0"},
      {&Words::travel, "nan", "got 'nan'"},
      {&Words::travel, "inf", "got 'inf'"},
      {&Words::travel, "9..-9", "runs from 9 to -9 mm; allowed: LOW..HIGH with LOW < HIGH"},
      {&Words::travel, "1..", "got '1..'"},
      {&Words::travel, "1e300", "allowed: -1e+08 to 1e+08 mm"},
      {&Words::max_speed, "5000", "--max-speed of axis X takes a speed with its unit, e.g. 5000mm/min"},
      {&Words::max_speed, "5000", "add the unit"},
      {&Words::max_speed, "-5m/min", "is -83.3333 mm/s ('-5m/min'); allowed: 1e-06 to 1e+09 mm/s"},
      {&Words::max_speed, "0mm/s", "is 0 mm/s"},
      {&Words::max_speed, "inf", "got 'inf'"},
      {&Words::max_speed, "5furlong/min", "unit 'furlong/min' is not known"},
      {&Words::max_speed, "5mm", "'mm' is another kind of unit"},
      {&Words::max_speed, "20rpm", "axis X moves along a line"},
      {&Words::max_speed, "5,5mm/s,5mm/s", "--max-speed of axis X takes a speed with its unit"},
      {&Words::acceleration, "-200", "--acceleration of axis X is -200 mm/s2"},
      {&Words::acceleration, "fast", "--acceleration of axis X takes an acceleration"},
      {&Words::jerk, "0", "allowed: 1e-06 to 1e+15 mm/s3, or inf"},
      {&Words::steps, "0", "--steps-per-mm of axis X is 0 steps/mm ('0'); allowed: 1e-06 to 1e+07 steps/mm"},
      {&Words::steps, "400000", "3.33333e+07 steps/s; allowed: up to 5e+06 steps/s"},
      {&Words::home, "0,0,41", "--home of axis Z is 41 mm; allowed: -40 to 40 mm"},
      {&Words::tool_change, "-1", "--tool-change is -1 s"},
      {&Words::tool_change, "8mm", "'mm' is another kind of unit"},
  };
  for (const auto& c : cases) {
    CAPTURE(c.value);
    DataSheetWords words = router();
    words.*c.word = c.value;
    const std::string told = complaint(words);
    CAPTURE(told);
    CHECK(told.find(c.complaint) != std::string::npos);
  }
  for (const auto word : {&Words::travel, &Words::max_speed}) {
    DataSheetWords words = router();
    (words.*word).clear();
    CHECK(complaint(words).starts_with("a data sheet needs --"));
  }
}

TEST_CASE("random data sheets: the file holds the numbers that were given") {
  const char* wanted = std::getenv("KADR_SEED");
  const auto seed = wanted ? std::strtoull(wanted, nullptr, 10) : 16;
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return low * std::pow(high / low, std::uniform_real_distribution<double>(0, 1)(random));
  };
  for (int round = 0; round < 500; ++round) {
    std::string letters = "XYZABCUVW";
    std::shuffle(letters.begin(), letters.end(), random);
    letters.resize(1 + random() % 9);
    DataSheetWords words;
    words.axes = letters;
    std::vector<double> low, high, speed, accel, steps;
    const auto add = [](std::string& list, const std::string& word) {
      list += (list.empty() ? "" : ",") + word;
    };
    for (const char letter : letters) {
      const bool rotary = is_rotary_letter(letter);
      low.push_back(-uniform(1e-3, 1e5));
      high.push_back(uniform(1e-3, 1e5));
      speed.push_back(uniform(1e-2, 1e3));
      accel.push_back(uniform(1, 1e5));
      steps.push_back(uniform(1, 5e3));
      add(words.travel, number_text(low.back()) + ".." + number_text(high.back()));
      add(words.max_speed, number_text(speed.back()) + (rotary ? "deg/s" : "mm/s"));
      add(words.acceleration, number_text(accel.back()));
      add(words.steps, number_text(steps.back()));
    }
    CAPTURE(words.travel);
    const MachineModel m = model_of(words);
    REQUIRE(m.axis.size() == letters.size());
    for (std::size_t i = 0; i < m.axis.size(); ++i) {
      CHECK(m.axis[i].letter == letters[i]);
      CHECK(m.axis[i].soft_min_u == low[i]);
      CHECK(m.axis[i].soft_max_u == high[i]);
      CHECK(m.axis[i].max_feed_u_s == speed[i]);
      CHECK(m.axis[i].max_accel_u_s2 == accel[i]);
      CHECK(m.axis[i].step_u == 1 / steps[i]);
      CHECK(m.axis[i].junction_accel_u_s2 == default_junction_u_s2(accel[i]));
    }
  }
}

TEST_CASE("a rigid motor needs no masses, and with a link it needs all of its numbers") {
  const std::string axis =
      "format = 1\nname = \"m\"\n[[axis]]\nname = \"X\"\nstep_mm = 0.01\nrange_mm = [0, 1]\nmax_mm_s = 1\n"
      "max_acceleration_mm_s2 = 1\nmax_jerk_mm_s3 = inf\n[axis.plant]\nmodel = \"rigid\"\n";
  const auto read = [](const std::string& text) {
    SourceSet sources;
    return read_machine(SourceText("m.toml", text), sources);
  };
  const auto bare = read(axis);
  REQUIRE(bare.has_value());
  CHECK_FALSE(bare->model.axis[0].has_plant);
  // numbers of other motors don't matter to it
  const auto other = read(axis + "holding_force_N = 100\n");
  REQUIRE(other.has_value());
  CHECK_FALSE(other->model.axis[0].has_plant);
  const auto half = read(axis + "link_mass_kg = 1\n");
  REQUIRE_FALSE(half.has_value());
  CHECK(half.error().list().size() == 3);
  const auto whole = read(axis +
                          "base_mass_kg = 1\nlink_mass_kg = 1\nlink_stiffness_N_per_m = 1000\n"
                          "link_damping_Ns_per_m = 1\n");
  REQUIRE(whole.has_value());
  CHECK(whole->model.axis[0].has_plant);
  CHECK_FALSE(read(axis + "link_mas_kg = 1\n").has_value());
}
