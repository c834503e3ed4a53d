#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>

#include "machine/machine.h"
#include "planner_support.h"

// Block by block on random programs. Seed and count from KADR_SEED and KADR_COUNT, as in fuzz_test.cpp.
namespace kadr::test {
namespace {

using planner::FeedPlan;
using planner::JerkPiece;
using planner::Path;
using planner::TickRule;

struct Found {
  std::uint64_t blocks = 0;
  std::uint64_t rule[5] = {};
  double end_error_mm = 0, exit_error_mm_s = 0, jump_mm_s = 0;

  std::string text() const {
    return fmt::format(
        "{} blocks: rules a {}, b {}, c {}, d {}, whole or free {}; worst end {:.1e} mm, worst exit {:.1e} "
        "mm/s, largest stated jump {:.3f} mm/s",
        blocks, rule[1], rule[2], rule[3], rule[4], rule[0], end_error_mm, exit_error_mm_s, jump_mm_s);
  }
};

double end_speed(const JerkPiece& p) {
  return p.speed_u_s + p.duration_s * (p.accel_u_s2 + 0.5 * p.duration_s * p.jerk_u_s3);
}
double end_place(const JerkPiece& p) {
  const double t = p.duration_s;
  return p.s_u + t * (p.speed_u_s + t * (0.5 * p.accel_u_s2 + t * p.jerk_u_s3 / 6.0));
}

/// Where each block's last piece really ends, against where and how fast it should.
void measure(const Path& path, const FeedPlan& plan, Found& found) {
  std::size_t k = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const planner::SegmentPlan& row = plan.segments[i];
    while (k < plan.law.pieces.size() && plan.law.pieces[k].begin_s < row.end_time_s) ++k;
    const JerkPiece& last = plan.law.pieces[k - 1];
    ++found.blocks;
    ++found.rule[static_cast<std::size_t>(row.rule)];
    found.end_error_mm = std::max(found.end_error_mm, std::fabs(end_place(last) - path.start_s_u[i + 1]));
    found.exit_error_mm_s = std::max(found.exit_error_mm_s, std::fabs(end_speed(last) - row.end_u_s));
    found.jump_mm_s = std::max(found.jump_mm_s, std::fabs(row.end_jump_u_s));
    const bool scaled =
        row.rule == TickRule::scale || (i + 1 < path.size() && plan.segments[i + 1].rule == TickRule::scale);
    if (!scaled) CHECK(row.end_jump_u_s == 0.0);
  }
}

/// Lines of 0.1 to 100 mm at 10 to 150 mm/s, straight on or at small and large angles.
Path random_lines(Random& random, const machine::MachineModel& machine) {
  static constexpr double kAngles_rad[] = {0, 0, 0, 0.01, 0.1, 1.5};
  static constexpr double kFeeds_mm_s[] = {10, 30, 60, 100, 150};
  ProgramWriter w(machine);
  const int n = 1 + random.below(12);
  for (int i = 0; i < n; ++i) {
    const double length = random.decades(0.1, 100.0);
    const SinCos d = exact_sincos(kAngles_rad[random.below(6)]);
    const double feed = kFeeds_mm_s[random.below(5)];
    w.line(xyz(w.at()[0] + length * d.cos, w.at()[1] + length * d.sin), feed);
  }
  return w.take();
}

void check_plan(const Path& path, const machine::MachineModel& machine, std::uint64_t seed, Found& found) {
  const auto plan = planner::plan(path, machine);
  REQUIRE_MESSAGE(plan, plan.error().diagnostic.message << ": " << plan.error().diagnostic.label);
  for (const planner::Violation& v : planner::verify(path, *plan, machine))
    FAIL_CHECK(fmt::format("seed {}: {} at {} s, segment {}, axis {}: {} (limit {})", seed, v.what, v.time_s,
                           v.segment, v.axis, v.value, v.limit));
  measure(path, *plan, found);
}

}  // namespace

TEST_CASE("10 000 random blocks end exactly where and as fast as planned, on whole ticks") {
  const std::uint64_t seed = environment("KADR_SEED", 1);
  const std::uint64_t count = environment("KADR_COUNT", 2000);
  for (const auto ticks : {machine::BlockTicks::exact, machine::BlockTicks::kl}) {
    Found found;
    for (std::uint64_t i = 0; i < count; ++i) {
      Random random(seed + i);
      auto machine = plain_machine();
      machine.planner.scheduler = machine::SchedulerKind::blockwise;
      machine.planner.block_ticks = ticks;
      check_plan(random_lines(random, machine), machine, seed + i, found);
    }
    MESSAGE(found.text());
    CHECK(found.blocks >= count);
    CHECK(found.end_error_mm <= 1e-9);
    CHECK(found.exit_error_mm_s <= 1e-9);
    if (ticks == machine::BlockTicks::kl && count >= 100) CHECK(found.jump_mm_s > 1.0);
  }
}

TEST_CASE("block by block, random programs on random machines break no limit") {
  const std::uint64_t seed = environment("KADR_SEED", 1);
  const std::uint64_t count = environment("KADR_COUNT", 300);
  Found found;
  for (std::uint64_t i = 0; i < count; ++i) {
    Random random(seed + i);
    machine::MachineModel machine = random_machine(random);
    machine.planner.scheduler = machine::SchedulerKind::blockwise;
    if ((seed + i) % 2 == 1) machine.planner.block_ticks = machine::BlockTicks::kl;
    AxisValues end{};
    const Path path = random_path(random, machine, end);
    CAPTURE(seed + i);
    if (path.size() > 0) check_plan(path, machine, seed + i, found);
  }
  MESSAGE(found.text());
}

}  // namespace kadr::test
