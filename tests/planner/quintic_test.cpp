#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "machine/machine.h"
#include "planner/scheduler/block_diagram.h"
#include "verified_plan.h"

// planner.law = quintic, a = 2000 mm/s2, j = 40000 mm/s3: ramps v = v0 + dv (10 x^3 - 15 x^4 + 6 x^5) of
// T = max(1.875 dv/a, sqrt(10/sqrt(3) dv/j)), whose jerk does not jump.
namespace kadr::test {
namespace {

using planner::FeedPlan;
using planner::Path;
using planner::RampLimits;

const RampLimits kQuintic{2000.0, 40000.0, machine::RampLaw::quintic};

machine::MachineModel quintic_machine(machine::SchedulerKind scheduler = machine::SchedulerKind::chained) {
  auto m = plain_machine();
  m.planner.law = machine::RampLaw::quintic;
  m.planner.scheduler = scheduler;
  return m;
}

}  // namespace

TEST_CASE("a quintic ramp 0 -> 100 mm/s lasts 120.14 ms over 6.007 mm, or 187.5 ms where a = 1000 binds") {
  // sqrt(5.773503 * 100 / 40000) = 0.1201406; 1.875 * 100 / 2000 = 0.09375 is less
  CHECK(planner::ramp_time_s(100.0, kQuintic) == doctest::Approx(0.1201406).epsilon(1e-6));
  CHECK(planner::ramp_length_u(0.0, 100.0, kQuintic) == doctest::Approx(6.00703).epsilon(1e-6));
  CHECK(planner::ramp_time_s(100.0, {1000.0, 40000.0, machine::RampLaw::quintic}) == near(0.1875));
}

TEST_CASE("100 mm at F6000 with quintic ramps: 1.12014 s and 1121 control ticks, jerk zero at both ends") {
  auto machine = quintic_machine();
  const auto path = straight(100.0, 1, machine);
  CHECK(planned(path, machine).law.duration_s == 1121 * 0.001);
  machine.planner.whole_ticks = false;
  const auto plan = planned(path, machine);
  const double ramp = planner::ramp_time_s(100.0, kQuintic);
  // the ramps take T/2 longer each than their path at 100 mm/s
  CHECK(plan.law.duration_s == near(1.0 + ramp));
  std::size_t hint = 0;
  const auto at = [&](double x) { return plan.law.eval(x * ramp, hint); };
  CHECK(at(0.0).jerk_u_s3 == 0.0);
  CHECK(at(0.5).speed_u_s == near(50.0));
  // s = dv T x^4 (2.5 - 3 x + x^2) = 100 T (2.5 - 1.5 + 0.25) / 16
  CHECK(at(0.5).s_u == near(100.0 * ramp * 1.25 / 16.0));
  CHECK(at(0.5).accel_u_s2 == near(1.875 * 100.0 / ramp));
  CHECK(at(0.5 - std::sqrt(1.0 / 12.0)).jerk_u_s3 == near(40000.0));
  CHECK(at(0.5 + std::sqrt(1.0 / 12.0)).jerk_u_s3 == near(-40000.0));
  CHECK(plan.law.pieces.size() == 3);
}

TEST_CASE("cutting a line into pieces costs quintic ramps nothing") {
  const auto machine = quintic_machine();
  const double one = planned(straight(40.0, 1, machine), machine).law.duration_s;
  CHECK(planned(straight(40.0, 400, machine), machine).law.duration_s == one);
}

// times of a prototype in another language, as in blockwise_test.cpp
TEST_CASE("block by block with quintic ramps 40 mm take what the prototype says") {
  struct Row {
    int blocks;
    double free_s;
    int exact_ticks, kl_ticks;
  };
  for (const Row& row : {Row{1, 0.520141, 521, 521}, Row{8, 0.530719, 539, 534}, Row{20, 0.652445, 683, 666},
                         Row{40, 0.813025, 1010, 832}, Row{80, 1.018640, 1536, 1062},
                         Row{200, 1.377845, 2864, 1472}, Row{400, 1.734014, 4847, 1940}}) {
    CAPTURE(row.blocks);
    auto machine = quintic_machine(machine::SchedulerKind::blockwise);
    const auto path = straight(40.0, row.blocks, machine);
    CHECK(planned(path, machine).law.duration_s == near(row.exact_ticks * 0.001));
    machine.planner.block_ticks = machine::BlockTicks::kl;
    CHECK(planned(path, machine).law.duration_s == near(row.kl_ticks * 0.001));
    machine.planner.whole_ticks = false;
    CHECK(planned(path, machine).law.duration_s == doctest::Approx(row.free_s).epsilon(1e-6));
  }
}

TEST_CASE("the lowest quintic exit: every higher one fits, and a little lower one does not") {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    const RampLimits limits{random.decades(200.0, 20000.0), random.decades(2000.0, 1e6),
                            random.chance(0.8) ? machine::RampLaw::quintic : machine::RampLaw::jerk_limited};
    const double v0 = random.decades(1.0, 300.0);
    const double way = planner::ramp_length_u(v0 * random.unit(), v0, limits) * random.between(0.3, 1.2);
    const double lowest = planner::lowest_exit_u_s(v0, way, limits);
    CAPTURE(seed);
    for (int i = 0; i <= 1000; ++i) {
      const double exit = lowest + (v0 - lowest) * i / 1000.0;
      if (planner::ramp_length_u(exit, v0, limits) > way * (1.0 + 1e-12)) FAIL_CHECK(exit << " " << lowest);
    }
    if (lowest > 0.0) CHECK(planner::ramp_length_u(lowest - 1e-6 * (v0 - lowest), v0, limits) > way);
  }
}

