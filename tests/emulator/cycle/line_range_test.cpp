#include <doctest/doctest.h>

#include "emulator/answers/answers.h"
#include "tests/support/run_program.h"
#include "tests/support/test_machine.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::test;

namespace {

const std::string kProgram =
    "G21 G90 F3000 S500 M3\n"  // 1
    "G0 Z20\n"                 // 2
    "G0 X10 Y5\n"              // 3
    "G4 P2\n"                  // 4
    "G1 Z-10\n"                // 5
    "G1 X40\n"                 // 6
    "G1 Y25\n"                 // 7
    "M2\n";

void prepare_from(RunResult& r, std::uint32_t line, const std::string& program = kProgram) {
  r.in = make_inputs(program, test_machine(3));
  r.in.given.reading.from_line = line;
  prepare_run(r);
}

}  // namespace

TEST_CASE("a run that is entered at a line approaches it from home, and ends where a full run ends") {
  RunResult full, part;
  run_program(full, kProgram, test_machine(3));
  prepare_from(part, 6);
  run_prepared(part);
  CHECK(part.summary.outcome == log::Outcome::complete);
  CHECK(part.summary.blocks == 2);
  CHECK(part.summary.path_u == doctest::Approx(30 + 20));
  CHECK(part.summary.dwell_s == 0);
  for (std::size_t a = 0; a < 3; ++a) CHECK(part.summary.axis[a].end_steps == full.summary.axis[a].end_steps);
  // the way there is a block of the log, before those of the program
  REQUIRE(part.log.blocks.size() == 3);
  CHECK(part.log.blocks[0].motion == "approach");
  CHECK(part.log.blocks[0].span.line == 6);
  CHECK(part.log.blocks[1].span.line == 6);
  CHECK(part.log.blocks[2].span.line == 7);
  // X and Y before Z, which goes down
  const auto steps_of = [&](std::size_t tick, std::size_t axis) {
    return part.log.ticks[tick].steps[axis].value;
  };
  for (std::size_t t = 0; t < part.log.ticks.size() && steps_of(t, 2) == 0; ++t) CHECK(steps_of(t, 0) >= 0);
  const planner::Path& path = part.job->read.path;
  REQUIRE(path.approach_size() == 2);
  CHECK(path.node(1)[0] == 10);
  CHECK(path.node(1)[1] == 5);
  CHECK(path.node(1)[2] == 0);
  CHECK(path.node(2)[2] == -10);
  CHECK(path.segments[0].stop_at_end);
  CHECK(path.segments[1].stop_at_end);
  // the spindle turns before anything moves
  const auto spindle = part.log.of_kind("spindle");
  REQUIRE(spindle.size() >= 2);
  CHECK(spindle[0].tick.value == 0);
  CHECK(spindle[1].tick.value == 0);
}

TEST_CASE("the time of the approach is part of the run, and a row of its own") {
  RunResult r;
  prepare_from(r, 6);
  run_prepared(r);
  const answers::CheckResult check = answers::check_result(*r.job);
  REQUIRE(check.approach);
  CHECK(check.approach->line == 6);
  CHECK(check.approach->ways == std::vector<std::string>{"XY", "Z"});
  CHECK(check.approach->time_s > 0);
  CHECK(check.blocks == 2);
  CHECK(check.path_u == doctest::Approx(50));
  CHECK(check.rapid_s == 0);
  CHECK(check.peak_u_s == doctest::Approx(50).epsilon(0.01));  // F3000, not the rapid of the approach
  CHECK(check.time_s == doctest::Approx(r.summary.motion_s));
  // the mean feed is the program's
  CHECK(r.summary.mean_feed_u_s ==
        doctest::Approx(50 / (r.summary.motion_s - check.approach->time_s)).epsilon(1e-3));
  std::vector<answers::PlanRow> rows;
  answers::for_each_plan_row(*r.job, [&](const answers::PlanRow& row) { rows.push_back(row); });
  REQUIRE(rows.size() == 3);
  CHECK(rows[0].motion == "approach");
  CHECK(rows[0].time_s == check.approach->time_s);
  CHECK(rows[1].begin_s == doctest::Approx(rows[0].time_s));
  CHECK(rows[1].line == 6);
}

