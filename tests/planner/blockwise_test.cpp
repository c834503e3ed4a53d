#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <string>

#include "machine/machine.h"
#include "verified_plan.h"

// The scheduler of paper 003, a = 2000 mm/s2, j = 40000 mm/s3, tau = 1 ms: each block by itself.
namespace kadr::test {
namespace {

using machine::BlockTicks;
using planner::FeedPlan;
using planner::Path;
using planner::SegmentPlan;
using planner::TickRule;

machine::MachineModel block_machine(BlockTicks ticks = BlockTicks::exact) {
  auto m = plain_machine();
  m.planner.scheduler = machine::SchedulerKind::blockwise;
  m.planner.block_ticks = ticks;
  return m;
}

double largest_jump(const FeedPlan& plan) {
  double jump = 0.0;
  for (const SegmentPlan& row : plan.segments) jump = std::max(jump, std::fabs(row.end_jump_u_s));
  return jump;
}

}  // namespace

TEST_CASE("block by block, 100 mm at F6000 take 1100 control ticks exactly") {
  for (const BlockTicks ticks : {BlockTicks::exact, BlockTicks::kl}) {
    const auto machine = block_machine(ticks);
    const auto path = straight(100.0, 1, machine);
    const auto plan = planned(path, machine);
    CHECK(plan.law.duration_s == 1100 * 0.001);
    CHECK(plan.segments[0].peak_u_s == near(100.0));
    CHECK(plan.segments[0].rule == TickRule::none);
  }
}

// 40 mm in equal collinear blocks: the cost of acceleration zero, and of whole ticks, at every boundary.
// The figures are those of a prototype in another language that applies the same rules. Its own table has
// 0.628, 0.846, 1.437, 2.654 and 4.440 s for whole ticks: it takes T(F_HK = 0) = 0 instead of infinity, so
// that the first block, which begins at rest, is scaled by kl where rule c works (F_KK a little lower). With
// that fixed it gives the times below, to the tick; all later blocks depend on the first one's exit.
TEST_CASE("40 mm in short blocks cost what acceleration zero and whole ticks at each boundary cost") {
  struct Row {
    int blocks;
    double free_s, exact_s, kl_s, jump_mm_s;
  };
  const Row rows[] = {{8, 0.500, 0.500, 0.500, 0.0},    {20, 0.580, 0.631, 0.588, 3.15},
                      {40, 0.719, 0.880, 0.740, 5.07},  {80, 0.901, 1.362, 0.942, 6.37},
                      {200, 1.219, 2.848, 1.332, 6.45}, {400, 1.534, 4.442, 1.714, 8.26}};
  for (const Row& row : rows) {
    CAPTURE(row.blocks);
    auto machine = block_machine();
    const auto path = straight(40.0, row.blocks, machine);
    const auto exact = planned(path, machine);
    machine.planner.block_ticks = BlockTicks::kl;
    const auto kl = planned(path, machine);
    machine.planner.whole_ticks = false;
    const auto free = planned(path, machine);
    MESSAGE(row.blocks << " blocks: free " << free.law.duration_s << ", exact " << exact.law.duration_s
                       << ", kl " << kl.law.duration_s << " s with jumps up to " << largest_jump(kl));
    CHECK(std::fabs(free.law.duration_s - row.free_s) <= 0.0006);
    CHECK(std::fabs(kl.law.duration_s - row.kl_s) <= 0.0006);
    CHECK(std::fabs(exact.law.duration_s - row.exact_s) <= 0.0006);
    CHECK(std::fabs(largest_jump(kl) - row.jump_mm_s) <= 0.006);
  }
}

TEST_CASE("without a jerk limit blocks cost nothing: the free plan lasts as long as the chained one") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    auto machine = trapezoid_machine();
    AxisValues end{};
    const Path path = random_path(random, machine, end);
    if (path.size() == 0) continue;
    const double chained = planned(path, machine).law.duration_s;
    machine.planner.scheduler = machine::SchedulerKind::blockwise;
    CHECK(planned(path, machine).law.duration_s == near(chained));
  }
}

TEST_CASE("blocks shorter than a control tick take one each and lose no length: 20 x 0.03 mm") {
  // 0.03 mm at 100 mm/s would last 0.3 ms; in 1 ms they pass at 30 mm/s
  const auto machine = block_machine();
  const auto path = tiny_blocks(machine);
  const auto plan = planned(path, machine);
  for (std::size_t i = 1; i <= 20; ++i) {
    const SegmentPlan& row = plan.segments[i];
    CHECK(row.end_time_s - row.begin_time_s >= 0.001 * (1.0 - 1e-9));
    std::size_t hint = 0;
    const double s = plan.law.eval(row.end_time_s, hint).s_u;
    CHECK(std::fabs(s - path.start_s_u[i + 1]) <= 1e-12);
  }
}

TEST_CASE("a motion's time from a block on is what its plan takes") {
  for (const bool whole : {true, false}) {
    auto machine = block_machine();
    machine.planner.whole_ticks = whole;
    ProgramWriter w(machine);
    w.line(xyz(10), 80.0);
    w.line(xyz(17, 3), 60.0);
    w.stop();
    w.line(xyz(17, 20), 90.0);
    w.line(xyz(20, 20), 90.0);
    const auto path = w.take();
    const auto plan = planned(path, machine);
    const double begin = plan.segments[2].begin_time_s;
    CHECK(*planner::motion_time_s(path, machine, 0) == near(plan.law.duration_s));
    CHECK(*planner::motion_time_s(path, machine, 2) == near(plan.law.duration_s - begin));
  }
}

TEST_CASE("a jump of feed at a block's end is a violation unless the plan states it and kl explains it") {
  const auto machine = block_machine(BlockTicks::kl);
  const auto path = straight(40.0, 80, machine);
  const auto plan = planned(path, machine);
  REQUIRE(largest_jump(plan) > 6.0);
  const auto damaged = [&](const std::function<void(SegmentPlan&)>& damage) {
    FeedPlan other = plan;
    for (SegmentPlan& row : other.segments) damage(row);
    return other;
  };
  const auto silent = damaged([](SegmentPlan& row) { row.end_jump_u_s = 0.0; });
  CHECK(finds(path, silent, machine, "continuity of speed"));
  const auto unexplained = damaged([](SegmentPlan& row) { row.kl = 1.0; });
  CHECK(finds(path, unexplained, machine, "continuity of speed"));
  const auto exaggerated = damaged([](SegmentPlan& row) { row.end_jump_u_s *= 1.001; });
  CHECK(finds(path, exaggerated, machine, "continuity of speed"));
  const auto unruly = damaged([](SegmentPlan& row) { row.rule = TickRule::lower_main; });
  CHECK(finds(path, unruly, machine, "kl"));
  // ramps over many blocks may not jump at all
  CHECK(finds(path, plan, plain_machine(), "continuity of speed"));
}

TEST_CASE("a chained plan is none of blocks: ticks, acceleration and pieces do not end with them") {
  const auto path = straight(40.0, 80, plain_machine());
  const auto plan = planned(path, plain_machine());
  const auto machine = block_machine();
  for (const std::string what : {"whole ticks", "block end inside a piece", "acceleration at a block end"})
    CHECK_MESSAGE(finds(path, plan, machine, what), what);
}

}  // namespace kadr::test
