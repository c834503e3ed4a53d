#include "emulator/cycle/monitor/slip_watch.h"

#include <doctest/doctest.h>

#include "tests/support/straight_run.h"
#include "tests/support/test_machine.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::log;
using namespace kadr::test;

TEST_CASE("a motor that keeps slipping is one alarm, and it ends after 0.1 s without a loss") {
  const machine::MachineModel machine = test_machine(2);
  const planner::Path path = straight_path({100}, 2);
  EventList events(path);
  SlipWatch watch(machine, events);
  std::int64_t tick = 0;
  const auto advance = [&](std::int64_t until, std::vector<plant::LostSteps> lost = {}) {
    for (; tick < until; lost.clear()) watch.tick(lost, Ticks{10'000 * ++tick});
  };
  advance(10);
  advance(11, {{1, ControlTicks{10}, Steps{-200}}});
  advance(110);  // 99 control ticks of grip
  advance(111, {{1, ControlTicks{110}, Steps{-400}}});
  REQUIRE(events.list().size() == 1);
  CHECK(events.list()[0].kind == EventKind::alarm);
  CHECK(events.list()[0].code == Code::lost_steps);
  CHECK(events.list()[0].tick == Ticks{110'000});
  CHECK(events.list()[0].axis == 1);
  CHECK(events.list()[0].value == -200);
  CHECK(events.list()[0].text == "axis Y lost -200 steps");
  advance(210);
  CHECK(events.list().size() == 1);
  advance(211);
  REQUIRE(events.list().size() == 2);
  CHECK(events.list()[1].kind == EventKind::alarm_end);
  CHECK(events.list()[1].code == Code::lost_steps);
  CHECK(events.list()[1].tick == Ticks{2'110'000});
  CHECK(events.list()[1].value == -600);

  // the next loss is a slip of its own; the end of the run ends it
  advance(212, {{1, ControlTicks{211}, Steps{200}}});
  CHECK(watch.alarms() == 2);
  watch.finish(Ticks{2'120'000});
  REQUIRE(events.list().size() == 4);
  CHECK(events.list()[3].value == 200);
  watch.finish(Ticks{2'120'000});
  CHECK(events.list().size() == 4);

  RunSummary summary;
  summary.axis.resize(2);
  watch.summarize(summary);
  CHECK(summary.axis[0].lost_steps == Steps{0});
  CHECK(summary.axis[1].lost_steps == Steps{-400});
}
