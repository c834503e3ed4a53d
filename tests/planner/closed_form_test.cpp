#include <doctest/doctest.h>

#include "gcode/block.h"
#include "machine/machine.h"
#include "verified_plan.h"

// Trapezoidal motion (jerk = inf, whole ticks off) against its closed forms, to 0.05 % and mostly far better.
namespace kadr::test {
TEST_CASE("a line of 100 mm at 100 mm/s with 2000 mm/s2 takes 100/100 + 100/2000 = 1.05 s") {
  const auto machine = trapezoid_machine();
  ProgramWriter w(machine);
  w.line(xyz(100), 100.0);
  const auto path = w.take();
  const auto plan = planned(path, machine);
  CHECK(plan.law.duration_s == near(1.05));
  CHECK(plan.segments[0].peak_u_s == 100.0);
  CHECK(plan.segments[0].limited_by == planner::LimitedBy::program);
}

TEST_CASE("a line of 1 mm never reaches 100 mm/s: it takes 2 sqrt(1/2000) s and peaks at sqrt(2000) mm/s") {
  const auto machine = trapezoid_machine();
  ProgramWriter w(machine);
  w.line(xyz(1), 100.0);
  const auto path = w.take();
  const auto plan = planned(path, machine);
  CHECK(plan.law.duration_s == near(2.0 * std::sqrt(1.0 / 2000.0)));
  CHECK(plan.segments[0].peak_u_s == near(std::sqrt(2000.0)));
  CHECK(plan.segments[0].limited_by == planner::LimitedBy::length);
}

TEST_CASE("a square of 40 mm with full stops takes four times 40/50 + 50/2000 s") {
  const auto machine = trapezoid_machine();
  ProgramWriter w(machine);
  w.mode = gcode::PathMode::exact_stop;
  for (const auto& p : {xyz(40, 0), xyz(40, 40), xyz(0, 40), xyz(0, 0)}) w.line(p, 50.0);
  const auto path = w.take();
  const auto plan = planned(path, machine);
  const double side = 40.0 / 50.0 + 50.0 / 2000.0;
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(plan.segments[i].end_time_s - plan.segments[i].begin_time_s == near(side));
    CHECK(plan.segments[i].end_u_s == 0.0);
  }
  CHECK(plan.law.duration_s == near(4.0 * side));
}

TEST_CASE("a diagonal of 30 40 runs at the slower axis' limits: 60/0.8 mm/s and 1000/0.8 mm/s2") {
  auto machine = trapezoid_machine();
  machine.axis[1].max_feed_u_s = 60.0;
  machine.axis[1].max_accel_u_s2 = 1000.0;
  ProgramWriter w(machine);
  w.line(xyz(30, 40), 100.0);
  const auto path = w.take();
  const auto plan = planned(path, machine);
  CHECK(plan.law.duration_s == near(50.0 / 75.0 + 75.0 / 1250.0));
  CHECK(plan.segments[0].limited_by == planner::LimitedBy::axis_speed);
  CHECK(plan.segments[0].limiting_axis == 1);
}

TEST_CASE("a rapid runs at the axis that needs longest, whatever the path's largest feed") {
  auto machine = trapezoid_machine();
  machine.path.max_feed_mm_s = 20.0;
  ProgramWriter w(machine);
  w.rapid(xyz(30, 40));
  const auto path = w.take();
  const auto plan = planned(path, machine);
  CHECK(plan.segments[0].peak_u_s == near(110.0 / 0.8));
  CHECK(plan.segments[0].limited_by == planner::LimitedBy::rapid);
}

TEST_CASE("a full circle runs exactly at sqrt(a_n R) = sqrt(1000 * 10) = 100 mm/s") {
  auto machine = trapezoid_machine();
  machine.path.centripetal_accel_mm_s2 = 1000.0;
  for (auto& axis : machine.axis) axis.max_feed_u_s = 500.0;
  ProgramWriter w(machine, xyz(10, 0));
  w.arc(gcode::Plane::xy, 0.0, 0.0, 10, xyz(10, 0), 400.0);
  const auto path = w.take();
  const auto plan = planned(path, machine);
  CHECK(plan.segments[0].peak_u_s == near(100.0));
  CHECK(plan.segments[0].limited_by == planner::LimitedBy::centripetal);
  // on the way a_t = sqrt(2000^2 - 1000^2): T = L/v + v/a_t
  const double length = 200.0 * kPi;
  CHECK(plan.law.duration_s == near(length / 100.0 + 100.0 / std::sqrt(3e6)));
}

TEST_CASE("a centripetal limit of 90 % of the axis' acceleration is met exactly too") {
  auto machine = trapezoid_machine();
  machine.path.centripetal_accel_mm_s2 = 1800.0;
  ProgramWriter w(machine, xyz(2, 0));
  w.arc(gcode::Plane::xy, 0.0, 0.0, 5, xyz(2, 0), 400.0);
  const auto path = w.take();
  CHECK(planned(path, machine).segments[0].peak_u_s == near(60.0));
}

