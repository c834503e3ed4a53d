#include <doctest/doctest.h>

#include "emulator/cycle/monitor/command_statistics.h"
#include "emulator/cycle/monitor/plant_statistics.h"
#include "tests/support/straight_run.h"
#include "tests/support/test_machine.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::log;
using namespace kadr::test;

TEST_CASE("peaks of the command leave out the ticks that span a corner") {
  const machine::MachineModel machine = test_machine(1);
  const planner::Path path = straight_path({1, 1});
  StraightRun run(path, machine);
  CommandedMotion commanded(path, machine);
  CommandStatistics statistics(path, commanded);
  const auto tick = [&](double s_u, double speed_u_s) {
    const TickView view = run.tick(s_u, speed_u_s);
    commanded.tick(view);
    statistics.tick(view);
  };
  tick(0.1, 1);  // 1000 mm/s2, 1e6 mm/s3
  tick(0.5, 2);
  tick(1.1, 9);  // the joint: 7000 mm/s2
  tick(1.2, 9);  // and the difference behind it
  tick(1.3, 8.5);
  RunSummary summary;
  summary.axis.resize(1);
  statistics.summarize(summary);
  const AxisSummary& x = summary.axis[0];
  CHECK(x.peak_accel_u_s2 == doctest::Approx(1000));
  CHECK(x.peak_jerk_u_s3 == doctest::Approx(1e6));
  CHECK(x.peak_feed_u_s == 9);
  CHECK(x.peak_feed_tick == Ticks{30'000});
  CHECK(x.min_u == 0);
  CHECK(x.max_u == 1.3);
  CHECK(x.end_u == 1.3);
  CHECK(summary.peak_feed_u_s == 9);
}

TEST_CASE(
    "the error of the path is what lies across it; vibration has its peak, tick, line and mean square") {
  const machine::MachineModel machine = test_machine(2);
  const planner::Path path = straight_path({1}, 2);
  StraightRun run(path, machine);
  CommandedMotion commanded(path, machine);
  PlantStatistics statistics(machine, commanded);
  const auto tick = [&](double s_u, double x_error_u, double y_u, double link_u) {
    run.plant[0] = {s_u + x_error_u - link_u, 0, link_u, 0, 0};
    run.plant[1] = {y_u, 0, 0, 0, 0};
    const TickView view = run.tick(s_u, 10);
    commanded.tick(view);
    statistics.tick(view, 7);
  };
  tick(0.1, -0.5, 0.003, 0.04);  // half a millimetre late, 3 um beside the path
  tick(0.2, 0.1, -0.002, -0.03);
  RunSummary summary;
  summary.axis.resize(2);
  statistics.summarize(summary);
  CHECK(summary.path_error_u == doctest::Approx(0.003).epsilon(1e-9));
  const AxisSummary& x = summary.axis[0];
  CHECK(x.peak_vibration_u == 0.04);
  CHECK(x.peak_vibration_tick == Ticks{10'000});
  CHECK(x.peak_vibration_line == 7);
  CHECK(x.rms_vibration_u == doctest::Approx(std::sqrt((0.04 * 0.04 + 0.03 * 0.03) / 2)));
  CHECK(x.peak_following_u == doctest::Approx(0.5));
  CHECK(x.rms_following_u == doctest::Approx(std::sqrt((0.25 + 0.01) / 2)));
}
