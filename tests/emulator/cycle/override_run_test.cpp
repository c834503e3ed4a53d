#include <doctest/doctest.h>

#include "tests/support/operator_step.h"
#include "tests/support/run_program.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::log;
using kadr::test::operator_step;

namespace {

machine::MachineModel mill() {
  SourceSet sources;
  auto file = machine::read_machine(SourceText("mill3.toml", std::string(machine::shipped_machine("mill3"))),
                                    sources);
  REQUIRE(file);
  return file->model;
}

using Ride = test::RunResult;

OperatorStep at_place(PathPlace place, OperatorAction action, double value = 1) {
  OperatorStep step = operator_step(0, action, value);
  step.place = place;
  return step;
}

void run_with(Ride& r, const std::string& program, std::vector<OperatorStep> steps) {
  r.in = test::make_inputs(program, mill());
  r.in.given.operator_steps = std::move(steps);
  test::prepare_run(r);
  RunOptions options;
  options.plant = false;
  test::run_prepared(r, options);
}

std::vector<Code> alarms(const Ride& r) {
  std::vector<Code> codes;
  for (const EventRecord& e : r.log.events)
    if (e.kind == log::EventKind::alarm) codes.push_back(e.code);
  return codes;
}

double lost_s(const Ride& r, const std::string& reason) {
  for (const LimitShare& share : r.summary.lost_by)
    if (share.limited_by == reason) return share.time_s;
  return 0;
}

constexpr const char* kRunLine = "G21 G90 G94\nG1 X100 F6000\nM2\n";
constexpr const char* kCorner = "G21 G90 G94\nG1 X50 F6000\nG1 Y50\nM2\n";
constexpr const char* kThread = "G21 G90 G94\nS1500 M3\nG33 X30 K1\nM5\nM2\n";

}  // namespace

TEST_CASE(
    "an emergency stop brakes at once, also while braking and in a thread, and the run ends where the axis "
    "stands") {
  Ride cruise;
  run_with(cruise, kRunLine, {operator_step(400, OperatorAction::emergency_stop)});
  CHECK(cruise.summary.outcome == log::Outcome::emergency_stop);
  CHECK(cruise.summary.control_ticks.value == 500);  // 100 ticks from 100 mm/s
  CHECK(cruise.summary.axis[0].end_u == doctest::Approx(40.0).epsilon(1e-9));
  CHECK(alarms(cruise) == std::vector<Code>{Code::emergency_stopped});
  CHECK(cruise.summary.alarms == 1);

  Ride braking;  // for the corner, from tick 501 on: a hold would wait for it
  run_with(braking, kCorner, {operator_step(560, OperatorAction::emergency_stop)});
  CHECK(braking.summary.outcome == log::Outcome::emergency_stop);
  CHECK(braking.summary.control_ticks.value < 605);

  Ride thread;
  run_with(thread, kThread, {operator_step(600, OperatorAction::emergency_stop)});
  CHECK(thread.summary.outcome == log::Outcome::emergency_stop);
  CHECK(thread.summary.control_ticks.value < 660);
}

TEST_CASE("a hold that nobody ends ends the run, and says so") {
  Ride r;
  run_with(r, kRunLine, {operator_step(400, OperatorAction::hold)});
  CHECK(r.summary.outcome == log::Outcome::held);
  CHECK(alarms(r) == std::vector<Code>{Code::held_to_the_end});
  Ride zero;
  run_with(zero, kRunLine, {operator_step(400, OperatorAction::feed_override, 0.0)});
  CHECK(zero.summary.outcome == log::Outcome::held);
}

