#include <doctest/doctest.h>

#include <string>

#include "emulator/interpolator/tick_clock.h"
#include "interpolator_paths.h"
#include "machine/base/require.h"
#include "machine/machine.h"
#include "planner/path/path.h"

using namespace kadr;
using namespace kadr::test;

namespace {

std::vector<int> offsets(const AxisPulses& pulses) {
  return {pulses.offset_ticks.begin(), pulses.offset_ticks.end()};
}

planner::TickMotion motion(std::int64_t tick, double s_begin, double s_end, double ramp_begin,
                           double ramp_end) {
  planner::TickMotion m;
  m.tick = ControlTicks{tick};
  m.s_begin_u = s_begin;
  m.s_end_u = s_end;
  m.ramp_begin_u_s = m.speed_begin_u_s = ramp_begin;
  m.ramp_end_u_s = m.speed_end_u_s = ramp_end;
  m.move_end_ticks = 10'000;
  return m;
}

std::string order(const Run& run) {
  std::string text;
  for (const auto& e : run.events) text += kAxisLetters[static_cast<std::size_t>(e.axis)];
  return text;
}

}  // namespace

TEST_CASE("a lattice node is the half-open cell [node - 1/2, node + 1/2) on both sides of zero") {
  CHECK(lattice_node(0.0, 0.25) == 0);
  CHECK(lattice_node(0.125, 0.25) == 1);
  CHECK(lattice_node(0.1249, 0.25) == 0);
  CHECK(lattice_node(-0.125, 0.25) == 0);
  CHECK(lattice_node(-0.1251, 0.25) == -1);
  CHECK(lattice_node(-0.375, 0.25) == -1);
  CHECK_THROWS_AS(lattice_node(1e300, 0.001), BrokenPromise);
  CHECK_THROWS_AS(lattice_node(std::nan(""), 0.001), BrokenPromise);
}

TEST_CASE("a line of 7 by 4 steps pulses X Y X X Y X Y X X Y X") {
  // X crosses at (i + 1/2)/7, Y at (j + 1/2)/4: .071 .125 .214 .357 .375 .5 .625 .643 .786 .875 .929
  const auto machine = machine_with(2);
  PathMaker maker({0.0, 0.0});
  maker.line({0.007, 0.004});
  const Run run = run_path(maker.path, machine, drive(maker.path.length_u(), 3.0, machine, Feed::linear, 1));
  CHECK(order(run) == "XYXXYXYXXYX");
  CHECK(run.net == std::vector<std::int64_t>{7, 4});
}

TEST_CASE("crossings at one place go by axis number") {
  const auto machine = machine_with(3);
  PathMaker maker({0.0, 0.0, 0.0});
  maker.line({0.002, 0.002, -0.002});
  const Run run = run_path(maker.path, machine, drive(maker.path.length_u(), 3.0, machine, Feed::linear, 1));
  CHECK(order(run) == "XYZXYZ");
  CHECK(run.net == std::vector<std::int64_t>{2, 2, -2});
}

TEST_CASE("pulses of a start from rest come at the square root of the way") {
  // 0 to 20 mm/s in 1 ms is 0.01 mm, ten steps: pulse k at 10000 sqrt((k + 1/2)/10) base ticks
  const auto machine = machine_with(1);
  PathMaker maker({0.0});
  maker.line({0.01});
  interpolator::CrossingInterpolator interpolator(maker.path, machine);
  StepBatch batch;
  interpolator.advance(motion(0, 0.0, 0.01, 0.0, 20.0), batch);
  CHECK(offsets(batch.axis[0]) ==
        std::vector<int>{2236, 3872, 5000, 5916, 6708, 7416, 8062, 8660, 9219, 9746});
  CHECK(batch.axis[0].command.speed_begin_u_s == 0.0);
  CHECK(batch.axis[0].command.speed_end_u_s == doctest::Approx(20.0));
  CHECK(batch.axis[0].command.position_end_u == 0.01);
}

