#include "machine/base/require.h"
#include "machine/machine.h"
#include "verified_plan.h"

namespace kadr::test {

namespace {

/// 40 mm, a stop, 40 mm along Y, a stop, 1 mm back.
planner::Path three_lines(const machine::MachineModel& machine) {
  ProgramWriter w(machine);
  w.mode = gcode::PathMode::exact_stop;
  w.line(xyz(40), 100.0);
  w.line(xyz(40, 40), 100.0);
  w.line(xyz(40, 39), 100.0);
  return w.take();
}

}  // namespace

TEST_CASE("plan() stands at each pause as long as it asks for, and delays what follows") {
  // 0.25 s before the first move, 0.4 and 0.1 s at the same joint, 0.5 s at the end
  const std::vector<planner::Pause> pauses = {{0, 0.25}, {1, 0.4}, {1, 0.1}, {3, 0.5}};
  for (const auto scheduler : {machine::SchedulerKind::chained, machine::SchedulerKind::blockwise})
    for (const bool whole : {true, false}) {
      machine::MachineModel machine = plain_machine();
      machine.planner.scheduler = scheduler;
      machine.planner.whole_ticks = whole;
      const planner::Path path = three_lines(machine);
      const planner::FeedPlan motion = planned(path, machine);
      CHECK(motion.pause_s == 0);
      CHECK(motion.motion_s == motion.law.duration_s);
      const auto plan = planner::plan(path, machine, pauses);
      REQUIRE(plan);
      CHECK(planner::verify(path, *plan, machine, {}, pauses).empty());
      CHECK(plan->motion_s == motion.motion_s);
      CHECK(plan->pause_s == near(1.25));
      CHECK(plan->law.duration_s == near(motion.motion_s + 1.25));
      CHECK(plan->segments[0].begin_time_s == 0.25);
      CHECK(plan->segments[1].begin_time_s == near(motion.segments[1].begin_time_s + 0.75));
      CHECK(plan->segments[2].begin_time_s == near(motion.segments[2].begin_time_s + 0.75));
      std::size_t hint = 0;
      const auto held = plan->law.eval(plan->segments[0].end_time_s + 0.25, hint);
      CHECK(held.speed_u_s == 0);
      CHECK(held.s_u == near(40));
    }
}

TEST_CASE("a path without motion has a law of pauses alone") {
  const machine::MachineModel machine = plain_machine();
  const planner::Path path = ProgramWriter(machine).take();
  const std::vector<planner::Pause> pauses = {{0, 0.5}, {0, 0.25}};
  const auto plan = planner::plan(path, machine, pauses);
  REQUIRE(plan);
  CHECK(plan->law.duration_s == 0.75);
  CHECK(planner::verify(path, *plan, machine, {}, pauses).empty());
  CHECK(!planner::verify(path, *plan, machine).empty());
}

TEST_CASE("verify() finds a pause that nobody asked for, one that is missing, and one elsewhere") {
  const machine::MachineModel machine = plain_machine();
  const planner::Path path = three_lines(machine);
  const auto first_of = [&](std::span<const planner::Pause> planned_pauses,
                            std::span<const planner::Pause> asked) {
    const auto plan = planner::plan(path, machine, planned_pauses);
    REQUIRE(plan);
    const auto found = planner::verify(path, *plan, machine, {}, asked);
    return found.empty() ? std::string() : found.front().what;
  };
  const std::vector<planner::Pause> at_1 = {{1, 0.5}}, at_2 = {{2, 0.5}}, longer = {{1, 0.6}},
                                    at_end = {{3, 0.5}};
  CHECK(first_of(at_1, at_1).empty());
  CHECK(first_of(at_1, {}) == "table times");
  CHECK(first_of({}, at_1) == "table times");
  CHECK(first_of(at_1, at_2) == "table times");
  CHECK(first_of(at_1, longer) == "table times");
  CHECK(first_of(at_end, {}) == "pause");
  CHECK(first_of({}, at_end) == "pause");
}

TEST_CASE("a pause where the path does not rest breaks plan()'s promise") {
  const machine::MachineModel machine = plain_machine();
  const std::vector<planner::Pause> inside = {{1, 0.5}};
  CHECK_THROWS_AS((void)planner::plan(straight(40, 2, machine), machine, inside), BrokenPromise);
}

TEST_CASE("ten thousand pauses of one control tick stay on whole control ticks") {
  const machine::MachineModel machine = plain_machine();
  const planner::Path path = three_lines(machine);
  const std::vector<planner::Pause> pauses(10'000, {1, 0.001});
  const auto plan = planner::plan(path, machine, pauses);
  REQUIRE(plan);
  CHECK(planner::verify(path, *plan, machine, planner::production_check(), pauses).empty());
}

}  // namespace kadr::test