TEST_CASE("an override below 0.01 % is a hold: a run that nothing releases ends") {
  for (const double almost_0 : {1e-11, 9e-5}) {
    CAPTURE(almost_0);
    Ride feed;
    run_with(feed, kRunLine, {operator_step(400, OperatorAction::feed_override, almost_0)});
    CHECK(feed.summary.outcome == log::Outcome::held);
    CHECK(alarms(feed) == std::vector<Code>{Code::held_to_the_end});
    Ride rapid;
    run_with(rapid, "G0 X100\nM2\n", {operator_step(0, OperatorAction::rapid_override, almost_0)});
    CHECK(rapid.summary.outcome == log::Outcome::held);
    CHECK(alarms(rapid) == std::vector<Code>{Code::held_to_the_end});
  }
  Ride slow;
  run_with(slow, "F6000 G1 X0.01\nM2\n", {operator_step(0, OperatorAction::feed_override, 1e-3)});
  CHECK(slow.summary.outcome == log::Outcome::complete);
}

TEST_CASE("a spindle overload inside a thread is told once and waits") {
  Ride r;
  run_with(r, kThread, {operator_step(600, OperatorAction::spindle_load, 1.25)});
  CHECK(alarms(r) == std::vector<Code>{Code::overload_locked});
}

TEST_CASE("steps on the path come into force with the first control tick that begins behind their place") {
  using Kind = PathPlace::Kind;
  const auto half = OperatorAction::feed_override;
  for (const PathPlace place :
       {PathPlace{Kind::length, 50}, PathPlace{Kind::line, 3}, PathPlace{Kind::block, 1},
        PathPlace{Kind::line, 2, 1, 50}, PathPlace{Kind::block, 0, 1, 50}}) {
    Ride r;
    run_with(r, kCorner, {at_place(place, half, 0.5)});
    CHECK(r.job->planned.step_places_u.at(0) == 50.0);
    const auto it = std::find_if(r.log.events.begin(), r.log.events.end(), [](const EventRecord& e) {
      return e.kind == log::EventKind::feed_override;
    });
    REQUIRE(it != r.log.events.end());
    const auto tick = static_cast<std::size_t>(it->tick.value / 10'000);
    CHECK(r.log.ticks[tick].motion.s_begin_u >= 50.0);
    CHECK(r.log.ticks[tick - 1].motion.s_begin_u < 50.0);
  }
  test::TestInputs in = test::make_inputs(kCorner, mill());
  in.given.operator_steps = {at_place({Kind::line, 7}, half, 0.5),
                             at_place({Kind::block, 1, 1, 51}, half, 0.5)};
  Diagnostics diagnostics;
  CHECK_FALSE(in.prepare(diagnostics, SoftLimitRule::warning));
  CHECK(diagnostics.errors() == 2);
}

TEST_CASE("the time lost by each reason adds up to the run's time less the planned one") {
  Ride r;
  run_with(r, kCorner,
           {operator_step(100, OperatorAction::feed_override, 0.7), operator_step(300, OperatorAction::hold),
            operator_step(600, OperatorAction::resume), operator_step(900, OperatorAction::spindle_load, 1.3),
            operator_step(2500, OperatorAction::spindle_load, 0.5)});
  CHECK(r.summary.outcome == log::Outcome::complete);
  double sum_s = 0;
  for (const LimitShare& share : r.summary.lost_by) sum_s += share.time_s;
  const double run_s = static_cast<double>(r.summary.control_ticks.value) * 1e-3;
  CHECK(sum_s == doctest::Approx(run_s - r.summary.planned_s).epsilon(1e-9));
  CHECK(lost_s(r, "hold") > 0.25);
  CHECK(lost_s(r, "override") > 0.05);
  CHECK(lost_s(r, "spindle load") > 0.1);
}

TEST_CASE("the same timeline gives the same pulses, tick by tick") {
  const std::vector<OperatorStep> steps = {operator_step(100, OperatorAction::feed_override, 0.7),
                                           operator_step(120, OperatorAction::feed_override, 1.5)};
  Ride a, b;
  run_with(a, kCorner, steps);
  run_with(b, kCorner, steps);
  CHECK(a.summary.steps_hash == b.summary.steps_hash);
}
