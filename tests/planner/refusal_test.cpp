#include <doctest/doctest.h>

#include "../support/golden.h"
#include "gcode/block.h"
#include "machine/base/diagnostic.h"
#include "machine/machine.h"
#include "planner_support.h"

// What can't be planned: code, place, measured and allowed value, help.
namespace kadr::test {
namespace {

const char kProgram[] =
    "G21\n"
    "G1 X10 F0\n"
    "G18 G2 X10 I5 F300\n";

/// The diagnostic of planning one line to X10 whose span is line 2 of the program.
Diagnostic refused(const machine::MachineModel& machine, double feed_u_s) {
  planner::PathBuilder builder(machine, {});
  gcode::Feed b;
  b.end = xyz(10);
  b.length_u = 10.0;
  b.feed_u_s = feed_u_s;
  builder.add({{0, 2, 1, 9}, b});
  const auto plan = planner::plan(builder.path(), machine);
  REQUIRE_FALSE(plan);
  return plan.error().diagnostic;
}
/// Golden texts are named by code, as in tests/golden/planner/K4001.txt.
void check_text(const Diagnostic& d) {
  SourceSet sources;
  sources.add(SourceText("part.ngc", kProgram));
  check_golden(std::string(KADR_SOURCE_DIR "/tests/golden/planner/") + code_name(d.code) + ".txt",
               "tests/planner/refusal_test.cpp", render_human(d, sources));
}

}  // namespace

TEST_CASE("a feed of zero is K4001 at the move") {
  check_text(refused(plain_machine(), 0.0));
  CHECK(refused(plain_machine(), std::nan("")).code == Code::feed_not_plannable);
  CHECK(refused(plain_machine(), kInfinity).code == Code::feed_not_plannable);
  CHECK(refused(plain_machine(), -1.0).code == Code::feed_not_plannable);
}

TEST_CASE("an axis that may not accelerate is K4002") {
  auto machine = plain_machine();
  machine.axis[0].max_accel_u_s2 = 0.0;
  check_text(refused(machine, 10.0));
  machine = plain_machine();
  machine.axis[0].max_feed_u_s = 0.0;
  CHECK(refused(machine, 10.0).label == "largest feed is zero for this move of X");
  machine = plain_machine();
  machine.axis[0].max_jerk_u_s3 = 0.0;
  CHECK(refused(machine, 10.0).label == "jerk limit is zero for this move of X");
  machine = plain_machine();
  machine.axis[0].max_accel_u_s2 = kInfinity;
  CHECK(refused(machine, 10.0).label == "nothing limits the acceleration for this move of X");
}

TEST_CASE("quintic ramps on axes without a jerk limit are K4007") {
  auto machine = trapezoid_machine();
  machine.planner.law = machine::RampLaw::quintic;
  check_text(refused(machine, 10.0));
  machine.planner.scheduler = machine::SchedulerKind::blockwise;
  CHECK(refused(machine, 10.0).code == Code::quintic_without_jerk);
  // one finite limit is enough
  machine.path.max_jerk_mm_s3 = 1e5;
  ProgramWriter w(machine);
  w.line(xyz(10), 10.0);
  CHECK(planner::plan(w.take(), machine));
}

TEST_CASE("a motion of more than 1e9 s is K4003 at its slowest move") {
  check_text(refused(plain_machine(), 1e-9));
}

TEST_CASE("an arc in a plane the machine does not have is K4004") {
  const auto machine = plain_machine("XY");
  planner::PathBuilder builder(machine, {});
  gcode::Arc b;
  b.plane = gcode::Plane::zx;
  b.end = xyz(10);
  b.center_second_mm = 5.0;
  b.turns = 1;
  b.feed_u_s = 5.0;
  builder.add({{0, 3, 5, 9}, b});
  const auto plan = planner::plan(builder.path(), machine);
  REQUIRE_FALSE(plan);
  check_text(plan.error().diagnostic);
}

TEST_CASE("an arc in a plane that a rotation turns is K4006") {
  const auto machine = plain_machine("XYZ");
  planner::PathBuilder builder(machine, {});
  gcode::Arc b;
  b.plane = gcode::Plane::zx;
  b.end = xyz(8.660254, 5);  // 10 along X, turned by 30 degrees
  b.center_second_mm = 4.330127;
  b.turns = 1;
  b.plane_rotation_deg = 30;
  b.feed_u_s = 5.0;
  builder.add({{0, 3, 5, 9}, b});
  const auto plan = planner::plan(builder.path(), machine);
  REQUIRE_FALSE(plan);
  check_text(plan.error().diagnostic);
}

TEST_CASE("a move that follows a standing spindle is K4005") {
  const auto machine = plain_machine();
  planner::PathBuilder builder(machine, {});
  gcode::Feed b;
  b.end = xyz(0, 0, -10);
  b.length_u = 10;
  b.pitch_u_rev = 1.5;
  builder.add({{0, 3, 5, 9}, b});
  const auto plan = planner::plan(builder.path(), machine);
  REQUIRE_FALSE(plan);
  CHECK(plan.error().diagnostic.code == Code::spindle_stands_still);
  check_text(plan.error().diagnostic);
}

TEST_CASE("a thread whose pitch is beyond an axis is K4009, with the highest speed of the spindle") {
  // K2 at 4000 rpm: 2 * 4000 / 60 = 133.3 mm/s; at 100 mm/s the spindle may turn 3000 times a minute
  auto machine = plain_machine("XYZ");
  machine.axis[2].max_feed_u_s = 100;
  machine.path.max_feed_mm_s = kInfinity;
  const auto plan_at = [&](double rpm) {
    planner::PathBuilder builder(machine, {});
    builder.follow_spindle(true);
    gcode::Feed b;
    b.end = xyz(0, 0, -10);
    b.length_u = 10;
    b.pitch_u_rev = 2;
    b.feed_u_s = b.pitch_u_rev * rpm / 60;
    builder.add({{0, 3, 5, 9}, b});
    return planner::plan(builder.path(), machine);
  };
  const auto plan = plan_at(4000);
  REQUIRE_FALSE(plan);
  CHECK(plan.error().diagnostic.code == Code::thread_too_fast);
  CHECK(plan.error().diagnostic.help == "write at most S3000");
  check_text(plan.error().diagnostic);
  CHECK(plan_at(3000));
  machine.path.max_feed_mm_s = 50;
  CHECK_FALSE(plan_at(3000));
}

}  // namespace kadr::test
