#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "emulator/answers/answers.h"
#include "emulator/cycle/cycle.h"
#include "machine/base/numbers.h"
#include "tests/support/run_program.h"
#include "tests/support/test_machine.h"

using namespace kadr;
using namespace kadr::test;

TEST_CASE("a line of 100 mm at 100 mm/s takes 1100 control ticks and 50000 pulses") {
  // ramp 0 -> 100 mm/s with a 2000, j 40000: 0.1 s and 5 mm; 90 mm at 100 mm/s: 0.9 s; ramp down 0.1 s
  RunResult r;
  run_program(r, "G1 X100 F6000\nM2\n", test_machine(1));
  CHECK(r.summary.outcome == log::Outcome::complete);
  CHECK(r.summary.control_ticks.value == 1100);
  CHECK(r.summary.axis[0].pulses == 50000);
  CHECK(r.summary.axis[0].end_steps == Steps{50000});
  CHECK(r.summary.axis[0].end_u == 100.0);
  CHECK(r.summary.peak_feed_u_s == doctest::Approx(100.0).epsilon(1e-12));
  CHECK(r.summary.axis[0].peak_accel_u_s2 <= 2000.0 * (1 + 1e-6));
  CHECK(r.summary.alarms == 0);
  CHECK(r.log.ended);
}

TEST_CASE("a dwell of half a second holds the machine for exactly 500 control ticks") {
  RunResult with, without;
  run_program(without, "G1 X10 F6000\nX20 F3000\nM2\n", test_machine(1));
  run_program(with, "G61.1\nG1 X10 F6000\nG4 P0.5\nX20 F3000\nM2\n", test_machine(1));
  RunResult stop;
  run_program(stop, "G61.1\nG1 X10 F6000\nX20 F3000\nM2\n", test_machine(1));
  CHECK(with.summary.control_ticks.value == stop.summary.control_ticks.value + 500);
  CHECK(without.summary.control_ticks.value < stop.summary.control_ticks.value);
  const auto dwells = with.log.of_kind("dwell");
  REQUIRE(dwells.size() == 1);
  CHECK(dwells[0].value == 0.5);
  CHECK(dwells[0].span.line == 3);
  // the motion stands still over the whole dwell, and the step pulses are those of the program without it
  const std::int64_t begin = dwells[0].tick.value / 10'000;
  for (std::int64_t k = begin; k < begin + 500; ++k)
    CHECK(with.log.ticks[static_cast<std::size_t>(k)].batch.axis[0].count() == 0);
  CHECK(with.summary.pulses == stop.summary.pulses);
}

TEST_CASE("events come in tick order, between the motions they stand between") {
  RunResult r;
  run_program(r, "T1 M6\nS1000 M3\nG1 X10 F6000\nM8\nX20\nG4 P0.1\nM5\nM9\n(MSG, done)\nM30\n",
              test_machine(1));
  CHECK(std::is_sorted(r.log.order.begin(), r.log.order.end()));
  const auto spindle = r.log.of_kind("spindle");
  REQUIRE(spindle.size() >= 2);
  CHECK(spindle.front().tick.value == 0);
  CHECK(spindle.back().text == "spindle stop");
  // M5 comes after the dwell of 0.1 s = 1,000,000 base ticks
  const auto dwell = r.log.of_kind("dwell");
  REQUIRE(dwell.size() == 1);
  CHECK(spindle.back().tick.value == dwell[0].tick.value + 1'000'000);
  REQUIRE(r.log.of_kind("message").size() == 1);
  CHECK(r.log.of_kind("message")[0].text == "done");
  REQUIRE(!r.log.of_kind("stop").empty());
  CHECK(r.log.of_kind("stop").back().text == "program end");
  REQUIRE(r.log.blocks.size() == 2);
  CHECK(r.log.blocks[0].span.line == 3);
  CHECK(r.log.blocks[1].text == "X20");
}

TEST_CASE("a program without motion takes its dwell time") {
  RunResult r;
  run_program(r, "S500 M3\nG4 P1.25\nM5\nM2\n", test_machine(1));
  CHECK(r.summary.control_ticks.value == 1250);
  CHECK(r.summary.pulses == 0);
  CHECK(r.log.events.back().text == "program end");
}