TEST_CASE("without a centripetal limit an arc takes 80 % of the axis' acceleration for turning") {
  const auto machine = trapezoid_machine();
  ProgramWriter w(machine, xyz(2, 0));
  w.arc(gcode::Plane::xy, 0.0, 0.0, 5, xyz(2, 0), 400.0);
  const auto path = w.take();
  const auto plan = planned(path, machine);
  CHECK(plan.segments[0].peak_u_s == near(std::sqrt(0.8 * 2000.0 * 2.0)));
  CHECK(plan.segments[0].limiting_axis >= 0);
}

TEST_CASE("a helix runs faster than its circle by the ratio of their lengths") {
  auto machine = trapezoid_machine();
  machine.path.centripetal_accel_mm_s2 = 500.0;
  ProgramWriter w(machine, xyz(5, 0));
  w.arc(gcode::Plane::xy, 0.0, 0.0, 2, xyz(5, 0, 30), 400.0);
  const auto path = w.take();
  const double circles = 20.0 * kPi;
  const double ratio = std::sqrt(circles * circles + 900.0) / circles;
  CHECK(planned(path, machine).segments[0].peak_u_s == near(std::sqrt(500.0 * 5.0) * ratio));
}

TEST_CASE("a right-angled corner is passed at 2 mm/s where an axis may jump by 2000 mm/s2 over 1 ms") {
  const auto machine = trapezoid_machine();
  ProgramWriter w(machine);
  w.line(xyz(50, 0), 100.0);
  w.line(xyz(50, 50), 100.0);
  const auto path = w.take();
  const auto plan = planned(path, machine);
  CHECK(plan.segments[0].end_u_s == near(2.0));
  // per side 0 -> 100 -> 2: 100/2000 + 98/2000 s of ramps over (100^2 + 100^2 - 2^2)/4000 mm
  const double ramps_mm = (2e4 - 4.0) / 4000.0;
  CHECK(plan.law.duration_s == near(2.0 * ((50.0 - ramps_mm) / 100.0 + 198.0 / 2000.0)));
}

TEST_CASE("a corner of 45 degrees is limited by the axis that changes most") {
  // (1, 0) -> (cos 45, sin 45): X changes by 0.2929, Y by 0.7071, so v = 2 / 0.7071
  const auto machine = trapezoid_machine();
  ProgramWriter w(machine);
  w.line(xyz(50, 0), 100.0);
  w.line(xyz(80, 30), 100.0);
  const auto path = w.take();
  CHECK(planned(path, machine).segments[0].end_u_s == near(2.0 / std::sqrt(0.5)));
}

TEST_CASE("a line into an arc of radius 2 is passed at sqrt(2000 * 2) mm/s by the curvature rule") {
  auto machine = trapezoid_machine();
  for (auto& axis : machine.axis) axis.max_accel_u_s2 = 20000.0;
  ProgramWriter w(machine);
  w.line(xyz(30, 0), 100.0);
  w.arc(gcode::Plane::xy, 30.0, 2.0, 1, xyz(32, 2), 100.0);
  w.line(xyz(32, 40), 100.0);
  const auto path = w.take();
  const auto plan = planned(path, machine);
  CHECK(plan.segments[0].end_u_s == near(std::sqrt(4000.0)));
  CHECK(plan.segments[1].end_u_s == near(std::sqrt(4000.0)));
}

TEST_CASE("an infinite jerk limit gives the best trapezoids over segments of different acceleration") {
  // 0.5 mm along X, 0.5 mm along the diagonal (a = 2000 sqrt 2), corner allowed at any speed: v^2 adds up
  auto machine = trapezoid_machine();
  for (auto& axis : machine.axis) axis.junction_accel_u_s2 = 1e9;
  ProgramWriter w(machine);
  w.line(xyz(0.5, 0), 100.0);
  w.line(xyz(0.5 + std::sqrt(0.125), std::sqrt(0.125)), 100.0);
  w.line(xyz(60.5, std::sqrt(0.125)), 100.0);
  const auto path = w.take();
  const auto plan = planned(path, machine);
  const double first = std::sqrt(2.0 * 2000.0 * 0.5);
  CHECK(plan.segments[0].end_u_s == near(first));
  CHECK(plan.segments[1].end_u_s == near(std::sqrt(first * first + 2.0 * 2000.0 * std::sqrt(2.0) * 0.5)));
}

TEST_CASE("with axis limits only reported, the path's own limits are all that counts") {
  auto machine = trapezoid_machine();
  machine.planner.axis_limits = machine::AxisLimitRule::report;
  machine.path.max_accel_mm_s2 = 500.0;
  machine.axis[0].max_feed_u_s = 10.0;
  ProgramWriter w(machine);
  w.line(xyz(100), 50.0);
  const auto path = w.take();
  CHECK(planned(path, machine).law.duration_s == near(100.0 / 50.0 + 50.0 / 500.0));
}

}  // namespace kadr::test
