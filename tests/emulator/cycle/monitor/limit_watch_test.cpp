#include "emulator/cycle/monitor/limit_watch.h"

#include <doctest/doctest.h>

#include "tests/support/straight_run.h"
#include "tests/support/test_machine.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::log;
using namespace kadr::test;

namespace {

/// A limit watch over one axis whose speeds the test chooses; 1 ms control ticks.
struct WatchedAxis {
  machine::MachineModel machine = test_machine(1);
  planner::Path path;
  EventList events;
  StraightRun run;
  CommandedMotion commanded;
  LimitWatch watch;

  explicit WatchedAxis(const std::vector<double>& lengths_u, void (*change)(machine::AxisModel&))
      : path(straight_path(lengths_u)),
        events(path),
        run(path, (change(machine.axis[0]), machine)),
        commanded(path, machine),
        watch(machine, commanded, events) {}
  void tick(double s_u, double speed_u_s) {
    const TickView view = run.tick(s_u, speed_u_s);
    events.move_to(view.segment);
    commanded.tick(view);
    watch.tick(view.end);
  }
};

void only_speed(machine::AxisModel& x) { x.max_accel_u_s2 = x.max_jerk_u_s3 = machine::kInfinity; }

}  // namespace

TEST_CASE("an overrun is one alarm where it begins and one alarm end with its worst value") {
  WatchedAxis x({100}, only_speed);
  double s_u = 0;
  for (const double speed_u_s : {100.0, 120.0, 130.0, 115.0, 100.0, 90.0}) x.tick(s_u += 0.1, speed_u_s);
  const auto& events = x.events.list();
  REQUIRE(events.size() == 2);
  CHECK(events[0].kind == EventKind::alarm);
  CHECK(events[0].code == Code::speed_overrun);
  CHECK(events[0].tick == Ticks{20'000});  // the end of the second control tick
  CHECK(events[0].axis == 0);
  CHECK(events[0].value == 120);
  CHECK(events[0].limit == 110);
  CHECK(events[0].text == "axis X speed is 120 mm/s, allowed 110");
  CHECK(events[0].span.line == 1);
  CHECK(events[1].kind == EventKind::alarm_end);
  CHECK(events[1].code == Code::speed_overrun);
  CHECK(events[1].tick == Ticks{50'000});
  CHECK(events[1].value == 130);
  CHECK(events[1].text == "axis X speed was at most 130 mm/s, allowed 110");
  CHECK(x.watch.alarms() == 1);
  x.watch.finish(Ticks{60'000});
  CHECK(x.events.list().size() == 2);
}

TEST_CASE("a limit is exceeded by more than a millionth of it, a position by more than a nanometre") {
  WatchedAxis speed({100}, only_speed);
  speed.tick(0.1, 110 * (1 + 0.9e-6));
  CHECK(speed.events.list().empty());
  speed.tick(0.2, 110 * (1 + 1.1e-6));
  CHECK(speed.events.list().size() == 1);

  WatchedAxis position({100}, [](machine::AxisModel& x) {
    only_speed(x);
    x.soft_max_u = 50;
  });
  position.tick(50 + 0.9e-9, 1);
  CHECK(position.events.list().empty());
  position.tick(50 + 1.1e-9, 1);
  REQUIRE(position.events.list().size() == 1);
  CHECK(position.events.list()[0].code == Code::soft_limit_overrun);
  CHECK(position.events.list()[0].limit == 50);
}

TEST_CASE("a corner's step of speed is allowed in the tick that spans a joint, and in no other") {
  // 2000 mm/s2 along the path, 2000 mm/s2 over 1 ms at a corner: a step of 3.5 mm/s is 3500 mm/s2
  const auto no_jerk = [](machine::AxisModel& x) { x.max_jerk_u_s3 = machine::kInfinity; };
  WatchedAxis corner({1, 1}, no_jerk);
  corner.tick(0.1, 1.9);
  corner.tick(1.1, 5.4);
  CHECK(corner.events.list().empty());
  WatchedAxis straight({2}, no_jerk);
  straight.tick(0.1, 1.9);
  straight.tick(1.1, 5.4);
  REQUIRE(straight.events.list().size() == 1);
  CHECK(straight.events.list()[0].code == Code::acceleration_overrun);
  CHECK(straight.events.list()[0].value == doctest::Approx(3500));
  WatchedAxis larger({1, 1}, no_jerk);
  larger.tick(0.1, 1.9);
  larger.tick(1.1, 6.0);  // 4100 mm/s2 of 4000
  REQUIRE(larger.events.list().size() == 1);
  CHECK(larger.events.list()[0].limit == 4000);
}

TEST_CASE("the jerk allows for a corner in the tick of the joint and in the one behind it") {
  // speed steps by 2 mm/s at the joint: jerk + and - 2 mm/s / (1 ms)^2 = 2e6 mm/s3 of 40 000 + 2 * 2e6
  const auto any_accel = [](machine::AxisModel& x) { x.max_accel_u_s2 = machine::kInfinity; };
  WatchedAxis corner({1, 1}, any_accel);
  corner.tick(0.5, 0.01);
  corner.tick(1.1, 2.01);
  corner.tick(1.2, 2.01);
  CHECK(corner.events.list().empty());
  WatchedAxis straight({2}, any_accel);
  straight.tick(0.5, 0.01);
  straight.tick(1.1, 2.01);
  CHECK(straight.watch.alarms() == 1);
  CHECK(straight.events.list()[0].code == Code::jerk_overrun);
}

TEST_CASE("what is open at the end of a run is ended with its code; an axis at rest is not looked at") {
  WatchedAxis x({100}, only_speed);
  x.tick(0.1, 120);
  x.watch.finish(Ticks{10'000});
  REQUIRE(x.events.list().size() == 2);
  CHECK(x.events.list()[1].kind == EventKind::alarm_end);
  CHECK(x.events.list()[1].code == Code::speed_overrun);
  CHECK(x.events.list()[1].text == "axis X was still over its limit at the end, at most 120, allowed 110");

  WatchedAxis outside({100}, [](machine::AxisModel& axis) {
    only_speed(axis);
    axis.soft_min_u = 10;
  });
  outside.tick(0, 0);
  CHECK(outside.events.list().empty());
  outside.tick(0.001, 1);
  CHECK(outside.watch.alarms() == 1);
}
