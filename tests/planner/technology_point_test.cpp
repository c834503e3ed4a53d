#include <doctest/doctest.h>

#include "gcode/block.h"
#include "machine/machine.h"
#include "planner_support.h"

namespace kadr::test {

namespace {

gcode::Block line_to(double x_mm) {
  gcode::Feed block;
  block.feed_u_s = 100.0;
  block.length_u = 50.0;
  block.end = xyz(x_mm);
  return {{}, block};
}

/// Two lines with a technology point between them.
planner::Path two_lines(const machine::MachineModel& machine, double limit_mm_s) {
  planner::PathBuilder builder(machine, {});
  builder.add(line_to(50));
  builder.limit_speed(limit_mm_s);
  builder.add(line_to(100));
  return builder.take();
}

}  // namespace

TEST_CASE("every planner passes a technology point at its speed, and verify() sees one that does not") {
  for (const machine::PlanMethod method :
       {machine::PlanMethod::scheduler, machine::PlanMethod::tube, machine::PlanMethod::certified})
    for (const machine::SchedulerKind scheduler :
         {machine::SchedulerKind::chained, machine::SchedulerKind::blockwise}) {
      machine::MachineModel machine = plain_machine();
      machine.planner.method = method;
      machine.planner.scheduler = scheduler;
      const planner::Path path = two_lines(machine, 30.0);
      const auto plan = planner::plan(path, machine);
      REQUIRE(plan);
      CHECK(planner::verify(path, *plan, machine).empty());
      CHECK(plan->segments[0].end_u_s <= 30.0 * (1.0 + 1e-12));
      CHECK(plan->segments[0].end_u_s >= 27.0);
      CHECK(plan->segments[0].peak_u_s > 90.0);

      const auto fast = planner::plan(two_lines(machine, machine::kInfinity), machine);
      REQUIRE(fast);
      const auto found = planner::verify(path, *fast, machine);
      REQUIRE(!found.empty());
      CHECK(found.front().what == "technology point");
      CHECK(found.front().limit == 30.0);
    }
}

TEST_CASE(
    "of two technology points at one place the lower counts, and one before the first move has nothing to "
    "do") {
  machine::MachineModel machine = plain_machine();
  planner::PathBuilder builder(machine, {});
  builder.limit_speed(1.0);
  builder.add(line_to(50));
  builder.limit_speed(40.0);
  builder.limit_speed(20.0);
  builder.add(line_to(100));
  builder.add(line_to(150));
  const auto plan = planner::plan(builder.path(), machine);
  REQUIRE(plan);
  CHECK(plan->segments[0].end_u_s == doctest::Approx(20.0).epsilon(1e-3));
  CHECK(plan->segments[1].end_u_s > 90.0);
}

}  // namespace kadr::test