namespace {
/// Step sequence block by block: axis numbers in order of the pulses, signs included, joints from the block records.
std::vector<int> sequence_of_axis(const RunResult& r, std::size_t axis) {
  std::vector<int> list;
  for (const auto& t : r.log.ticks)
    t.batch.axis[axis].for_each([&](std::uint16_t, int sign) { list.push_back(sign); });
  return list;
}
}  // namespace

TEST_CASE("the same program at half the feed gives the same steps, only later") {
  RunResult full, half;
  run_program(full, "G1 X10 Y3 F3000\nG2 X20 Y3 I5 J0\nG3 X5 Y1 Z2 R12\nG1 X0 Y0 Z0\nM2\n", test_machine());
  run_program(half, "G1 X10 Y3 F1500\nG2 X20 Y3 I5 J0\nG3 X5 Y1 Z2 R12\nG1 X0 Y0 Z0\nM2\n", test_machine());
  for (std::size_t a = 0; a < 3; ++a) CHECK(sequence_of_axis(full, a) == sequence_of_axis(half, a));
  CHECK(full.summary.pulses == half.summary.pulses);
  CHECK(full.summary.steps_hash != half.summary.steps_hash);
  CHECK(half.summary.control_ticks.value > full.summary.control_ticks.value * 3 / 2);
}

TEST_CASE("an overrun that the end of a run leaves open has its code in both events") {
  machine::MachineModel m = test_machine(1);
  m.axis[0].soft_max_u = 50;
  RunResult r;
  run_program(r, "G1 X60 F6000\nM2\n", m);
  const auto begins = r.log.of_kind("alarm"), ends = r.log.of_kind("alarm end");
  REQUIRE(begins.size() == 1);
  REQUIRE(ends.size() == 1);
  CHECK(begins[0].code == Code::soft_limit_overrun);
  CHECK(ends[0].code == Code::soft_limit_overrun);
  CHECK(ends[0].text == "axis X was still over its limit at the end, at most 60, allowed 50");
}

TEST_CASE("leaving a soft limit is a warning before the run and one alarm at the tick where it happens") {
  machine::MachineModel m = test_machine(1);
  m.axis[0].soft_min_u = -5;
  m.axis[0].soft_max_u = 50;
  RunResult r;
  run_program(r, "G1 X60 F6000\nX0\nM2\n", m);
  CHECK(r.diagnostics.warnings() == 1);
  CHECK(r.summary.alarms == 1);
  const auto alarms = r.log.of_kind("alarm");
  REQUIRE(alarms.size() == 1);
  CHECK(alarms[0].code == Code::soft_limit_overrun);
  CHECK(alarms[0].span.line == 1);
  CHECK(alarms[0].limit == 50.0);
  CHECK(alarms[0].value > 50.0);
  CHECK(alarms[0].value < 50.2);  // within one control tick at 100 mm/s of the crossing
  const auto ends = r.log.of_kind("alarm end");
  REQUIRE(ends.size() == 1);
  CHECK(ends[0].value == doctest::Approx(60.0));
  // the same program is refused by a check
  TestInputs in = make_inputs("G1 X60 F6000\nX0\nM2\n", m);
  Diagnostics diagnostics;
  in.prepare(diagnostics, cycle::SoftLimitRule::error);
  REQUIRE(diagnostics.errors() == 1);
  CHECK(diagnostics.list()[0].label == "X reaches 60.000 mm, 10.000 mm beyond the limit");
}

TEST_CASE("a controller that does not know the axis limits breaks them, and the monitor sees it") {
  machine::MachineModel m = test_machine(1);
  m.axis[0].max_feed_u_s = 80;
  m.axis[0].max_accel_u_s2 = 1000;
  m.axis[0].max_jerk_u_s3 = 20000;
  RunResult kept;
  run_program(kept, "G1 X100 F6000\nM2\n", m);
  CHECK(kept.summary.alarms == 0);
  CHECK(kept.summary.peak_feed_u_s == doctest::Approx(80.0));

  m.planner.axis_limits = machine::AxisLimitRule::report;
  RunResult broken;
  run_program(broken, "G1 X100 F6000\nM2\n", m);
  bool speed = false, acceleration = false, jerk = false;
  for (const auto& e : broken.log.of_kind("alarm")) {
    speed |= e.code == Code::speed_overrun;
    acceleration |= e.code == Code::acceleration_overrun;
    jerk |= e.code == Code::jerk_overrun;
    CHECK(e.value > e.limit);
    CHECK(e.span.line == 1);
  }
  CHECK(speed);
  CHECK(acceleration);
  CHECK(jerk);
}

