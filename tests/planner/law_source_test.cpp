#include <doctest/doctest.h>

#include <algorithm>

#include "machine/machine.h"
#include "planner_support.h"

namespace kadr::test {
namespace {

struct Played {
  planner::Path path{3};
  planner::FeedPlan plan;
  std::vector<planner::TickMotion> ticks;
};

Played play(const planner::Path& path, const machine::MachineModel& machine) {
  Played p;
  p.path = path;
  auto plan = planner::plan(path, machine);
  REQUIRE(plan);
  p.plan = std::move(*plan);
  planner::LawSource source(p.plan.law, machine);
  while (!source.finished()) p.ticks.push_back(source.advance({}));
  return p;
}

/// s within a tick as TickMotion defines it.
double s_at(const planner::TickMotion& m, double offset_ticks, double base_hz) {
  const double t = std::clamp(offset_ticks, m.move_begin_ticks, m.move_end_ticks) - m.move_begin_ticks;
  const double span = m.move_end_ticks - m.move_begin_ticks;
  if (span <= 0.0) return m.s_begin_u;
  return m.s_begin_u +
         (m.ramp_begin_u_s * t + (m.ramp_end_u_s - m.ramp_begin_u_s) * t * t / (2.0 * span)) / base_hz;
}

}  // namespace

TEST_CASE("ticks join in s and feed, never run back, and end exactly at the path's length") {
  const std::uint64_t seed = environment("KADR_SEED", 1);
  for (std::uint64_t i = 0; i < environment("KADR_COUNT", 60); ++i) {
    Random random(seed + i);
    const auto machine = random_machine(random);
    AxisValues end{};
    const auto path = random_path(random, machine, end);
    if (path.size() == 0) continue;
    const Played p = play(path, machine);
    const double hz = static_cast<double>(machine.clock.base_hz);
    const double tick = static_cast<double>(machine.clock.control_tick.value);
    CAPTURE(seed + i);
    double s = 0.0, v = 0.0, worst = 0.0;
    bool sound = true;
    for (const auto& m : p.ticks) {
      sound = sound && m.s_begin_u == s && m.speed_begin_u_s == v && m.s_end_u >= m.s_begin_u;
      sound = sound && m.ramp_begin_u_s >= 0.0 && m.ramp_end_u_s >= 0.0;
      sound = sound && m.move_begin_ticks >= 0.0 && m.move_end_ticks <= tick &&
              m.move_begin_ticks <= m.move_end_ticks;
      const double area =
          0.5 * (m.ramp_begin_u_s + m.ramp_end_u_s) * (m.move_end_ticks - m.move_begin_ticks) / hz;
      worst = std::max(worst, std::fabs(area - (m.s_end_u - m.s_begin_u)));
      s = m.s_end_u;
      v = m.speed_end_u_s;
    }
    CHECK(sound);
    CHECK(worst <= 1e-12 * std::max(path.length_u(), 1.0));
    CHECK(s == path.length_u());
    CHECK(v == 0.0);
  }
}

TEST_CASE("a tick's linear feed stays near the law: 1/12 j tau^3 at most where the jerk is constant") {
  // the law's speed is a parabola there, the tick's a line of the same area: s differs by at most j tau^3/(36
  // sqrt 3) * 2
  const auto machine = plain_machine();
  ProgramWriter w(machine);
  w.line(xyz(100), 100.0);
  const Played p = play(w.take(), machine);
  double worst = 0.0;
  std::size_t hint = 0;
  for (const auto& m : p.ticks)
    for (int k = 0; k <= 20; ++k)
      worst = std::max(
          worst, std::fabs(s_at(m, 500.0 * k, 1e7) -
                           p.plan.law.eval((static_cast<double>(m.tick.value) + k / 20.0) * 1e-3, hint).s_u));
  CHECK(worst < 40000.0 * 1e-9 / 12.0);
  CHECK(worst > 0.0);
}

TEST_CASE("the first tick from rest starts late where a full ramp would run back") {
  // s = j t^3/6: over the first tick S = j tau^3/6, v1 = j tau^2/2 = 3 S/tau > 2 S/tau: 0 -> v1 over 2 S/v1 = 2/3 tau
  const auto machine = plain_machine();
  ProgramWriter w(machine);
  w.line(xyz(100), 100.0);
  const Played p = play(w.take(), machine);
  const auto& first = p.ticks.front();
  CHECK(first.ramp_begin_u_s == 0.0);
  CHECK(first.ramp_end_u_s == doctest::Approx(0.02));
  CHECK(first.move_begin_ticks == doctest::Approx(10000.0 / 3.0));
  CHECK(first.move_end_ticks == 10000.0);
  const auto& last = p.ticks.back();
  CHECK(last.ramp_end_u_s == 0.0);
  CHECK(last.move_begin_ticks == 0.0);
  CHECK(last.move_end_ticks == doctest::Approx(20000.0 / 3.0).epsilon(1e-6));
  CHECK(last.speed_end_u_s == 0.0);
}

TEST_CASE("after the end every tick rests at the path's end") {
  const auto machine = plain_machine();
  ProgramWriter w(machine);
  w.line(xyz(1), 100.0);
  const auto path = w.take();
  const auto plan = planner::plan(path, machine);
  planner::LawSource source(plan->law, machine);
  while (!source.finished()) source.advance({});
  for (int i = 0; i < 3; ++i) {
    const auto m = source.advance({});
    CHECK(m.s_begin_u == 1.0);
    CHECK(m.s_end_u == 1.0);
    CHECK(m.ramp_end_u_s == 0.0);
    CHECK(m.limited_by == planner::LimitedBy::stop);
  }
}

TEST_CASE(
    "a held feed reports what it costs: a tau^2/8 on a constant acceleration of 2000 mm/s2 is 0.25 um") {
  auto machine = trapezoid_machine();
  machine.planner.tick_feed = machine::TickFeed::constant;
  ProgramWriter w(machine);
  w.line(xyz(100), 100.0);
  const Played p = play(w.take(), machine);
  const auto& m = p.ticks[10];
  CHECK(m.ramp_begin_u_s == m.ramp_end_u_s);
  CHECK(m.move_begin_ticks == 0.0);
  CHECK(m.move_end_ticks == 10000.0);
  CHECK(m.held_error_u == doctest::Approx(2000.0 * 1e-6 / 8.0).epsilon(1e-6));
  CHECK(p.ticks[200].held_error_u < 1e-12);
  // dense sampling finds no larger distance
  double worst = 0.0;
  std::size_t hint = 0;
  for (const auto& tick : p.ticks)
    for (int k = 0; k <= 50; ++k) {
      const double gap =
          std::fabs(s_at(tick, 200.0 * k, 1e7) -
                    p.plan.law.eval((static_cast<double>(tick.tick.value) + k / 50.0) * 1e-3, hint).s_u);
      CHECK(gap <= tick.held_error_u + 1e-12);
      worst = std::max(worst, gap);
    }
  CHECK(worst > 2e-4);
}

TEST_CASE("the law is found at any time in any order") {
  const auto machine = plain_machine();
  Random random(3);
  AxisValues end{};
  const auto path = random_path(random, machine, end);
  const auto plan = planner::plan(path, machine);
  REQUIRE(plan);
  std::size_t hint = 0;
  for (int i = 0; i < 1000; ++i) {
    const double t = random.unit() * plan->law.duration_s;
    std::size_t fresh = 0;
    const auto a = plan->law.eval(t, hint);
    const auto b = plan->law.eval(t, fresh);
    CHECK(a.s_u == b.s_u);
    CHECK(plan->law.pieces[hint].begin_s <= t);
  }
  CHECK(plan->law.eval(plan->law.duration_s, hint).s_u == path.length_u());
}

}  // namespace kadr::test
