#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "machine/machine.h"
#include "planner/point_to_point/residual.h"
#include "planner/positioning/link_modes.h"
#include "planner_support.h"
#include "verified_plan.h"

/// Rapids of planner.rapid_law under an operator: X at 200 mm/s, 2000 mm/s2, jerk 40 000 mm/s3, a link of 20
/// Hz on a rigid base.
namespace kadr::test {
namespace {

using machine::RapidShape;
using planner::OperatorInput;
using planner::OverrideNote;
using planner::TickMotion;

machine::MachineModel flexible(RapidShape shape) {
  machine::MachineModel m = plain_machine("XY");
  m.planner.rapid_law = shape;
  for (auto& axis : m.axis) axis.max_feed_u_s = 200;
  machine::TwoMassModel& p = m.axis[0].plant;
  m.axis[0].has_plant = true;
  p.motor = machine::MotorModel::rigid;
  p.base_mass_kg = 20;
  p.link_mass_kg = 4;
  p.link_stiffness_N_per_m = 4 * (2 * kPi * 20) * (2 * kPi * 20);
  return m;
}

struct RapidRide {
  std::vector<TickMotion> ticks;
  double end_u = 0;
  bool stopped = false;
  /// What the link is left with: its base follows the cubic through each tick's places and
  /// speeds, as a rigid motor's does.
  double swing_u(const machine::MachineModel& machine) const {
    const planner::Mode mode = planner::link_modes(machine.axis[0])[0].mode;
    planner::LinkState link;
    const double tau = machine.clock.tau_s();
    for (const TickMotion& m : ticks) {
      const double way = m.s_end_u - m.s_begin_u, v0 = m.speed_begin_u_s, v1 = m.speed_end_u_s;
      const double jerk = (6 * (v0 + v1) - 12 * way / tau) / (tau * tau);
      const double accel = (v1 - v0) / tau - jerk * tau / 2;
      link = planner::advance_link(link, mode, accel, jerk, tau);
    }
    return planner::envelope_u(link, mode);
  }
  double top_u_s() const {
    double top = 0;
    for (const TickMotion& m : ticks) top = std::max(top, m.speed_end_u_s);
    return top;
  }
  std::ptrdiff_t noted(OverrideNote note) const {
    return std::count_if(ticks.begin(), ticks.end(), [&](const TickMotion& m) { return m.note == note; });
  }
};

RapidRide rapid_ride(const machine::MachineModel& machine, const std::function<void(ProgramWriter&)>& program,
                     const std::function<void(std::size_t, OperatorInput&)>& hand) {
  ProgramWriter writer(machine);
  program(writer);
  const planner::Path path = writer.take();
  const planner::FeedPlan plan = planned(path, machine);
  const auto source = planner::override_source(path, plan, machine, 1.0);
  OperatorInput input;
  RapidRide r;
  double s = 0, v = 0;
  bool joined = true;
  while (!source->finished() && !source->stopped() && r.ticks.size() < 20'000) {
    hand(r.ticks.size(), input);
    const TickMotion m = source->advance(input);
    joined = joined && m.s_begin_u == s && m.speed_begin_u_s == v && m.s_end_u >= m.s_begin_u &&
             m.tick.value == static_cast<std::int64_t>(r.ticks.size());
    s = m.s_end_u;
    v = m.speed_end_u_s;
    r.ticks.push_back(m);
  }
  CHECK(joined);
  r.stopped = source->stopped();
  r.end_u = s;
  if (!r.stopped) CHECK(std::fabs(s - path.length_u()) <= 1e-9);
  return r;
}

const std::function<void(ProgramWriter&)> kRapid = [](ProgramWriter& w) { w.rapid(xyz(100)); };
/// Swing of one jump of acceleration: 2000 mm/s2/(2 pi 20)^2.
constexpr double kJump_mm = 0.1267;

const auto percent_from = [](std::size_t from, double ratio) {
  return [=](std::size_t tick, OperatorInput& input) {
    if (tick >= from) input.rapid_override = ratio;
  };
};

TEST_CASE("a rapid under a percent is slower and as silent") {
  for (const RapidShape shape : {RapidShape::t_zero, RapidShape::zv, RapidShape::zvd}) {
    const machine::MachineModel m = flexible(shape);
    const RapidRide full = rapid_ride(m, kRapid, percent_from(0, 1.0));
    const RapidRide half = rapid_ride(m, kRapid, percent_from(0, 0.5));
    CHECK(full.swing_u(m) < 1e-3 * kJump_mm);
    CHECK(half.swing_u(m) < 1e-3 * kJump_mm);
    CHECK(half.top_u_s() <= 100 * (1 + 1e-9));
    CHECK(half.top_u_s() > 90);
    CHECK(half.ticks.size() > full.ticks.size());
  }
  // planned as any other move it rings (at 30 %: 60 mm/s, 33.3 periods between the ramps)
  const machine::MachineModel other = flexible(RapidShape::scurve);
  CHECK(rapid_ride(other, kRapid, percent_from(0, 0.3)).swing_u(other) > 0.05 * kJump_mm);
}

TEST_CASE("a percent that changes within a rapid counts from the next one") {
  const machine::MachineModel m = flexible(RapidShape::zv);
  const auto there_and_back = [](ProgramWriter& w) {
    w.rapid(xyz(100));
    w.rapid(xyz(0));
  };
  const RapidRide r = rapid_ride(m, there_and_back, percent_from(200, 0.5));
  CHECK(r.noted(OverrideNote::deferred) > 0);
  const std::size_t first = rapid_ride(m, kRapid, percent_from(0, 1.0)).ticks.size();
  const std::size_t slow = rapid_ride(m, kRapid, percent_from(0, 0.5)).ticks.size();
  CHECK(r.ticks.size() == first + slow);
  CHECK(r.swing_u(m) < 1e-3 * kJump_mm);
  // and back to 100 % within the slow one
  const RapidRide back = rapid_ride(m, there_and_back, [](std::size_t tick, OperatorInput& input) {
    input.rapid_override = tick < 300 ? 0.5 : 1.0;
  });
  CHECK(back.ticks.size() == first + slow);
  CHECK(back.swing_u(m) < 1e-3 * kJump_mm);
}

TEST_CASE("the feed's percent does not change a rapid") {
  const machine::MachineModel m = flexible(RapidShape::zv);
  const RapidRide full = rapid_ride(m, kRapid, percent_from(0, 1.0));
  const RapidRide r =
      rapid_ride(m, kRapid, [](std::size_t, OperatorInput& input) { input.feed_override = 0.3; });
  REQUIRE(r.ticks.size() == full.ticks.size());
  for (std::size_t i = 0; i < r.ticks.size(); ++i) CHECK(r.ticks[i].s_end_u == full.ticks[i].s_end_u);
  // a feed move at 30 %, and then the rapid as planned
  const auto feed_first = [](ProgramWriter& w) {
    w.line(xyz(20), 100);
    w.rapid(xyz(120));
  };
  const RapidRide both =
      rapid_ride(m, feed_first, [](std::size_t, OperatorInput& input) { input.feed_override = 0.3; });
  CHECK(both.ticks[both.ticks.size() - full.ticks.size()].s_begin_u == doctest::Approx(20).epsilon(1e-9));
}

TEST_CASE("a rapid waits where it stands while its percent is 0, and while the feed is held") {
  const machine::MachineModel m = flexible(RapidShape::zvd);
  const std::size_t full = rapid_ride(m, kRapid, percent_from(0, 1.0)).ticks.size();
  const RapidRide zero = rapid_ride(m, kRapid, [](std::size_t tick, OperatorInput& input) {
    input.rapid_override = tick < 50 ? 0.0 : 1.0;
  });
  CHECK(zero.ticks.size() == full + 50);
  CHECK(zero.swing_u(m) < 1e-3 * kJump_mm);
  const RapidRide held =
      rapid_ride(m, kRapid, [](std::size_t tick, OperatorInput& input) { input.hold = tick < 70; });
  CHECK(held.ticks.size() == full + 70);
}

TEST_CASE("a feed hold within a rapid brakes it at once and it goes on to its end") {
  for (const double ratio : {1.0, 0.5}) {
    const machine::MachineModel m = flexible(RapidShape::zv);
    const RapidRide r = rapid_ride(m, kRapid, [&](std::size_t tick, OperatorInput& input) {
      input.rapid_override = ratio;
      input.hold = tick >= 250 && tick < 800;
    });
    CHECK(r.ticks[700].speed_end_u_s == 0.0);
    CHECK(r.ticks[700].s_end_u < 99);
    CHECK(r.ticks.size() > 900);
  }
}

TEST_CASE("an emergency stop within a rapid stops it") {
  for (const double ratio : {1.0, 0.5}) {
    const machine::MachineModel m = flexible(RapidShape::zv);
    const RapidRide r = rapid_ride(m, kRapid, [&](std::size_t tick, OperatorInput& input) {
      input.rapid_override = ratio;
      input.emergency_stop = tick >= 250;
    });
    CHECK(r.stopped);
    CHECK(r.end_u < 99);
  }
}

}  // namespace
}  // namespace kadr::test
