#include "emulator/scenario/scenario.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "machine/base/hash.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::log;
using namespace kadr::scenario;
namespace fs = std::filesystem;

namespace {

/// A new folder for the files of one case.
class Folder {
 public:
  Folder() {
    static int number = 0;
    path_ = fs::temp_directory_path() /
            ("kadr_scenario_" + std::to_string(getpid()) + "_" + std::to_string(++number));
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  std::string write(const std::string& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return (path_ / name).string();
  }
  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

std::string read_text(const std::string& path) {
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

constexpr const char* kHead = "format = 1\nname = \"case\"\nprogram = \"p.ngc\"\nmachine = \"mill3\"\n";
constexpr const char* kOneLine = "G21 G90 G94\nG1 X4 F600\nM2\n";

/// Runs the line program with an [expect] and gives the result.
ScenarioResult run_expecting(const std::string& expect, const std::string& program = kOneLine) {
  Folder folder;
  folder.write("p.ngc", program);
  return run_scenario(folder.write("scenario.toml", kHead + expect));
}

/// The failed checks, "what: measured, expected ..." each.
std::string failed_checks(const ScenarioResult& result) {
  std::string out = result.failure;
  for (const ScenarioCheck& c : result.checks)
    if (!c.passed) out += c.what + ": " + c.measured + ", expected " + c.expected + "\n";
  return out;
}

/// Rendered diagnostics of a scenario file that must not be read; the folder's name is left out.
std::string refusal(const std::string& text) {
  Folder folder;
  folder.write("p.ngc", kOneLine);
  SourceSet sources;
  const auto scenario = read_scenario(folder.write("scenario.toml", text), sources);
  REQUIRE_FALSE(scenario.has_value());
  std::string out;
  for (const Diagnostic& d : scenario.error().list()) out += render_human(d, sources);
  for (std::size_t at = out.find(folder.path() + "/"); at != std::string::npos;
       at = out.find(folder.path() + "/"))
    out.erase(at, folder.path().size() + 1);
  return out;
}

}  // namespace

TEST_CASE("a scenario file is read with all its expectations") {
  Folder folder;
  folder.write("p.ngc", kOneLine);
  const std::string file = folder.write("scenario.toml", std::string(kHead) + R"(summary = "a line"
[settings]
planner.whole_ticks = false
axis.X.max_mm_s = 50
[expect]
time_s = 1.25
within_s = 0.001
steps_hash = "00ff00ff00ff00ff"
alarms = { K5102 = 2, K5101 = 1 }
diagnostics = ["K5101"]
[expect.axis.X]
pulses = 1600
end_steps = -1600
vibration_um = [1, 20.5]
[expect.axis.A]
residual_mdeg = [0, 3]
)");
  SourceSet sources;
  const auto s = read_scenario(folder.path(), sources);
  REQUIRE(s.has_value());
  CHECK(s->file == file);
  CHECK(s->name == "case");
  CHECK(s->summary == "a line");
  CHECK(s->program_name == "p.ngc");
  CHECK_FALSE(s->machine_is_file);
  REQUIRE(s->settings.size() == 2);
  CHECK(s->settings[0] == "planner.whole_ticks=false");
  CHECK(s->settings[1] == "axis.X.max_mm_s=50");
  CHECK(s->expect.time_s == 1.25);
  CHECK(s->expect.within_s == 0.001);
  CHECK(s->expect.steps_hash == 0x00ff00ff00ff00ffu);
  REQUIRE(s->expect.alarms.size() == 2);
  CHECK(code_name(s->expect.alarms[0].first) == "K5101");
  CHECK(s->expect.alarms[1].second == 2);
  CHECK(s->expect.diagnostics.size() == 1);
  REQUIRE(s->expect.axis.size() == 2);
  CHECK(s->expect.axis[0].pulses == 1600);
  CHECK(s->expect.axis[0].end_steps == -1600);
  CHECK(s->expect.axis[0].vibration->most_u == doctest::Approx(0.0205));
  CHECK(s->expect.axis[1].residual->most_u == doctest::Approx(0.003));
}

TEST_CASE("a scenario names its tool table and its dialect") {
  const Folder folder;
  folder.write("p.ngc", "G0 X1\n");
  folder.write("shop.tbl", "T1 P1 Z10\n");
  const std::string head = "format = 1\nname = \"case\"\nprogram = \"p.ngc\"\nmachine = \"mill3\"\n";
  folder.write("scenario.toml", head + "tools = \"shop.tbl\"\ndialect = \"grbl\"\n");
  SourceSet sources;
  const auto s = read_scenario(folder.path(), sources);
  REQUIRE(s.has_value());
  CHECK(s->dialect == gcode::Dialect::grbl);
  JobInputs given;
  Diagnostics diagnostics;
  REQUIRE(open_job(*s, given, sources, diagnostics));
  CHECK(given.reading.dialect == gcode::Dialect::grbl);
  REQUIRE(given.reading.tools);
  CHECK(given.reading.tools->find(1)->offset[2] == 10);

  folder.write("shop.tbl", "T1 P1 Z1,0\n");
  JobInputs refused;
  CHECK_FALSE(open_job(*s, refused, sources, diagnostics));
  CHECK(diagnostics.list().back().code == Code::tool_table_number);
  folder.write("scenario.toml", head);
  const auto plain = read_scenario(folder.path(), sources);
  REQUIRE(plain.has_value());
  CHECK(plain->tools_file.empty());
  CHECK(plain->dialect == gcode::Dialect::linuxcnc);
}

TEST_CASE("mistakes of a scenario file are told at their place, all in one run") {
  const std::string text = refusal(R"(format = 1
nam = "case"
program = "missing.ngc"
machine = "mill4"
[[step]]
at_s = 1
[expect]
time_s = 2
steps_hash = "12"
alarms = { K7777 = 1 }
[expect.axis.Q]
pulses = 1
)");
  CAPTURE(text);
  CHECK(text.find("did you mean name?") != std::string::npos);
  CHECK(text.find("scenario.toml:2:1") != std::string::npos);
  CHECK(text.find("there is no file missing.ngc") != std::string::npos);
  CHECK(text.find("scenario.toml:3:11") != std::string::npos);
  CHECK(text.find("there is no machine 'mill4' and no such file") != std::string::npos);
  CHECK(text.find("machines that ship with kadr: mill3, winder4, rig1, robot7") != std::string::npos);
  CHECK(text.find("K3203") != std::string::npos);
  CHECK(text.find("within_s is not given") != std::string::npos);
  CHECK(text.find("a hash has 16 hexadecimal digits") != std::string::npos);
  CHECK(text.find("there is no code K7777") != std::string::npos);
  CHECK(text.find("'Q' is not an axis letter") != std::string::npos);
}

TEST_CASE("a winding is given by its parameters, checked like every key") {
  Folder folder;
  const std::string file = folder.write("scenario.toml", R"(format = 1
name = "hoop"
machine = "winder4"
wind = { kind = "hoop", length_mm = 24, layers = 1 }
)");
  SourceSet sources;
  const auto s = read_scenario(file, sources);
  REQUIRE(s.has_value());
  CHECK(s->program_name == "wind_hoop.ngc");
  CHECK(s->generated_program.starts_with(
      "(kadr wind hoop --radius-mm 50 --length-mm 24 --band-mm 6 --layers 1"));

  const std::string text = refusal(
      "format = 1\nname = \"hoop\"\nmachine = \"winder4\"\n"
      "wind = { kind = \"hoop\", lenght_mm = 24, layers = 0 }\n");
  CHECK(text.find("did you mean length_mm?") != std::string::npos);
  CHECK(text.find("is 0, must be above 0") != std::string::npos);
  CHECK(refusal(std::string(kHead) + "wind = { kind = \"hoop\" }\n").find("keep one of program and [wind]") !=
        std::string::npos);
  CHECK(
      refusal("format = 1\nname = \"x\"\nmachine = \"winder4\"\nwind = { kind = \"dome\", polar_mm = 60 }\n")
          .find("polar_mm is 60, allowed up to 0.95 radius_mm = 57") != std::string::npos);
}

TEST_CASE("a program that does what is expected passes, every other number is seen") {
  const ScenarioResult plain = run_expecting("");
  CAPTURE(failed_checks(plain));
  REQUIRE(plain.passed());
  REQUIRE(plain.summary.has_value());
  // 4 mm at 1/400 mm a step
  const AxisSummary& x = plain.summary->axis.at(0);
  CHECK(x.pulses == 1600);  // 4 mm in steps of 0.0025 mm
  const std::string hash = hash_text(plain.summary->steps_hash);
  const std::string time = std::to_string(plain.machine_s);

  CHECK(run_expecting("[expect]\nsteps_hash = \"" + hash + "\"\ntime_s = " + time +
                      "\nwithin_s = 0.000001\n" + "[expect.axis.X]\npulses = 1600\nend_steps = 1600\n")
            .passed());

  std::string other = hash;
  other[15] = other[15] == '0' ? '1' : '0';
  CHECK(failed_checks(run_expecting("[expect]\nsteps_hash = \"" + other + "\"\n")) ==
        "steps hash: " + hash + ", expected " + other + "\n");
  CHECK(failed_checks(run_expecting("[expect.axis.X]\npulses = 1601\n")) ==
        "pulses X: 1600, expected 1601\n");
  CHECK(failed_checks(run_expecting("[expect.axis.X]\nend_steps = -1600\n")) ==
        "end steps X: 1600, expected -1600\n");
  CHECK(failed_checks(run_expecting("[expect.axis.X]\nvibration_um = [1e6, 2e6]\n")).find("vibration X: ") ==
        0);
  CHECK(failed_checks(run_expecting("[expect.axis.Y]\nresidual_um = [1e6, 2e6]\n")).find("residual Y: ") ==
        0);
  CHECK(failed_checks(run_expecting("[expect.axis.B]\npulses = 0\n")) ==
        "axis B: the machine has no such axis, expected present\n");
  CHECK(failed_checks(run_expecting("[expect]\nalarms = { K5101 = 1 }\n")) ==
        "alarms: none, expected K5101 x1\n");
  CHECK(failed_checks(run_expecting("[expect]\ndiagnostics = [\"K5101\"]\n")) ==
        "diagnostics: none, expected K5101\n");
  const std::string early = failed_checks(run_expecting("[expect]\ntime_s = 0.001\nwithin_s = 0.0005\n"));
  CHECK(early.find("time: ") == 0);
}

TEST_CASE("an alarm that nobody expected fails the scenario, and a named one passes") {
  // the machine's range of X ends at 3 mm
  const std::string setting = "[settings]\naxis.X.range_mm = [0, 3]\n";
  const ScenarioResult result = run_expecting(setting);
  CHECK_FALSE(result.passed());
  REQUIRE(result.alarms.size() == 1);
  CHECK(code_name(result.alarms[0].first) == "K5101");
  REQUIRE(result.codes.size() == 1);
  CHECK(run_expecting(setting + "[expect]\nalarms = { K5101 = 1 }\ndiagnostics = [\"" +
                      code_name(result.codes[0]) + "\"]\n")
            .passed());
}

TEST_CASE("a refused program passes only if its diagnostics are the expected ones, in order") {
  const std::string program = "G1 X1 F100 ?\nG1 X1,5\nM2\n";
  const ScenarioResult plain = run_expecting("", program);
  CHECK_FALSE(plain.passed());
  REQUIRE(plain.codes.size() == 2);
  const std::string first = code_name(plain.codes[0]), second = code_name(plain.codes[1]);
  CHECK(run_expecting("[expect]\ndiagnostics = [\"" + first + "\", \"" + second + "\"]\n", program).passed());
  CHECK_FALSE(run_expecting("[expect]\ndiagnostics = [\"" + first + "\"]\n", program).passed());
  // a refused program has no time
  CHECK_FALSE(run_expecting("[expect]\ntime_s = 1\nwithin_s = 1\ndiagnostics = [\"" + first + "\", \"" +
                                second + "\"]\n",
                            program)
                  .passed());
  CHECK(render_result(plain).find("p.ngc:1:") != std::string::npos);
}

TEST_CASE("--update writes the measured values over the stated ones and leaves the rest alone") {
  Folder folder;
  folder.write("p.ngc", kOneLine);
  const std::string file = folder.write("scenario.toml", std::string(kHead) + R"([expect]   # what comes out
time_s = 99.5      # seconds
within_s = 0.000001
steps_hash = "0000000000000000"
alarms = { K5101 = 7 }  # gone
[expect.axis.X]
pulses = 1   # counted
vibration_um = [0, 1e6]
)");
  const ScenarioResult before = run_scenario(file);
  CHECK_FALSE(before.passed());
  SourceSet sources;
  const auto scenario = read_scenario(file, sources);
  REQUIRE(scenario.has_value());
  const std::string text = updated_text(*scenario, before);
  CHECK(text.find("pulses = 1600   # counted\n") != std::string::npos);
  CHECK(text.find("alarms = {}  # gone\n") != std::string::npos);
  CHECK(text.find("[expect]   # what comes out\n") != std::string::npos);
  CHECK(text.find("vibration_um = [0, 1e6]\n") != std::string::npos);
  folder.write("scenario.toml", text);
  const ScenarioResult after = run_scenario(file);
  CHECK_MESSAGE(after.passed(), failed_checks(after));
  SourceSet again;
  CHECK(updated_text(*read_scenario(file, again), after) == text);
}

TEST_CASE("--update gives a scenario without expectations all the exact ones") {
  Folder folder;
  folder.write("p.ngc", kOneLine);
  const std::string file = folder.write("scenario.toml", kHead);
  SourceSet sources;
  folder.write("scenario.toml", updated_text(*read_scenario(file, sources), run_scenario(file)));
  const ScenarioResult result = run_scenario(file);
  CHECK_MESSAGE(result.passed(), failed_checks(result));
  CHECK(read_text(file).find("[expect.axis.Z]\npulses = 0\nend_steps = 0\n") != std::string::npos);
  // diagnostics, time, hash, alarms, and two counts for each of three axes
  CHECK(result.checks.size() == 4 + 6);
}

TEST_CASE("JUnit results are escaped XML with machine time") {
  ScenarioResult good, bad;
  good.name = "a<b";
  good.machine_s = 1.5;
  good.checks = {{"time", "1", "1", true}};
  bad.name = "c&d";
  bad.checks = {{"say \"x\"", "1", "2\x01", false}};
  CHECK(render_junit({good, bad}) ==
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuite name=\"kadr scenarios\" tests=\"2\" failures=\"1\" errors=\"0\" time=\"1.500000\">\n"
        "  <testcase classname=\"kadr.scenarios\" name=\"a&lt;b\" file=\"\" time=\"1.500000\"/>\n"
        "  <testcase classname=\"kadr.scenarios\" name=\"c&amp;d\" file=\"\" time=\"0.000000\">\n"
        "    <failure message=\"say &quot;x&quot;: 2\xEF\xBF\xBD, expected 1\">say &quot;x&quot;: "
        "2\xEF\xBF\xBD, expected 1\n"
        "</failure>\n  </testcase>\n</testsuite>\n");
  CHECK(render_totals({good, bad}) == "1 passed, 1 failed\n");
  // nothing compared is not a pass
  CHECK_FALSE(ScenarioResult{}.passed());
}

TEST_CASE("scenarios are found by file, folder and folder of folders, in order") {
  Folder folder;
  folder.write("p.ngc", kOneLine);
  const std::string b = folder.write("b/scenario.toml", kHead), a = folder.write("a/scenario.toml", kHead);
  const auto found = [](const std::vector<std::string>& paths) {
    std::vector<std::string> files;
    for (const InputFile& file : find_scenarios(paths)) files.push_back(file.path);
    return files;
  };
  CHECK(found({folder.path()}) == std::vector<std::string>{a, b});
  CHECK(found({b, folder.path() + "/a"}) == std::vector<std::string>{b, a});
  CHECK_THROWS_AS(find_scenarios({folder.path() + "/none"}), std::system_error);
  const ScenarioResult missing = run_scenario(folder.path() + "/none/scenario.toml");
  CHECK_FALSE(missing.passed());
  CHECK(missing.failure.find("none/scenario.toml") != std::string::npos);
}
