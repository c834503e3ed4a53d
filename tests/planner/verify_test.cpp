#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <string>

#include "gcode/block.h"
#include "machine/machine.h"
#include "verified_plan.h"

// The judge itself: a sound plan passes, and each kind of damage is found by name.
namespace kadr::test {
namespace {

using planner::FeedPlan;
using planner::Path;

machine::MachineModel judge_machine() {
  auto m = plain_machine();
  m.path.centripetal_accel_mm_s2 = 1000.0;
  return m;
}

Path judged_path(const machine::MachineModel& machine) {
  ProgramWriter w(machine);
  w.line(xyz(40, 0), 100.0);
  w.line(xyz(40, 30), 100.0);
  w.arc(gcode::Plane::xy, 30.0, 30.0, 3, xyz(30, 40), 100.0);
  w.line(xyz(0, 40), 100.0);
  w.stop();
  w.line(xyz(0, 0, 20), 100.0);
  return w.take();
}

/// The plan run k times as fast.
FeedPlan faster(FeedPlan plan, double k) {
  for (auto& p : plan.law.pieces) {
    p.begin_s /= k;
    p.duration_s /= k;
    p.speed_u_s *= k;
    p.accel_u_s2 *= k * k;
    p.jerk_u_s3 *= k * k * k;
  }
  plan.law.duration_s /= k;
  for (auto& s : plan.segments) {
    s.begin_time_s /= k;
    s.end_time_s /= k;
    s.peak_u_s *= k;
    s.end_u_s *= k;
  }
  return plan;
}

struct Judged {
  machine::MachineModel machine = judge_machine();
  Path path = judged_path(machine);
  FeedPlan plan = *planner::plan(path, machine);
};

}  // namespace

TEST_CASE("a sound plan has no violation") {
  const Judged j;
  CHECK(planner::verify(j.path, j.plan, j.machine).empty());
}

TEST_CASE("1 % too fast breaks feed, junction, centripetal acceleration, jerk and whole ticks") {
  const Judged j;
  const FeedPlan fast = faster(j.plan, 1.01);
  for (const std::string what :
       {"programmed feed", "junction", "centripetal acceleration", "axis jerk", "whole ticks"})
    CHECK_MESSAGE(finds(j.path, fast, j.machine, what), std::string(what));
}

TEST_CASE("a thousandth of a per mille too fast is still found") {
  const Judged j;
  CHECK(finds(j.path, faster(j.plan, 1.0 + 1e-6), j.machine, "programmed feed"));
}

TEST_CASE("the same plan is refused by a machine with 10 % less jerk, acceleration, speed or corner") {
  const Judged j;
  const auto refused = [&](const std::function<void(machine::AxisModel&)>& less, const char* what) {
    auto m = j.machine;
    for (auto& axis : m.axis) less(axis);
    return finds(j.path, j.plan, m, what);
  };
  CHECK(refused([](auto& a) { a.max_jerk_u_s3 *= 0.9; }, "axis jerk"));
  CHECK(refused([](auto& a) { a.max_accel_u_s2 *= 0.9; }, "axis acceleration"));
  CHECK(refused([](auto& a) { a.max_feed_u_s *= 0.9; }, "axis speed"));
  CHECK(refused([](auto& a) { a.junction_accel_u_s2 *= 0.9; }, "junction"));
  auto m = j.machine;
  m.path.max_accel_mm_s2 = 500.0;
  CHECK(finds(j.path, j.plan, m, "path acceleration"));
  m.path.max_jerk_mm_s3 = 30000.0;
  CHECK(finds(j.path, j.plan, m, "path jerk"));
  m.path.max_feed_mm_s = 90.0;
  CHECK(finds(j.path, j.plan, m, "path feed"));
}

TEST_CASE("planning without the axis limits is caught where the path is steep for an axis") {
  auto machine = judge_machine();
  machine.path.max_accel_mm_s2 = 5000.0;
  machine.path.max_jerk_mm_s3 = 1e6;
  machine.planner.axis_limits = machine::AxisLimitRule::report;
  machine.axis[2].max_feed_u_s = 5.0;
  const Path path = judged_path(machine);
  const FeedPlan plan = *planner::plan(path, machine);
  CHECK(planner::verify(path, plan, machine).empty());
  machine.planner.axis_limits = machine::AxisLimitRule::enforce;
  for (const std::string what : {"axis speed", "axis acceleration", "axis jerk"})
    CHECK_MESSAGE(finds(path, plan, machine, what), std::string(what));
}

TEST_CASE("a corner passed as if it were not there is found") {
  const Judged j;
  auto blind = j.machine;
  for (auto& axis : blind.axis) axis.junction_accel_u_s2 = 1e9;
  const FeedPlan plan = *planner::plan(j.path, blind);
  CHECK(finds(j.path, plan, j.machine, "junction"));
  // the line runs tangentially into the circle of 10 mm at 100 mm/s: a step of 1000 mm/s2
  auto strict = j.machine;
  for (auto& axis : strict.axis) axis.junction_accel_u_s2 = 990.0;
  CHECK(finds(j.path, j.plan, strict, "curvature step"));
}

TEST_CASE("an arc driven with the full acceleration along the path breaks the axis by its normal part") {
  // the law of a straight line of the same length is legal along s: 2000 mm/s2 on its ramps. On a circle of 4
  // mm v^2/R = 1806 mm/s2 comes on top of it, at right angles.
  for (const bool jerk : {false, true}) {
    auto machine = jerk ? plain_machine() : trapezoid_machine();
    machine.planner.whole_ticks = false;
    ProgramWriter circle(machine, xyz(4, 0)), line(machine);
    circle.arc(gcode::Plane::xy, 0.0, 0.0, 4, xyz(4, 0), 85.0);
    const Path round = circle.take();
    line.line(xyz(round.length_u()), 85.0);
    const FeedPlan plan = *planner::plan(line.take(), machine);
    CHECK(finds(round, plan, machine, jerk ? "axis jerk" : "axis acceleration"));
  }
}

TEST_CASE("missing path, missing pieces, gaps and jumps are found by name") {
  const Judged j;
  auto damaged = [&](const std::function<void(FeedPlan&)>& damage, const char* what) {
    FeedPlan plan = j.plan;
    damage(plan);
    CHECK_MESSAGE(finds(j.path, plan, j.machine, what), std::string(what));
  };
  damaged([](FeedPlan& p) { p.law.pieces.pop_back(); }, "length");
  damaged([](FeedPlan& p) { p.law.pieces.pop_back(); }, "rest at the end");
  damaged([](FeedPlan& p) { p.law.pieces.erase(p.law.pieces.begin() + 2); }, "gap in time");
  damaged([](FeedPlan& p) { p.law.pieces[2].s_u += 1e-6; }, "continuity of s");
  damaged([](FeedPlan& p) { p.law.pieces[2].speed_u_s += 1e-4; }, "continuity of speed");
  damaged([](FeedPlan& p) { p.law.pieces[1].accel_u_s2 += 1.0; }, "continuity of acceleration");
  damaged([](FeedPlan& p) { p.law.pieces.front().speed_u_s = 1.0; }, "rest at the start");
  damaged([](FeedPlan& p) { p.law.pieces.clear(); }, "path without law");
  damaged([](FeedPlan& p) { p.law.duration_s += 1e-6; }, "duration");
  damaged([](FeedPlan& p) { p.segments.pop_back(); }, "table size");
  damaged([](FeedPlan& p) { p.segments[1].end_time_s += 1e-4; }, "table place");
  damaged([](FeedPlan& p) { p.segments[1].end_u_s += 0.1; }, "table speed");
  damaged([](FeedPlan& p) { p.segments[1].peak_u_s = 0.0; }, "table peak");
  damaged([](FeedPlan& p) { p.law.pieces[1].speed_u_s = std::nan(""); }, "continuity of speed");
}

TEST_CASE("a stop that is passed without rest is found") {
  const Judged j;
  Path without = j.path;
  for (auto& seg : without.segments) seg.stop_at_end = false;
  auto blind = j.machine;
  for (auto& axis : blind.axis) axis.junction_accel_u_s2 = 1e9;
  const FeedPlan plan = *planner::plan(without, blind);
  CHECK(finds(j.path, plan, blind, "rest at a stop"));
}

TEST_CASE("no more violations are listed than asked for") {
  const Judged j;
  planner::VerifyOptions options;
  options.most = 3;
  CHECK(planner::verify(j.path, faster(j.plan, 2.0), j.machine, options).size() == 3);
}

}  // namespace kadr::test
