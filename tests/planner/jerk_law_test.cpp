#include <doctest/doctest.h>
#include <fmt/format.h>

#include "gcode/block.h"
#include "machine/machine.h"
#include "planner/time_law/jerk_motion.h"
#include "planner/time_law/jerk_plan.h"
#include "verified_plan.h"

namespace kadr::test {

using machine::PlanMethod;
using planner::IntervalMotion;
using planner::JerkPiece;

namespace {

/// Two long lines that meet under a small angle, then a half circle.
planner::Path bend(const machine::MachineModel& machine) {
  ProgramWriter w(machine);
  w.line(xyz(40), 100.0);
  w.line(xyz(80, 1), 100.0);
  w.arc(gcode::Plane::xy, 80, 16, 1, xyz(80, 31), 100.0);
  return w.take();
}

double jerk_factor(const machine::MachineModel& machine) {
  const planner::Path path = bend(machine);
  const auto table = planner::limit_table(path, machine);
  REQUIRE(table);
  std::vector<JerkPiece> pieces;
  const auto k = planner::plan_jerk_law({planner::DirectJoints(path), *table, machine}, {0, 2}, pieces);
  REQUIRE(k);
  return *k;
}

}  // namespace

TEST_CASE("random programs on random machines under the jerk-limited law break no limit, jerk included") {
  const std::uint64_t seed = environment("KADR_SEED", 1);
  const std::uint64_t count = environment("KADR_COUNT", 20);
  for (std::uint64_t i = 0; i < count; ++i) {
    Random random(seed + i);
    machine::MachineModel machine = random_machine(random);
    AxisValues end{};
    const planner::Path path = random_path(random, machine, end);
    machine.planner.method = PlanMethod::jerk_limited;
    machine.planner.node_mm = random.decades(0.2, 5.0);
    CAPTURE(seed + i);
    const auto plan = planner::plan(path, machine);
    CHECK_MESSAGE(plan.has_value(), plan.error().diagnostic.label);
    if (!plan) continue;
    for (const planner::Violation& v : planner::verify(path, *plan, machine))
      FAIL_CHECK(fmt::format("{} at {} s, segment {}, axis {}: {} (limit {})", v.what, v.time_s, v.segment,
                             v.axis, v.value, v.limit));
  }
}

TEST_CASE("an interval of constant jerk from rest is found again: s = j t^3/6, v = j t^2/2, a = j t") {
  // j = 6000 over 0.1 s: 1 mm, 30 mm/s, 600 mm/s2; then 0.1 s more: 8 mm, 120 mm/s, 1200 mm/s2. With the node
  // in between given its own acceleration the middle of an interval lies on the line: j t/2.
  const double s[] = {1, 7};
  const double v[] = {0, 30, 120}, a[] = {0, 600, 1200};
  for (int i = 0; i < 2; ++i) {
    const IntervalMotion m = planner::interval_motion(s[i], v[i], v[i + 1], a[i], a[i + 1]);
    CHECK(m.time_s == near(0.1));
    CHECK(m.first_jerk_u_s3() == near(6000.0));
    CHECK(m.second_jerk_u_s3() == near(6000.0));
    CHECK(m.middle_u_s() == near(v[i] + 0.05 * a[i] + 6000.0 * 0.05 * 0.05 / 2));
  }
}

TEST_CASE(
    "a motion is exact at its nodes: path, speed and acceleration of every interval go on in the next") {
  Random random(7);
  const std::size_t n = 30;
  std::vector<double> s(n, 0.0), v(n, 0.0);
  for (std::size_t i = 1; i < n; ++i) s[i] = s[i - 1] + random.between(0.2, 1.5);
  for (std::size_t i = 1; i + 1 < n; ++i) v[i] = random.decades(0.1, 50.0);
  const std::vector<planner::IntervalLimits> limits(n, {1e3, 1e6, 1e9});
  const std::vector<double> jerk(n, 1e9);
  const auto motion = planner::jerk_motion(s, v, limits, {jerk, jerk});
  CHECK(motion[1].a0_u_s2 == 0.0);
  CHECK(motion[n - 1].a1_u_s2 == 0.0);
  for (std::size_t i = 1; i < n; ++i) {
    const IntervalMotion& m = motion[i];
    CHECK(m.lowest_u_s() >= 0.0);
    if (i > 1) CHECK(m.a0_u_s2 == motion[i - 1].a1_u_s2);
    std::vector<JerkPiece> pieces;
    planner::add_pieces(m, s[i - 1], planner::LimitedBy::length, -1, pieces);
    const JerkPiece& last = pieces.back();
    CHECK(last.s_u + last.way_u(last.duration_s) == near(s[i]));
    CHECK(last.speed_after_u_s(last.duration_s) == doctest::Approx(v[i]).epsilon(1e-9).scale(1e-6));
    CHECK(last.state_after(last.duration_s).accel_u_s2 ==
          doctest::Approx(m.a1_u_s2).epsilon(1e-9).scale(1.0));
  }
}

TEST_CASE("on one line the jerk-limited law is the jerk-limited ramp but for half a per cent") {
  // the ramp of the scheduler: 1.1 s (jerk_limited_test.cpp); no law that keeps the limits is faster
  machine::MachineModel machine = plain_machine();
  machine.planner.whole_ticks = false;
  machine.planner.method = PlanMethod::jerk_limited;
  ProgramWriter w(machine);
  w.line(xyz(100), 100.0);
  const auto plan = planned(w.take(), machine);
  CHECK(plan.law.duration_s > 1.1);
  CHECK(plan.law.duration_s < 1.1 * 1.005);
}

TEST_CASE("what is left above a limit after the rounds costs less than half a per cent of the time") {
  machine::MachineModel machine = plain_machine();
  machine.planner.method = PlanMethod::jerk_limited;
  const double k = jerk_factor(machine);
  CHECK(k >= 1.0);
  CHECK(k < 1.005);
}

TEST_CASE("the certified law breaks the jerk that the jerk-limited law keeps, and verify() sees it") {
  machine::MachineModel machine = plain_machine();
  machine.planner.method = PlanMethod::certified;
  const planner::Path path = bend(machine);
  const auto certified = planned(path, machine);  // its own limits it keeps
  machine.planner.method = PlanMethod::jerk_limited;
  const auto limited = planned(path, machine);
  CHECK(finds(path, certified, machine, "continuity of acceleration"));
  CHECK(limited.law.duration_s > certified.law.duration_s);
  // and a law that is run 1 % faster is seen to break it too
  planner::FeedPlan fast = limited;
  for (JerkPiece& p : fast.law.pieces) p.jerk_u_s3 *= 1.01;
  CHECK(finds(path, fast, machine, "axis jerk"));
}

TEST_CASE("without a jerk limit the jerk-limited law is the certified one") {
  machine::MachineModel machine = trapezoid_machine();
  machine.planner.method = PlanMethod::jerk_limited;
  const planner::Path path = bend(machine);
  const auto limited = planned(path, machine);
  machine.planner.method = PlanMethod::certified;
  CHECK(limited.law.duration_s == planned(path, machine).law.duration_s);
}

TEST_CASE("a run too short for its limits, a dwell and a technology point keep the jerk too") {
  machine::MachineModel machine = plain_machine();
  machine.planner.method = PlanMethod::jerk_limited;
  planner::PathBuilder builder(machine, {});
  double x = 0;
  for (const double step : {0.001, 0.05, 30.0, 30.0}) {
    gcode::Feed block;
    block.feed_u_s = 100.0;
    block.length_u = step;
    block.end = xyz(x += step);
    if (step == 30.0) builder.limit_speed(15.0);
    builder.add({{}, block});
    if (step < 1.0) builder.stop();
  }
  const planner::Path path = builder.take();
  const auto plan = planned(path, machine);
  CHECK(plan.segments[2].end_u_s <= 15.0 * (1.0 + 1e-12));
  // 1 um: t = 4 (s/(2 j))^(1/3) = 0.0093 s, ten control ticks
  CHECK(plan.segments[0].end_time_s >= 0.0093);
  CHECK(plan.segments[0].end_time_s <= 0.0101);
}

}  // namespace kadr::test