TEST_CASE("pulses of a stop mirror those of a start") {
  // t = 10000 (1 - sqrt(1 - w)), w = (k + 1/2)/10
  const auto machine = machine_with(1);
  PathMaker maker({0.0});
  maker.line({-0.01});
  interpolator::CrossingInterpolator interpolator(maker.path, machine);
  StepBatch batch;
  interpolator.advance(motion(0, 0.0, 0.01, 20.0, 0.0), batch);
  CHECK(offsets(batch.axis[0]) == std::vector<int>{253, 780, 1339, 1937, 2583, 3291, 4083, 5000, 6127, 7763});
  CHECK(batch.axis[0].net_steps().value == -10);
  CHECK(batch.axis[0].first_sign == -1);
}

TEST_CASE("a motion of 2500 base ticks inside a control tick keeps its pulses inside them") {
  const auto machine = machine_with(1);
  PathMaker maker({0.0});
  maker.line({0.005});
  interpolator::CrossingInterpolator interpolator(maker.path, machine);
  StepBatch batch;
  // 20 mm/s for 0.25 ms: five steps, 500 base ticks apart, from base tick 4000 on
  planner::TickMotion m = motion(0, 0.0, 0.005, 20.0, 20.0);
  m.move_begin_ticks = 4000;
  m.move_end_ticks = 6500;
  interpolator.advance(m, batch);
  CHECK(offsets(batch.axis[0]) == std::vector<int>{4250, 4750, 5250, 5750, 6250});
  // outside of the motion the axis rests
  CHECK(batch.axis[0].command.speed_begin_u_s == 0.0);
  CHECK(batch.axis[0].command.speed_end_u_s == 0.0);
}

TEST_CASE("a pulse exactly on a tick's end belongs to that tick and is its last base tick") {
  const auto machine = machine_with(1, 0.25);
  PathMaker maker({0.0});
  maker.line({1.0});
  interpolator::CrossingInterpolator interpolator(maker.path, machine);
  StepBatch batch;
  // the first level is at s = 0.125: all numbers are exact in binary
  interpolator.advance(motion(0, 0.0, 0.125, 125.0, 125.0), batch);
  CHECK(offsets(batch.axis[0]) == std::vector<int>{9999});
  interpolator.advance(motion(1, 0.125, 0.25, 125.0, 125.0), batch);
  CHECK(batch.axis[0].count() == 0);
}

TEST_CASE("ticks at rest give no pulses, no speed and the same position") {
  const auto machine = machine_with(2);
  PathMaker maker({1.0, 2.0});
  maker.line({2.0, 2.0});
  interpolator::CrossingInterpolator interpolator(maker.path, machine);
  StepBatch batch;
  for (int tick = 0; tick < 3; ++tick) {
    interpolator.advance(motion(tick, 0.0, 0.0, 0.0, 0.0), batch);
    CHECK(batch.tick.value == tick);
    CHECK(batch.axis[0].count() == 0);
    CHECK(batch.axis[0].command.position_begin_u == 1.0);
    CHECK(batch.axis[0].command.position_end_u == 1.0);
    CHECK(batch.axis[0].command.speed_end_u_s == 0.0);
  }
  CHECK(interpolator.position_steps() == std::vector<std::int64_t>{1000, 2000});
  // the path parameter may not run back, nor be no number
  CHECK_THROWS_AS(interpolator.advance(motion(3, 0.5, 0.4, 1.0, 1.0), batch), BrokenPromise);
  CHECK_THROWS_AS(interpolator.advance(motion(3, 0.0, std::nan(""), 1.0, 1.0), batch), BrokenPromise);
}

TEST_CASE("a path without segments answers every tick at rest") {
  const auto machine = machine_with(1);
  PathMaker maker({0.5});
  interpolator::CrossingInterpolator interpolator(maker.path, machine);
  StepBatch batch;
  interpolator.advance(motion(0, 0.0, 0.0, 0.0, 0.0), batch);
  CHECK(batch.axis[0].count() == 0);
  CHECK(interpolator.position_steps() == std::vector<std::int64_t>{500});
}

