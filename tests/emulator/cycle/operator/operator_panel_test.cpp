#include "emulator/cycle/operator/operator_panel.h"

#include <doctest/doctest.h>

#include "emulator/cycle/operator/operator_watch.h"
#include "tests/support/operator_step.h"
#include "tests/support/straight_run.h"
#include "tests/support/test_machine.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::log;
using namespace kadr::test;

namespace {
OperatorStep step_on_path(OperatorAction action, double value = 1) {
  OperatorStep step = operator_step(0, action, value);
  step.place = PathPlace{};
  return step;
}

}  // namespace

TEST_CASE(
    "steps come into force at their tick or with the first tick at or behind their place, each one an "
    "event") {
  const machine::MachineModel machine = test_machine(1);
  const planner::Path path = straight_path({100});
  EventList events(path);
  const std::vector<OperatorStep> steps = {operator_step(2, OperatorAction::feed_override, 0.5),
                                           operator_step(2, OperatorAction::rapid_override, 0.25),
                                           operator_step(4, OperatorAction::hold),
                                           step_on_path(OperatorAction::resume)};
  OperatorPanel panel(steps, {0, 0, 0, 12.5}, machine, events);
  CHECK(panel.advance(ControlTicks{0}, 0).feed_override == 1.0);
  CHECK(panel.advance(ControlTicks{1}, 3).feed_override == 1.0);
  CHECK(events.list().empty());
  const planner::OperatorInput half = panel.advance(ControlTicks{2}, 6);
  CHECK(half.feed_override == 0.5);
  CHECK(half.rapid_override == 0.25);
  CHECK_FALSE(panel.at_its_end());
  CHECK_FALSE(panel.advance(ControlTicks{3}, 9).hold);
  CHECK(panel.advance(ControlTicks{4}, 12.4).hold);
  CHECK(panel.at_its_end());  // while the path rests, no step will come
  CHECK_FALSE(panel.advance(ControlTicks{5}, 12.5).hold);
  std::vector<std::pair<EventKind, std::int64_t>> seen;
  for (const EventRecord& e : events.list()) seen.emplace_back(e.kind.value().value(), e.tick.value);
  CHECK(seen == std::vector<std::pair<EventKind, std::int64_t>>{{EventKind::feed_override, 20'000},
                                                                {EventKind::rapid_override, 20'000},
                                                                {EventKind::hold, 40'000},
                                                                {EventKind::resume, 50'000}});
  CHECK(events.list()[0].value == 50);
  CHECK(events.list()[0].text == "feed override 50 %");
}

TEST_CASE("the feed override is the operator's times the spindle's") {
  machine::MachineModel machine = test_machine(1);
  machine.spindle.high_ms = 1;
  const planner::Path path = straight_path({100});
  EventList events(path);
  const std::vector<OperatorStep> steps = {operator_step(0, OperatorAction::feed_override, 0.5),
                                           operator_step(0, OperatorAction::spindle_load, 1.5)};
  OperatorPanel panel(steps, {0, 0}, machine, events);
  CHECK(panel.advance(ControlTicks{0}, 0).feed_override == doctest::Approx(0.45));
  CHECK(panel.spindle_override() == doctest::Approx(0.9));
  CHECK_FALSE(panel.at_its_end());  // the spindle goes on
  REQUIRE(events.list().size() == 3);
  CHECK(events.list()[2].kind == EventKind::spindle_override);
  CHECK(events.list()[2].text == "spindle load 150 %: feed at 90 %");
}

TEST_CASE("a live step comes into force with the next tick, behind the timeline's, and only once") {
  const machine::MachineModel machine = test_machine(1);
  const planner::Path path = straight_path({100});
  EventList events(path);
  const std::vector<OperatorStep> steps = {operator_step(1, OperatorAction::feed_override, 0.5)};
  OperatorPanel panel(steps, {0}, machine, events);
  panel.advance(ControlTicks{0}, 0);
  panel.operate(operator_step(99, OperatorAction::feed_override, 0.7));
  CHECK(panel.advance(ControlTicks{1}, 0).feed_override == 0.7);
  CHECK(panel.advance(ControlTicks{2}, 0).feed_override == 0.7);
  REQUIRE(events.list().size() == 2);
  CHECK(events.list()[1].value == doctest::Approx(70));
  CHECK(events.list()[1].tick == Ticks{10'000});
}

TEST_CASE("a lock that an overload waits for is one alarm, and each tick that waits is counted") {
  const planner::Path path = straight_path({100});
  planner::MotionLaw law;
  EventList events(path);
  OperatorWatch watch(law, 1e-3, events);
  planner::TickMotion motion;
  motion.s_end_u = 1;
  const planner::OperatorInput input{};
  const auto tick = [&](planner::OverrideNote note, double spindle_override) {
    motion.note = note;
    watch.tick(motion, input, spindle_override, Ticks{0});
  };
  using planner::OverrideNote;
  tick(OverrideNote::locked, 1.0);
  CHECK(watch.deferred_ticks() == ControlTicks{1});
  CHECK(watch.alarms() == 0);
  tick(OverrideNote::locked, 0.9);
  tick(OverrideNote::locked, 0.8);
  CHECK(watch.alarms() == 1);
  REQUIRE(events.list().size() == 1);
  CHECK(events.list()[0].code == Code::overload_locked);
  CHECK(events.list()[0].text == "the load asks for 90 %, but the feed is locked");
  tick(OverrideNote::deferred, 0.8);
  CHECK(watch.deferred_ticks() == ControlTicks{4});
  tick(OverrideNote::limited, 0.8);
  CHECK(watch.deferred_ticks() == ControlTicks{0});
  tick(OverrideNote::locked, 0.8);
  CHECK(watch.alarms() == 2);
}