TEST_CASE("a program that is entered where the machine stands has an approach without motion") {
  RunResult r;
  prepare_from(r, 1);
  const answers::CheckResult check = answers::check_result(*r.job);
  REQUIRE(check.approach);
  CHECK(check.approach->time_s == 0);
  CHECK(check.approach->ways.empty());
  CHECK(r.job->read.path.approach_size() == 0);
}

TEST_CASE("soft limits hold for the approach, not for what is passed over") {
  const std::string program = "G21 G90 F3000\nG0 X500\nG0 X10\nG0 Y500\nG1 X20\nG0 Y0\nG1 X30\nM2\n";
  machine::MachineModel machine = test_machine(3);
  for (machine::AxisModel& axis : machine.axis) axis.soft_min_u = -100, axis.soft_max_u = 100;
  const auto lines = [&](std::uint32_t from_line) {
    TestInputs in = make_inputs(program, machine);
    in.given.reading.from_line = from_line;
    Diagnostics diagnostics;
    REQUIRE(in.prepare(diagnostics));
    std::vector<std::uint32_t> list;
    for (const Diagnostic& d : diagnostics.list()) list.push_back(d.span.line);
    if (from_line == 5) CHECK(diagnostics.list().at(0).notes.at(1).starts_with("on the way from home"));
    return list;
  };
  CHECK(lines(1) == std::vector<std::uint32_t>{2, 4});
  CHECK(lines(7).empty());
  CHECK(lines(5) == std::vector<std::uint32_t>{5});
}

TEST_CASE("places of the timeline and of technology points count from where the program is entered") {
  RunResult r;
  r.in = make_inputs(kProgram, test_machine(3));
  r.in.given.reading.from_line = 6;
  OperatorStep at_path;
  at_path.value = 0.5;
  at_path.place = PathPlace{PathPlace::Kind::length, 10};
  OperatorStep at_block = at_path;
  at_block.place = PathPlace{PathPlace::Kind::block, 1};
  r.in.given.operator_steps = {at_path, at_block};
  r.in.given.place_limits = {{20, 1, {}}};
  prepare_run(r);
  const double begin_u = r.job->read.path.program_begin_u();
  CHECK(r.job->planned.step_places_u[0] == doctest::Approx(begin_u + 10));
  CHECK(r.job->planned.step_places_u[1] == doctest::Approx(begin_u + 30));
  CHECK(r.job->read.path.start_s_u[3] == doctest::Approx(begin_u + 20));

  TestInputs before = make_inputs(kProgram, test_machine(3));
  before.given.reading.from_line = 6;
  at_path.place = PathPlace{PathPlace::Kind::line, 3};
  before.given.operator_steps = {at_path};
  Diagnostics diagnostics;
  CHECK_FALSE(before.prepare(diagnostics));
  CHECK(diagnostics.list().at(0).code == Code::scenario_step);
}

TEST_CASE("a wait before the entry reads its input at the beginning and takes no time") {
  const std::string program =
      "G21 G90 F3000\n"
      "M66 P1 L3 Q9\n"
      "#1=#5399\n"
      "M66 P2 L0\n"
      "G0 X[10+#1+#5399]\n"
      "M66 P1 L0\n"
      "G1 Y[10*#5399]\n"
      "M2\n";
  RunResult r;
  r.in = make_inputs(program, test_machine(3));
  r.in.given.reading.from_line = 6;
  r.in.given.inputs = {{ControlTicks{0}, false, 1, 1, {}}, {ControlTicks{1}, false, 1, 0, {}}};
  prepare_run(r);
  run_prepared(r);
  CHECK(r.summary.dwell_s == 0);
  CHECK(r.summary.axis[0].end_u == doctest::Approx(11));
  // behind the entry it is read when the machine is there
  CHECK(r.summary.axis[1].end_u == 0);
}