TEST_CASE(
    "there and back across the same half-step gives one pulse each way, also with the turn exactly on it") {
  const auto machine = machine_with(1, 0.25);
  for (const double turn : {0.125, 0.1875, 0.25, 0.3}) {
    PathMaker maker({0.0});
    maker.line({turn});
    maker.line({0.0});
    const Run run =
        run_path(maker.path, machine, drive(maker.path.length_u(), 100.0, machine, Feed::linear, 1));
    CHECK(run.pulses[0] == 2);
    CHECK(run.net[0] == 0);
  }
  // from half a step downwards the level is left at once; from there upwards it is not crossed
  PathMaker down({0.125});
  down.line({0.0});
  Run run = run_path(down.path, machine, drive(down.path.length_u(), 100.0, machine, Feed::linear, 1), true);
  CHECK(run.net[0] == -1);
  CHECK(offsets(run.batches[0].axis[0]) == std::vector<int>{0});
  PathMaker up({0.125});
  up.line({0.2});
  CHECK(run_path(up.path, machine, drive(up.path.length_u(), 100.0, machine, Feed::linear, 1)).pulses[0] ==
        0);
}

TEST_CASE("segment and joint are told: on a joint the ended segment, past it the next") {
  const auto machine = machine_with(2);
  PathMaker maker({0.0, 0.0});
  maker.line({1.0, 0.0});
  maker.line({1.0, 1.0});
  interpolator::CrossingInterpolator interpolator(maker.path, machine);
  StepBatch batch;
  interpolator.advance(motion(0, 0.0, 1.0, 1000.0, 1000.0), batch);
  CHECK(interpolator.segment() == 0);
  CHECK_FALSE(interpolator.passed_joint());
  CHECK(batch.axis[0].command.position_end_u == 1.0);
  CHECK(batch.axis[0].command.speed_end_u_s == 1000.0);
  interpolator.advance(motion(1, 1.0, 1.5, 1000.0, 0.0), batch);
  CHECK(interpolator.segment() == 1);
  CHECK_FALSE(interpolator.passed_joint());
  // the corner lies between the ticks: the new direction applies just after it
  CHECK(batch.axis[0].command.speed_begin_u_s == 0.0);
  CHECK(batch.axis[1].command.speed_begin_u_s == 1000.0);

  interpolator::CrossingInterpolator across(maker.path, machine);
  across.advance(motion(0, 0.0, 1.25, 1250.0, 1250.0), batch);
  CHECK(across.segment() == 1);
  CHECK(across.passed_joint());
  CHECK(batch.axis[0].count() == 1000);
  CHECK(batch.axis[1].count() == 250);
  CHECK(batch.axis[1].command.position_end_u == 0.25);
}

TEST_CASE("a stop 1e-10 mm before the path's end is the path's end") {
  const auto machine = machine_with(1, 0.25);
  PathMaker maker({0.0});
  maker.line({0.125});
  interpolator::CrossingInterpolator interpolator(maker.path, machine);
  StepBatch batch;
  interpolator.advance(motion(0, 0.0, 0.125 - 1e-10, 250.0, 0.0), batch);
  CHECK(batch.axis[0].count() == 1);
  CHECK(batch.axis[0].command.position_end_u == 0.125);
}