TEST_CASE("quintic ramps are judged as what they are: 10 % less jerk or acceleration, or jerk that jumps") {
  auto machine = quintic_machine();
  const auto path = straight(100.0, 1, machine);
  const auto plan = planned(path, machine);
  auto strict = machine;
  for (auto& axis : strict.axis) axis.max_jerk_u_s3 *= 0.9;
  CHECK(finds(path, plan, strict, "axis jerk"));
  strict = machine;
  for (auto& axis : strict.axis) axis.max_accel_u_s2 = 1550.0;  // the ramp has 1.875 * 100 / T = 1560.7
  CHECK(finds(path, plan, strict, "axis acceleration"));
  const auto constant_jerk = planned(path, plain_machine());
  CHECK(finds(path, constant_jerk, machine, "continuity of jerk"));
  FeedPlan damaged = plan;
  damaged.law.pieces[0].quintic_rise_u_s += 1e-4;
  CHECK(finds(path, damaged, machine, "continuity of speed"));
}

TEST_CASE("a held feed reports its largest distance from a quintic law") {
  auto machine = quintic_machine();
  machine.planner.tick_feed = machine::TickFeed::constant;
  const auto path = straight(20.0, 1, machine);
  const auto plan = planned(path, machine);
  planner::LawSource source(plan.law, machine);
  std::size_t hint = 0;
  double worst = 0.0;
  while (!source.finished()) {
    const planner::TickMotion m = source.advance({});
    double sampled = 0.0;
    for (int k = 0; k <= 200; ++k) {
      const double s = m.s_begin_u + m.ramp_begin_u_s * 0.001 * k / 200.0;
      const double time = (static_cast<double>(m.tick.value) + k / 200.0) * 0.001;
      sampled = std::max(sampled, std::fabs(s - plan.law.eval(time, hint).s_u));
    }
    CHECK(sampled <= m.held_error_u + 1e-12);
    CHECK(m.held_error_u <= sampled * 1.001 + 1e-12);
    worst = std::max(worst, m.held_error_u);
  }
  // a tau^2 / 8 at the largest acceleration of 1560.7 mm/s2 is 0.195 um
  CHECK(worst == doctest::Approx(1560.7e-6 / 8.0).epsilon(0.01));
}

// Seed and count from KADR_SEED and KADR_COUNT, as in fuzz_test.cpp.
TEST_CASE("random programs with quintic ramps break no limit, chained and block by block") {
  const std::uint64_t seed = environment("KADR_SEED", 1);
  const std::uint64_t count = environment("KADR_COUNT", 200);
  for (std::uint64_t i = 0; i < count; ++i) {
    Random random(seed + i);
    machine::MachineModel machine = random_machine(random);
    machine.planner.law = machine::RampLaw::quintic;
    for (auto& axis : machine.axis)
      if (axis.max_jerk_u_s3 == kInfinity) axis.max_jerk_u_s3 = random.decades(2000.0, 2e6);
    if (machine.path.max_jerk_mm_s3 == kInfinity) machine.path.max_jerk_mm_s3 = random.decades(2000.0, 2e6);
    AxisValues end{};
    const Path path = random_path(random, machine, end);
    for (const auto scheduler : {machine::SchedulerKind::chained, machine::SchedulerKind::blockwise}) {
      machine.planner.scheduler = scheduler;
      const auto plan = planner::plan(path, machine);
      REQUIRE_MESSAGE(plan, plan.error().diagnostic.message << ": " << plan.error().diagnostic.label);
      for (const planner::Violation& v : planner::verify(path, *plan, machine))
        FAIL_CHECK(fmt::format("seed {}, scheduler {}: {} at {} s, segment {}, axis {}: {} (limit {})",
                               seed + i, static_cast<int>(scheduler), v.what, v.time_s, v.segment, v.axis,
                               v.value, v.limit));
    }
  }
}

}  // namespace kadr::test
