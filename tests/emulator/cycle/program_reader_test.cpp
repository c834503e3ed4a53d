#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "emulator/cycle/input_timeline.h"
#include "emulator/cycle/program_reader.h"
#include "emulator/scenario/scenario.h"
#include "tests/support/run_program.h"
#include "tests/support/test_machine.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::scenario;
using namespace kadr::test;
using gcode::Block;
using gcode::DigitalOutput;
using gcode::InputWait;
using gcode::WaitMode;

namespace {

constexpr double kTau_s = 0.001;

InputStep digital(std::int64_t tick, int number, double value) { return {{tick}, false, number, value, {}}; }

Block feed_to(double x_mm, double from_mm) {
  gcode::Feed feed;
  feed.end[0] = x_mm;
  feed.length_u = x_mm - from_mm;
  feed.feed_u_s = 100;
  return {{}, feed};
}
Block output(int number, bool on, bool with_motion) { return {{}, DigitalOutput{number, on, with_motion}}; }

}  // namespace

TEST_CASE("a wait ends at the step that fulfils it, or after its time") {
  // input 3: 1 from 1.2 s, 0 from 2 s, 1 from 3 s; input 4 and an analog input do not disturb it
  const std::vector<InputStep> steps = {digital(1200, 3, 1),
                                        digital(1500, 4, 1),
                                        {{1600}, true, 3, 7.5, {}},
                                        digital(2000, 3, 0),
                                        digital(3000, 3, 1)};
  struct Case {
    WaitMode mode;
    double begin_s, timeout_s;
    bool reached;
    double value, waited_s;
  };
  for (const Case& c : {
           Case{WaitMode::immediate, 1.199, 0, true, 0, 0},
           Case{WaitMode::immediate, 1.2, 0, true, 1, 0},  // the step holds from its tick on
           Case{WaitMode::high, 0.5, 5, true, 1, 0.7},
           Case{WaitMode::high, 1.3, 5, true, 1, 0},
           Case{WaitMode::low, 1.3, 5, true, 0, 0.7},
           Case{WaitMode::rise, 1.3, 5, true, 1, 1.7},  // high already: the next rise is at 3 s
           Case{WaitMode::rise, 1.2, 1, false, 0, 1},   // it rose as the wait began; low since 2 s
           Case{WaitMode::fall, 0, 5, true, 0, 2},
           Case{WaitMode::high, 0.5, 0.7, true, 1, 0.7},
           Case{WaitMode::high, 0.5, 0.6, false, 0, 0.6},
       }) {
    const WaitOutcome outcome = wait_for({3, false, c.mode, c.timeout_s}, c.begin_s, steps, kTau_s);
    CAPTURE(static_cast<int>(c.mode));
    CAPTURE(c.begin_s);
    CHECK(outcome.reached == c.reached);
    CHECK(outcome.value == c.value);
    CHECK(outcome.waited_s == doctest::Approx(c.waited_s));
  }
  CHECK(wait_for({3, true, WaitMode::immediate, 0}, 1.7, steps, kTau_s).value == 7.5);
}

TEST_CASE("a wait begins when the machine stands at its block, and holds the machine until its input comes") {
  // 100 mm at 100 mm/s take 1.1 s (see the cycle's first test); a dwell of 0.5 s follows, then the wait from
  // 1.6 s to the step at 2.25 s, then 1.1 s of motion: 3.35 s
  for (const bool asked_first : {true, false}) {
    CAPTURE(asked_first);
    TestInputs in = make_inputs("", test_machine(1));
    in.given.inputs = {digital(2250, 3, 1)};
    Diagnostics diagnostics;
    ProgramReader reader(in.given, diagnostics, {});
    reader.take(feed_to(100, 0));
    reader.take({{}, gcode::Dwell{0.5}});
    const InputWait wait{3, false, WaitMode::high, 5};
    gcode::InputReading reading;
    if (asked_first) reading = reader.read_input(wait);
    reader.take({{}, wait});
    if (!asked_first) reading = reader.read_input(wait);
    CHECK(reading.reached);
    CHECK(reading.value == 1);
    reader.take(feed_to(200, 100));
    const ReadProgram read = reader.finish();
    CHECK(diagnostics.list().empty());
    REQUIRE(read.events.size() == 2);
    CHECK(read.events[1].wait.reached);
    CHECK(read.events[1].wait.waited_s == doctest::Approx(0.65));
    CHECK(hold_time_s(read.events[1], in.given.machine.model) == doctest::Approx(0.65));
  }
}

TEST_CASE("a wait that ends with its time is told, and the program goes on") {
  TestInputs in = make_inputs("", test_machine(1));
  Diagnostics diagnostics;
  ProgramReader reader(in.given, diagnostics, {});
  const InputWait wait{3, false, WaitMode::rise, 2};
  reader.take({{}, wait});
  CHECK_FALSE(reader.read_input(wait).reached);
  REQUIRE(diagnostics.list().size() == 1);
  CHECK(diagnostics.list()[0].code == Code::wait_timed_out);
  const ReadProgram read = reader.finish();
  CHECK_FALSE(read.events[0].wait.reached);
  CHECK(read.events[0].wait.waited_s == 2);
}