TEST_CASE("at constant feed every axis of a straight line pulses evenly, to one base tick") {
  Dice dice(environment_count("KADR_SEED", 3));
  for (int round = 0; round < 50; ++round) {
    const int axes = dice.whole(1, 9);
    const auto machine = machine_with(axes);
    PathMaker maker(std::vector<double>(static_cast<std::size_t>(axes), 0.0));
    std::vector<double> end(static_cast<std::size_t>(axes));
    for (double& x : end) x = dice.between(-1.0, 1.0);
    maker.line(end);
    const double length = maker.path.length_u(), speed = 10.0, tau_s = machine.clock.tau_s();
    std::vector<planner::TickMotion> motions;
    for (double s = 0; s < length; s = motions.back().s_end_u)
      motions.push_back(
          motion(static_cast<std::int64_t>(motions.size()), s, s + speed * tau_s, speed, speed));
    const Run run = run_path(maker.path, machine, motions, true);
    for (std::size_t k = 0; k < end.size(); ++k) {
      // base ticks from pulse to pulse
      const double spacing = 0.001 * length / std::fabs(end[k]) / speed * 1e7;
      std::vector<double> moments;
      for (const StepBatch& batch : run.batches)
        for (const int o : offsets(batch.axis[k]))
          moments.push_back(static_cast<double>(batch.tick.value) * 1e4 + o);
      REQUIRE(static_cast<std::int64_t>(moments.size()) == std::llabs(lattice_node(end[k], 0.001)));
      for (std::size_t i = 1; i < moments.size(); ++i)
        CHECK(std::fabs(moments[i] - moments[i - 1] - spacing) <= 1.0 + 1e-6);
    }
  }
}

TEST_CASE("a line of 100 million steps needs no table and counts exactly") {
  const auto machine = machine_with(2);
  PathMaker maker({-5e4, 3.0});
  maker.line({5e4, 3.00049});
  interpolator::CrossingInterpolator interpolator(maker.path, machine);
  StepBatch batch;
  std::int64_t net = 0;
  // 40 m/s: 40,000 steps per tick
  double s = 0;
  for (std::int64_t tick = 0; s < maker.path.length_u(); ++tick) {
    const double to = std::min(s + 40.0, maker.path.length_u());
    interpolator.advance(motion(tick, s, to, 40'000.0, 40'000.0), batch);
    net += batch.axis[0].net_steps().value;
    s = to;
  }
  CHECK(net == 100'000'000);
  CHECK(interpolator.position_steps() == std::vector<std::int64_t>{50'000'000, 3000});
}

TEST_CASE("the moment of a place solves the tick's linear feed to 1e-11 of its span") {
  Dice dice(environment_count("KADR_SEED", 5));
  for (int round = 0; round < 20'000; ++round) {
    planner::TickMotion m =
        motion(0, dice.between(0.0, 10.0), 0.0, dice.between(0.0, 100.0), dice.between(0.0, 100.0));
    if (dice.chance(0.2))
      m.ramp_begin_u_s = 0.0;
    else if (dice.chance(0.2))
      m.ramp_end_u_s = 0.0;
    else if (dice.chance(0.2))
      m.ramp_end_u_s = m.ramp_begin_u_s;
    m.move_begin_ticks = dice.between(0.0, 5000.0);
    m.move_end_ticks = dice.between(5000.0, 10'000.0);
    const long double span_s = (static_cast<long double>(m.move_end_ticks) - m.move_begin_ticks) / 1e7L;
    const long double way = 0.5L * (static_cast<long double>(m.ramp_begin_u_s) + m.ramp_end_u_s) * span_s;
    if (way <= 0) continue;
    m.s_begin_u = 0;
    m.s_end_u = static_cast<double>(way);
    const interpolator::TickClock clock(m, 10'000);
    CHECK(clock.moment_ticks(0.0) == m.move_begin_ticks);
    // before a stop the moment itself is only known to the root of the rounding of s: 1e-8 of the span
    CHECK(clock.moment_ticks(m.s_end_u) ==
          doctest::Approx(m.move_end_ticks).epsilon(m.ramp_end_u_s > 0.1 ? 1e-11 : 2e-8));
    // put the moment back into s(t)
    const long double ds = way * dice.between(0.0, 1.0);
    const long double t = (clock.moment_ticks(static_cast<double>(ds)) - m.move_begin_ticks) / 1e7L;
    const long double back =
        m.ramp_begin_u_s * t +
        (static_cast<long double>(m.ramp_end_u_s) - m.ramp_begin_u_s) * t * t / (2 * span_s);
    CHECK(std::fabs(static_cast<double>(back - ds)) <= 1e-11 * static_cast<double>(way));
  }
}
