#include <doctest/doctest.h>

#include <algorithm>

#include "gcode/block.h"
#include "machine/machine.h"
#include "verified_plan.h"

// Jerk-limited plans, a = 2000 mm/s2, j = 40000 mm/s3: a ramp by dv <= a^2/j = 100 mm/s lasts 2 sqrt(dv/j).
namespace kadr::test {
TEST_CASE("G1 X100 at 100 mm/s takes 1100 control ticks exactly: 0.1 + 0.9 + 0.1 s") {
  // each ramp lasts 2 sqrt(100/40000) = 0.1 s over 5 mm
  const auto machine = plain_machine();
  ProgramWriter w(machine);
  w.line(xyz(100), 100.0);
  const auto path = w.take();
  const auto plan = planned(path, machine);
  CHECK(plan.law.duration_s == 1100 * 0.001);
  CHECK(plan.segments[0].peak_u_s == near(100.0));
  planner::LawSource source(plan.law, machine);
  int ticks = 0;
  for (; !source.finished(); ++ticks) source.advance({});
  CHECK(ticks == 1100);
}

TEST_CASE("a ramp beyond a^2/j holds the largest acceleration: 0 -> 200 mm/s takes 200/2000 + 2000/40000 s") {
  auto machine = plain_machine();
  machine.axis[0].max_feed_u_s = 200.0;
  machine.planner.whole_ticks = false;
  ProgramWriter w(machine);
  w.line(xyz(100), 500.0);
  const auto path = w.take();
  // ramp 0.15 s over 15 mm each, 70 mm held
  CHECK(planned(path, machine).law.duration_s == near(0.15 + 70.0 / 200.0 + 0.15));
}

TEST_CASE("80 collinear pieces of 0.5 mm take the 0.500 s of one line of 40 mm") {
  auto machine = plain_machine();
  for (const bool whole : {false, true}) {
    machine.planner.whole_ticks = whole;
    ProgramWriter w(machine);
    for (int i = 1; i <= 80; ++i) w.line(xyz(0.5 * i), 100.0);
    const auto path = w.take();
    CHECK(planned(path, machine).law.duration_s == near(0.5));
  }
}

TEST_CASE("cutting a line into 0.1 mm pieces at an angle costs no time") {
  const auto machine = plain_machine();
  ProgramWriter whole(machine), cut(machine);
  whole.line(xyz(30, 17, 5), 80.0);
  for (int i = 1; i <= 350; ++i) cut.line(xyz(30.0 * i / 350, 17.0 * i / 350, 5.0 * i / 350), 80.0);
  const auto one = whole.take();
  const auto many = cut.take();
  CHECK(planned(many, machine).law.duration_s == planned(one, machine).law.duration_s);
}

TEST_CASE("pieces shorter than a control tick are passed at the full feed: 20 x 0.03 mm between long lines") {
  // 40.6 mm in all at 100 mm/s: 0.406 + 0.1 s; three pieces may end in one tick
  const auto machine = plain_machine();
  const auto path = tiny_blocks(machine);
  const auto plan = planned(path, machine);
  CHECK(plan.law.duration_s == near(0.506));
  for (std::size_t i = 1; i <= 20; ++i) {
    CHECK(plan.segments[i].end_u_s == near(100.0));
    CHECK(plan.segments[i].end_time_s - plan.segments[i].begin_time_s == doctest::Approx(3e-4).epsilon(1e-6));
  }
}

TEST_CASE("the exit of a right-angled corner is 2 mm/s, with acceleration zero there") {
  const auto machine = plain_machine();
  ProgramWriter w(machine);
  w.line(xyz(50, 0), 100.0);
  w.line(xyz(50, 50), 100.0);
  const auto path = w.take();
  const auto plan = planned(path, machine);
  CHECK(plan.segments[0].end_u_s == near(2.0));
  std::size_t hint = 0;
  CHECK(std::fabs(plan.law.eval(plan.segments[0].end_time_s, hint).accel_u_s2) < 1e-3);
  // before the last bits of whole ticks: two ramps 0 <-> 100 and two 2 <-> 100 per corner
  const double t98 = 2.0 * std::sqrt(98.0 / 40000.0);
  const double held = 100.0 - 2.0 * 5.0 - 2.0 * 51.0 * t98;
  const double exact = 0.2 + 2.0 * t98 + held / 100.0;
  CHECK(plan.law.duration_s == near(std::ceil(exact * 1000.0) / 1000.0));
}

TEST_CASE("a corner that the ramp passes below its cap does not cost anything") {
  // 0 -> 100 mm/s takes 5 mm and 0.1 s; halfway in time, at 0.05 s, it has 50 mm/s and 0.8333 mm. A corner
  // there that allows 51 mm/s is not felt; one that allows 40 is.
  auto machine = plain_machine();
  machine.planner.whole_ticks = false;
  const double way = 40000.0 * 0.05 * 0.05 * 0.05 / 6.0;
  const auto time = [&](double allowed) {
    auto m = machine;
    m.axis[1].junction_accel_u_s2 = allowed * 0.001 / 0.001;  // of Y, which changes by 0.001
    ProgramWriter w(m);
    w.line(xyz(way, 0), 100.0);
    w.line(xyz(way + 50.0, 0.05), 100.0);
    const auto path = w.take();
    return planned(path, m).law.duration_s;
  };
  const double free = time(1e6);
  CHECK(time(51.0) == near(free));
  CHECK(time(40.0) > free + 0.005);
}

TEST_CASE("exact stops bring every block to rest on a whole control tick") {
  const auto machine = plain_machine();
  ProgramWriter w(machine);
  w.mode = gcode::PathMode::exact_stop;
  for (int i = 1; i <= 7; ++i) w.line(xyz(3.7 * i, 0.3 * i * i), 71.0);
  const auto path = w.take();
  const auto plan = planned(path, machine);
  for (const auto& row : plan.segments) {
    CHECK(row.end_u_s == 0.0);
    const double ticks = row.end_time_s / 0.001;
    CHECK(std::fabs(ticks - std::floor(ticks + 0.5)) < 1e-9);
  }
}

TEST_CASE("whole ticks cost less than one control tick per run and keep the corner speed") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    auto machine = plain_machine();
    machine.clock.control_tick = Ticks{40000};  // 4 ms
    ProgramWriter w(machine);
    w.line(xyz(random.between(0.01, 30.0)), random.between(5.0, 100.0));
    w.line(xyz(random.between(31.0, 60.0), random.between(1.0, 20.0)), random.between(5.0, 100.0));
    const auto path = w.take();
    const auto whole = planned(path, machine);
    machine.planner.whole_ticks = false;
    const auto free = planned(path, machine);
    CHECK(whole.law.duration_s >= free.law.duration_s * (1.0 - 1e-12));
    CHECK(whole.law.duration_s < free.law.duration_s + 0.004);
  }
}

