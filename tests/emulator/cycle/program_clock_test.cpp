#include "emulator/cycle/program_clock.h"

#include <doctest/doctest.h>

#include "emulator/cycle/tick_time.h"
#include "tests/support/straight_run.h"
#include "tests/support/test_machine.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::log;
using namespace kadr::test;

namespace {

/// A control tick of 10 000 base ticks (1 ms) at a constant feed.
TickMotion steady(std::int64_t tick, double begin_u, double end_u) {
  TickMotion m;
  m.tick = ControlTicks{tick};
  m.s_begin_u = begin_u;
  m.s_end_u = end_u;
  m.move_end_ticks = 10'000;
  m.ramp_begin_u_s = m.ramp_end_u_s = m.speed_begin_u_s = m.speed_end_u_s = (end_u - begin_u) / 1e-3;
  return m;
}

ProgramEvent event_at(std::size_t segment, gcode::Action action) {
  ProgramEvent event;
  event.block = {{}, std::move(action)};
  event.after_segment = segment;
  return event;
}

}  // namespace

TEST_CASE("a place inside a control tick is passed at the moment of the linear feed there") {
  const machine::ClockModel clock;
  CHECK(base_tick_at(steady(3, 1.0, 1.125), 1.03125, clock) == Ticks{32'500});  // exact in binary
  CHECK(base_tick_at(steady(3, 1.0, 1.1), 0.5, clock) == Ticks{30'000});
  CHECK(base_tick_at(steady(3, 1.0, 1.1), 1.1, clock) == Ticks{40'000});
  // from rest: s = a t^2 / 2, so a quarter of the path takes half of the time
  TickMotion ramp = steady(0, 0, 0.001);
  ramp.ramp_begin_u_s = 0;
  ramp.ramp_end_u_s = 2.0;
  CHECK(base_tick_at(ramp, 0.00025, clock).value == doctest::Approx(5000).epsilon(2e-4));
  CHECK(feed_at_u_s(ramp, 0.00025) == doctest::Approx(1.0));
  // the motion ends in the middle of the tick
  TickMotion half = steady(0, 0, 0.1);
  half.move_end_ticks = 5000;
  half.ramp_begin_u_s = half.ramp_end_u_s = 200;
  CHECK(base_tick_at(half, 0.05, clock) == Ticks{2500});
}

TEST_CASE("program events come at their joints, one behind the other; a dwell holds up those behind it") {
  const machine::MachineModel machine = test_machine(1);
  const planner::Path path = straight_path({1, 1});
  EventList list(path);
  const std::vector<ProgramEvent> events = {
      event_at(0, gcode::Message{"begin"}), event_at(1, gcode::SpindleStop{}),
      event_at(1, gcode::Dwell{0.0025}), event_at(1, gcode::Message{"on"}), event_at(2, gcode::ProgramEnd{})};
  ProgramClock clock(events, path, machine, list);
  clock.tick(steady(0, 0, 0.5));
  REQUIRE(list.list().size() == 1);
  CHECK(list.list()[0].tick == Ticks{0});
  clock.tick(steady(1, 0.5, 1.0));
  // 2.5 ms of dwell are 3 control ticks: the message behind it is due at 50 000
  REQUIRE(list.list().size() == 3);
  CHECK(list.list()[1].tick == Ticks{20'000});
  CHECK(list.list()[2].kind == EventKind::dwell);
  CHECK_FALSE(clock.finished(Ticks{20'000}));
  for (std::int64_t tick = 2; tick < 4; ++tick) clock.tick(steady(tick, 1.0, 1.0));
  CHECK(list.list().size() == 3);
  clock.tick(steady(4, 1.0, 1.0));
  REQUIRE(list.list().size() == 4);
  CHECK(list.list()[3].tick == Ticks{50'000});
  CHECK(list.list()[3].block == 0);
  clock.tick(steady(5, 1.0, 2.0));
  REQUIRE(list.list().size() == 5);
  CHECK(list.list()[4].tick == Ticks{60'000});
  CHECK(list.list()[4].block == 1);
  CHECK(clock.finished(Ticks{60'000}));
}

TEST_CASE("a program that ends with a dwell is finished when the dwell is over") {
  const machine::MachineModel machine = test_machine(1);
  const planner::Path path(1);
  EventList list(path);
  const std::vector<ProgramEvent> events = {event_at(0, gcode::Dwell{0.002})};
  ProgramClock clock(events, path, machine, list);
  clock.tick(steady(0, 0, 0));
  CHECK(list.list().size() == 1);
  CHECK_FALSE(clock.finished(Ticks{10'000}));
  CHECK(clock.finished(Ticks{20'000}));
}