TEST_CASE("an output of M62 changes as the next motion begins, one of M64 at once and at rest") {
  TestInputs in = make_inputs("", test_machine(1));
  Diagnostics diagnostics;
  ProgramReader reader(in.given, diagnostics, {});
  reader.take(feed_to(10, 0));
  reader.take(output(1, true, true));
  reader.take(output(2, true, true));
  reader.take(output(1, false, true));  // overwrites the first one
  reader.take({{}, gcode::Dwell{1}});
  reader.take(feed_to(20, 10));
  reader.take(output(5, true, false));
  reader.take(output(6, true, true));  // no motion follows
  const ReadProgram read = reader.finish();
  REQUIRE(read.events.size() == 4);
  const auto digital_output = [&](std::size_t i) {
    return std::get<DigitalOutput>(read.events[i].block.action);
  };
  CHECK(gcode::is<gcode::Dwell>(read.events[0].block));
  CHECK(digital_output(1).number == 2);
  CHECK(read.events[1].after_segment == 1);
  CHECK(digital_output(2).number == 1);
  CHECK_FALSE(digital_output(2).on);
  CHECK(digital_output(3).number == 5);
  CHECK(read.path.segments[1].stop_at_end);
  REQUIRE(diagnostics.list().size() == 1);
  CHECK(diagnostics.list()[0].code == Code::output_without_motion);
}

TEST_CASE("a thread begins at rest, and the next cut of the same thread does not stop") {
  TestInputs in = make_inputs("", test_machine(1));
  Diagnostics diagnostics;
  ProgramReader reader(in.given, diagnostics, {});
  const Block start{{}, gcode::SyncStart{1.5}}, stop{{}, gcode::SyncStop{}};
  reader.take(feed_to(10, 0));
  reader.take(start);
  reader.take(feed_to(20, 10));
  reader.take(stop);
  reader.take(start);
  reader.take(feed_to(30, 20));
  reader.take(stop);
  const ReadProgram read = reader.finish();
  CHECK(read.path.segments[0].stop_at_end);
  CHECK_FALSE(read.path.segments[1].stop_at_end);
}

TEST_CASE("a spline is one block of the log, of the plan and of the soft limits") {
  RunResult r;
  run_program(r, "G0 X1\nG1 X2 F1200\nG5 X42 Y0 I0 J30 P0 Q-30\nX50\nM2\n", test_machine(2));
  REQUIRE(r.log.blocks.size() == 4);
  CHECK(r.log.blocks[2].motion == "spline");
  CHECK(r.log.blocks[2].text == "G5 X42 Y0 I0 J30 P0 Q-30");
  CHECK(r.log.blocks[2].length_u == doctest::Approx(r.job->read.path.length_u() - 1 - 1 - 8).epsilon(1e-6));
  CHECK(r.log.blocks[2].programmed_u_s == 20);
  CHECK(r.log.blocks[3].block == 3);
  CHECK(r.job->read.blocks == 4);
  CHECK(r.summary.axis[0].end_u == 50);

  machine::MachineModel small = test_machine(2);
  small.axis[1].soft_max_u = 5;
  TestInputs in = make_inputs("G5 X42 Y0 I0 J30 P0 Q-30 F1200\nM2\n", small);
  Diagnostics diagnostics;
  in.prepare(diagnostics, SoftLimitRule::warning);
  CHECK(diagnostics.warnings() == 1);
}

TEST_CASE("a probing move is told with its contact, and the machine file's stock is met") {
  machine::MachineModel machine = test_machine(3);
  machine.stock = machine::StockModel{'Z', -5, true};
  RunResult r;
  run_program(r, "G38.2 Z-9 F600\nG0 X[#5063]\nM2\n", machine);
  REQUIRE(r.log.of_kind("probe").size() == 1);
  CHECK(r.log.of_kind("probe")[0].value == 1);
  CHECK(r.log.of_kind("probe")[0].text == "contact at X0 Y0 Z-5 (machine coordinates, mm)");
  CHECK(r.summary.axis[2].end_u == -5);
  CHECK(r.summary.axis[0].end_u == -5);
}

TEST_CASE("steps of a scenario stand on control ticks, and one between two ticks is told") {
  const auto folder = std::filesystem::temp_directory_path() / "kadr_scenario_inputs";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "program.ngc") << "M2\n";
  const std::string head = "format = 1\nname = \"inputs\"\nprogram = \"program.ngc\"\nmachine = \"mill3\"\n";
  std::ofstream(folder / "scenario.toml") << head << "[stock]\naxis = \"Y\"\nposition_mm = 12\n"
                                          << "[[step]]\nat_tick = 12\nanalog_input = 1\nvalue = -2.5\n"
                                          << "[[step]]\nat_s = 0.003\ninput = 3\nvalue = 1\n";
  SourceSet sources;
  const auto scenario = read_scenario(folder.string(), sources);
  REQUIRE(scenario);
  TestInputs in;
  Diagnostics diagnostics;
  REQUIRE(open_job(*scenario, in.given, in.sources, diagnostics));
  REQUIRE(in.given.inputs.size() == 2);
  CHECK(in.given.inputs[0].tick.value == 3);
  CHECK(in.given.inputs[0].number == 3);
  CHECK(in.given.inputs[1].analog);
  CHECK(in.given.inputs[1].value == -2.5);
  REQUIRE(in.given.machine.model.stock);
  CHECK(in.given.machine.model.stock->axis == 'Y');
  CHECK(in.given.machine.model.stock->position_mm == 12);

  std::ofstream(folder / "scenario.toml") << head << "[[step]]\nat_s = 0.0125\ninput = 3\nvalue = 1\n";
  SourceSet again;
  const auto between = read_scenario(folder.string(), again);
  REQUIRE(between);
  TestInputs refused;
  CHECK_FALSE(open_job(*between, refused.given, refused.sources, diagnostics));
  CHECK(diagnostics.list()[0].code == Code::scenario_step);
  CHECK(diagnostics.list()[0].label == "is 12.5 control ticks of 0.001 s");
  CHECK(diagnostics.list()[0].help == "write at_s = 0.012 or 0.013");
}