TEST_CASE("an alarm ends the run where the machine file says so") {
  machine::MachineModel m = test_machine(1);
  m.axis[0].soft_max_u = 50;
  m.on_alarm = machine::OnAlarm::stop;
  RunResult r;
  run_program(r, "G1 X60 F6000\nX0\nM2\n", m);
  CHECK(r.summary.outcome == log::Outcome::alarm);
  CHECK(r.summary.axis[0].end_u < 50.2);
  CHECK(r.log.ended);
}

TEST_CASE("residual vibration of a rectangular law on a rigid base is the closed form of paper 001") {
  // 3.5 m at 1 m/s2 without a speed limit in reach: ta = tf/2 = sqrt(3.5) s; zeta = 0, w = 100 pi/3:
  //   X = (4 A/w^2) |sin(w ta/2) sin(w (tf-ta)/2)| = (4 A/w^2) sin^2(w ta/2)
  machine::MachineModel m = test_machine(1);
  machine::AxisModel& x = m.axis[0];
  x.step_u = 0.01;
  x.max_feed_u_s = 3000;
  x.max_accel_u_s2 = 1000;
  x.max_jerk_u_s3 = machine::kInfinity;
  x.plant.motor = machine::MotorModel::rigid;
  x.plant.link_damping_Ns_per_m = 0;
  m.path = machine::PathLimits{};
  m.planner.whole_ticks = false;
  RunResult r;
  run_program(r, "G0 X3500\nG4 P0.2\nM2\n", m);
  const double w = 100 * kPi / 3, ta = std::sqrt(3.5);
  const double expected_mm = 1000 * 4 / (w * w) * std::pow(std::sin(w * ta / 2), 2);
  const auto residual = r.log.of_kind("residual");
  REQUIRE(residual.size() == 1);
  // inside a tick the feed runs linearly: the switch of acceleration is smeared over at most one tick
  CHECK(residual[0].value == doctest::Approx(expected_mm).epsilon(2e-3));
  CHECK(r.summary.axis[0].residual_u == residual[0].value);
}

TEST_CASE("a signal ends the run after the control tick with outcome interrupted") {
  std::atomic<bool> interrupt{false};
  cycle::RunOptions options;
  options.interrupt = &interrupt;
  options.progress = [&](double, std::uint32_t, double) { interrupt = true; };
  RunResult r;
  run_program(r, "G1 X500 F6000\nM2\n", test_machine(1), options);
  CHECK(r.summary.outcome == log::Outcome::interrupted);
  CHECK(r.summary.control_ticks.value == 1000);
  CHECK(r.log.ended);
}

TEST_CASE("a held feed costs a quarter of an acceleration tick along the path, and says so") {
  // constant feed over a tick against a feed that changes by a tau: the distance is at most a tau^2 / 8 = 0.25 um
  machine::MachineModel m = test_machine(1);
  RunResult linear, held;
  run_program(linear, "G1 X100 F6000\nM2\n", m);
  m.planner.tick_feed = machine::TickFeed::constant;
  run_program(held, "G1 X100 F6000\nM2\n", m);
  CHECK(linear.summary.held_error_u == 0.0);
  CHECK(held.summary.held_error_u > 0.2e-3);
  CHECK(held.summary.held_error_u <= 0.251e-3);
  CHECK(held.summary.pulses == linear.summary.pulses);
}