TEST_CASE(
    "an arc under a jerk limit keeps axis acceleration and jerk together, at v^3/R^2 = 0.4 j when that "
    "binds") {
  auto machine = plain_machine();
  machine.planner.whole_ticks = false;
  for (auto& axis : machine.axis) axis.max_accel_u_s2 = 1e6;
  ProgramWriter w(machine, xyz(5, 0));
  w.arc(gcode::Plane::xy, 0.0, 0.0, 20, xyz(5, 0), 400.0);
  const auto path = w.take();
  const double v = planned(path, machine).segments[0].peak_u_s;
  CHECK(v * v * v / 25.0 == near(0.4 * 40000.0));
}

TEST_CASE("facets of 0.2 mm on a circle of 10 mm at 50 mm/s do not crawl") {
  // corners of 0.02 rad allow 2/0.02 = 100 mm/s: the whole way at 50 except for the two ramps of 2 sqrt(50/40000) s
  const auto machine = plain_machine();
  ProgramWriter w(machine, xyz(10, 0));
  const int n = 300;
  double length = 0.0;
  AxisValues last = xyz(10, 0);
  for (int i = 1; i <= n; ++i) {
    const SinCos a = exact_sincos(0.02 * i);
    const AxisValues p = xyz(std::floor(1e4 * a.cos + 0.5) / 1e3, std::floor(1e4 * a.sin + 0.5) / 1e3);
    length += std::sqrt((p[0] - last[0]) * (p[0] - last[0]) + (p[1] - last[1]) * (p[1] - last[1]));
    w.line(p, 50.0);
    last = p;
  }
  const auto path = w.take();
  const double ideal = length / 50.0 + 2.0 * std::sqrt(50.0 / 40000.0);
  CHECK(planned(path, machine).law.duration_s < 1.01 * ideal);
}

TEST_CASE("the reasons in the table name what held the feed") {
  auto machine = plain_machine();
  machine.axis[1].max_feed_u_s = 30.0;
  machine.path.max_feed_mm_s = 90.0;
  ProgramWriter w(machine);
  w.line(xyz(50, 0), 60.0);    // program
  w.line(xyz(50, 50), 60.0);   // Y is slow
  w.line(xyz(0, 50), 1000.0);  // path limit
  w.line(xyz(0, 49.9), 20.0);  // too short
  w.rapid(xyz(100, 49.9));
  const auto path = w.take();
  const auto plan = planned(path, machine);
  using planner::LimitedBy;
  CHECK(plan.segments[0].limited_by == LimitedBy::program);
  CHECK(plan.segments[1].limited_by == LimitedBy::axis_speed);
  CHECK(plan.segments[1].limiting_axis == 1);
  CHECK(plan.segments[2].limited_by == LimitedBy::path_feed);
  CHECK((plan.segments[3].limited_by == LimitedBy::junction ||
         plan.segments[3].limited_by == LimitedBy::length));
  CHECK(plan.segments[4].limited_by == LimitedBy::rapid);
  CHECK(planner::kLimitedBy.word(LimitedBy::path_feed) == "path feed");
}

TEST_CASE("the same path gives the same law to the bit, and a path without motion an empty one") {
  const auto machine = plain_machine();
  const auto make = [&] {
    Random random(7);
    AxisValues end{};
    return *planner::plan(random_path(random, machine, end), machine);
  };
  const auto a = make(), b = make();
  REQUIRE(a.law.pieces.size() == b.law.pieces.size());
  for (std::size_t i = 0; i < a.law.pieces.size(); ++i) {
    CHECK(a.law.pieces[i].begin_s == b.law.pieces[i].begin_s);
    CHECK(a.law.pieces[i].s_u == b.law.pieces[i].s_u);
  }
  ProgramWriter w(machine);
  const auto path = w.take();
  const auto plan = planner::plan(path, machine);
  REQUIRE(plan);
  CHECK(plan->law.pieces.empty());
  CHECK(planner::LawSource(plan->law, machine).finished());
  CHECK(planner::verify(path, *plan, machine).empty());
}

}  // namespace kadr::test