TEST_CASE("random programs under enforced limits raise no alarm and end on the exact step") {
  const char* seed_text = std::getenv("KADR_SEED");
  const char* count_text = std::getenv("KADR_COUNT");
  const unsigned seed = seed_text ? static_cast<unsigned>(std::atoi(seed_text)) : 1u;
  const int count = count_text ? std::atoi(count_text) : 40;
  for (int n = 0; n < count; ++n) {
    std::mt19937 random(seed + static_cast<unsigned>(n));
    const auto below = [&](unsigned limit) { return static_cast<int>(random() % limit); };
    std::string program = "G17 G21 G90 G94\n";
    double x = 0, y = 0, z = 0;
    for (int line = 0; line < 20; ++line) {
      const int feed = 60 * (1 + below(120));
      switch (below(4)) {
        case 0:
          x = (below(200000) - 100000) / 1000.0;
          y = (below(200000) - 100000) / 1000.0;
          program += fmt::format("G1 X{:.3f} Y{:.3f} F{}\n", x, y, feed);
          break;
        case 1:
          z = below(20000) / 1000.0;
          program += fmt::format("G0 Z{:.3f}\n", z);
          break;
        case 2: {
          // quarter circle from the present point
          const double radius = (1 + below(20000)) / 1000.0;
          program +=
              fmt::format("G3 X{:.4f} Y{:.4f} I{:.4f} J0 F{}\n", x - radius, y + radius, -radius, feed);
          x -= radius;
          y += radius;
          break;
        }
        default:
          for (int i = 0; i < 5; ++i) {
            x += (below(2000) - 1000) / 5000.0;
            y += (below(2000) - 1000) / 5000.0;
            program += fmt::format("G1 X{:.3f} Y{:.3f} F{}\n", x, y, feed);
          }
      }
    }
    program += "M2\n";
    CAPTURE(seed + static_cast<unsigned>(n));
    CAPTURE(program);
    RunResult r;
    cycle::RunOptions options;
    options.plant = n % 8 == 0;
    run_program(r, program, test_machine(), options);
    for (const auto& e : r.log.of_kind("alarm")) CAPTURE(e.text);
    CHECK(r.summary.alarms == 0);
    const auto last = r.job->read.path.node(r.job->read.path.size());
    for (std::size_t a = 0; a < 3; ++a)
      CHECK(r.summary.axis[a].end_steps.value ==
            static_cast<std::int64_t>(std::floor(last[a] / 0.002 + 0.5)));
  }
}

TEST_CASE("a motor too weak for its load is one alarm, and its end tells all steps lost") {
  // 5.5 kg at 2 m/s2 need 11 N; 5 N of holding force fall behind by electrical periods of 0.4 mm = 200 steps
  machine::MachineModel m = test_machine(1);
  m.axis[0].plant.motor = machine::MotorModel::stepper;
  m.axis[0].plant.holding_force_N = 5;
  m.axis[0].plant.motor_damping_Ns_per_m = 1;
  RunResult r;
  run_program(r, "G1 X50 F6000\nG4 P0.5\nM2\n", m);
  const auto alarms = r.log.of_kind("alarm");
  const auto ends = r.log.of_kind("alarm end");
  REQUIRE(alarms.size() >= 1);
  CHECK(alarms.size() == ends.size());
  CHECK(r.summary.alarms == alarms.size());
  CHECK(alarms.size() <= 3);
  double lost = 0;
  for (const auto& e : ends) lost += e.value;
  CHECK(static_cast<std::int64_t>(lost) == r.summary.axis[0].lost_steps.value);
  CHECK(r.summary.axis[0].lost_steps.value % 200 == 0);
  CHECK(r.summary.axis[0].lost_steps.value < 0);
  // the same motor with enough force keeps every step
  m.axis[0].plant.holding_force_N = 200;
  RunResult strong;
  run_program(strong, "G1 X50 F6000\nG4 P0.5\nM2\n", m);
  CHECK(strong.summary.alarms == 0);
  CHECK(strong.summary.axis[0].lost_steps.value == 0);
}

TEST_CASE("a run that ends early has gone only the path it has gone") {
  // after 0.6 s: 5 mm of ramp and 0.5 s at 100 mm/s
  cycle::RunOptions options;
  options.until_s = 0.6;
  RunResult r;
  run_program(r, "G1 X100 F6000\nM2\n", test_machine(1), options);
  CHECK(r.summary.path_u == doctest::Approx(55.0).epsilon(1e-9));
  CHECK(r.summary.axis[0].end_u == doctest::Approx(55.0).epsilon(1e-9));
}
