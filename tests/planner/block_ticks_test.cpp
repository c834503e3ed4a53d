#include <doctest/doctest.h>

#include <algorithm>

#include "machine/machine.h"
#include "planner/scheduler/block_diagram.h"
#include "planner_support.h"

// One block: its diagram and the rules that fill control ticks. a = 2000 mm/s2, j = 40000 mm/s3, so that a
// ramp by dv <= a^2/j = 100 mm/s lasts 2 sqrt(dv/j).
namespace kadr::test {
namespace {

using machine::BlockTicks;
using planner::BlockDiagram;
using planner::RampLimits;
using planner::TickRule;

const RampLimits kLimits{2000.0, 40000.0};

/// A block whose F_HK is what fits, up to `cap`.
BlockDiagram block(double length, double entry, double end, double cap) {
  BlockDiagram b;
  b.length_u = length;
  b.limits = kLimits;
  b.entry_u_s = entry;
  b.end_u_s = end;
  b.main_u_s = planner::peak_speed_u_s(entry, end, length, kLimits, std::max(entry, end), cap);
  return b;
}

/// Time and path of the elements that the block becomes.
struct Sum {
  double time_s = 0, length_u = 0;
};
Sum elements_of(const BlockDiagram& b) {
  std::vector<planner::Element> out;
  planner::append_elements(b, 0.0, 0.001, {}, out);
  Sum sum;
  for (const planner::Element& e : out) sum.time_s += e.time_s(), sum.length_u += e.length_u;
  return sum;
}

doctest::Approx close_to(double x) { return doctest::Approx(x).epsilon(1e-11); }

}  // namespace

TEST_CASE("reach: from 0 over 1 mm to 34.20 mm/s, from 5 to 32.88 only: starting slower ends faster") {
  // (v0 + v1)/2 * 2 sqrt((v1 - v0)/j) = 1:  from rest v1^3 = j, so v1 = 40000^(1/3) = 34.19952
  CHECK(planner::reach_speed_u_s(0.0, 1.0, kLimits, 1e9) == doctest::Approx(34.1995189).epsilon(1e-8));
  CHECK(planner::reach_speed_u_s(5.0, 1.0, kLimits, 1e9) == doctest::Approx(32.8786).epsilon(1e-5));
  CHECK(planner::reach_speed_u_s(5.0, 1.0, kLimits, 20.0) == 20.0);
}

TEST_CASE("the lowest exit stops at the longest braking path, although exits below it would fit again") {
  // from 60 mm/s: S(60 -> 20) = 40 * 2 sqrt(40/40000) = 2.5298 mm is the longest, S(60 -> 0) = 2.3238 mm
  CHECK(planner::ramp_length_u(20.0, 60.0, kLimits) == doctest::Approx(2.52982).epsilon(1e-5));
  CHECK(planner::lowest_exit_u_s(60.0, 2.53, kLimits) == 0.0);
  const double exit = planner::lowest_exit_u_s(60.0, 2.4, kLimits);
  CHECK(exit > 20.0);
  CHECK(planner::ramp_length_u(exit, 60.0, kLimits) == close_to(2.4));
  // from 300 mm/s full acceleration is reached: longest to a^2/2j = 50 mm/s
  const double longest = planner::ramp_length_u(50.0, 300.0, kLimits);
  CHECK(longest > planner::ramp_length_u(49.0, 300.0, kLimits));
  CHECK(longest > planner::ramp_length_u(51.0, 300.0, kLimits));
  CHECK(planner::lowest_exit_u_s(300.0, longest * 1.000001, kLimits) == 0.0);
  CHECK(planner::lowest_exit_u_s(300.0, longest * 0.99, kLimits) > 50.0);
  // without a jerk limit the path grows down to rest: v0^2 - v1^2 = 2 a d
  const RampLimits no_jerk{2000.0, kInfinity};
  CHECK(planner::lowest_exit_u_s(100.0, 1.0, no_jerk) == close_to(std::sqrt(100.0 * 100.0 - 4000.0)));
}

TEST_CASE("rule a lowers F_HK: 40 mm at 20 mm/s from rest to rest fill 2045 ticks in place of 2044.72") {
  BlockDiagram b = block(40.0, 0.0, 0.0, 20.0);
  CHECK(b.time_s() == close_to(2.0 + 2.0 * std::sqrt(20.0 / 40000.0)));
  planner::fill_block_ticks(b, 0.001, BlockTicks::exact);
  CHECK(b.rule == TickRule::lower_main);
  CHECK(b.ticks == 2045);
  // 40/w + 2 sqrt(w/j) = 2.045
  CHECK(40.0 / b.main_u_s + 2.0 * std::sqrt(b.main_u_s / 40000.0) == close_to(2.045));
  CHECK(elements_of(b).length_u == close_to(40.0));
}

TEST_CASE("rule b stretches a brake: from 60 to 20 mm/s over 3 mm, the exit stays") {
  // T(40) = 63.246 ms over 2.52982 mm, 0.47018 mm at 60 take 7.836 ms: 71.082 ms become 72.
  // T_r = 2 (60 * 0.072 - 3) / 40 = 66 ms over 2.64 mm, 6 ms at 60 before it
  BlockDiagram b = block(3.0, 60.0, 20.0, 60.0);
  planner::fill_block_ticks(b, 0.001, BlockTicks::exact);
  CHECK(b.rule == TickRule::stretch_brake);
  CHECK(b.ticks == 72);
  CHECK(b.end_u_s == 20.0);
  CHECK(b.brake_factor * planner::ramp_time_s(40.0, kLimits) == close_to(0.066));
  const Sum sum = elements_of(b);
  CHECK(sum.time_s == close_to(0.072));
  CHECK(sum.length_u == close_to(3.0));
}

TEST_CASE("rule c lowers F_KK: 1 mm at a constant 30 mm/s fills 34 ticks in place of 33.3") {
  BlockDiagram b = block(1.0, 30.0, 30.0, 30.0);
  planner::fill_block_ticks(b, 0.001, BlockTicks::exact);
  CHECK(b.rule == TickRule::lower_end);
  CHECK(b.ticks == 34);
  CHECK(b.main_u_s == 30.0);
  // hold and brake: L/v0 + T_r (v0 - v1)/(2 v0) = 0.034 with T_r = 2 sqrt((v0 - v1)/j)
  const double drop = 30.0 - b.end_u_s;
  CHECK(1.0 / 30.0 + drop * std::sqrt(drop / 40000.0) / 30.0 == close_to(0.034));
  CHECK(elements_of(b).time_s == close_to(0.034));
}

TEST_CASE("rule d scales: 0.15 mm at a constant 100 mm/s can't brake within 2 ticks, kl = 0.75") {
  BlockDiagram b = block(0.15, 100.0, 100.0, 100.0);
  planner::fill_block_ticks(b, 0.001, BlockTicks::exact);
  CHECK(b.rule == TickRule::scale);
  CHECK(b.ticks == 2);
  // m tau - T = 0.5 ms at 100 mm/s are 0.05 mm: kl = 0.15 / 0.2
  CHECK(b.kl == close_to(0.75));
  CHECK(b.end_u_s == 100.0);
  CHECK(elements_of(b).time_s == close_to(0.002));
  CHECK(elements_of(b).length_u == close_to(0.15));
}

TEST_CASE("kl for every block (eq. 3): the part of a tick that is left is spent at F_KK") {
  // 0 -> 50 mm/s: 70.711 ms over 1.76777 mm, then 3.23223 mm at 50 take 64.645 ms: 135.355 become 136
  BlockDiagram b = block(5.0, 0.0, 50.0, 50.0);
  const double left = 0.136 - b.time_s();
  CHECK(left == doctest::Approx(0.000645).epsilon(1e-3));
  planner::fill_block_ticks(b, 0.001, BlockTicks::kl);
  CHECK(b.rule == TickRule::scale);
  CHECK(b.kl == close_to(5.0 / (5.0 + 50.0 * left)));
  CHECK(elements_of(b).time_s == close_to(0.136));
  CHECK(elements_of(b).length_u == close_to(5.0));
  // a block that ends at rest stands for the rest of its tick, unscaled
  BlockDiagram stop = block(3.0, 60.0, 0.0, 60.0);
  const double time = stop.time_s();
  planner::fill_block_ticks(stop, 0.001, BlockTicks::kl);
  CHECK(stop.kl == 1.0);
  CHECK(elements_of(stop).time_s == close_to(time));
}

TEST_CASE("two passes are as fast as the best of a grid of boundary speeds, three blocks from rest to rest") {
  const std::uint64_t seed = environment("KADR_SEED", 1);
  const std::uint64_t count = std::min<std::uint64_t>(environment("KADR_COUNT", 60), 1000);
  constexpr int kGrid = 40;
  double worst = 0.0;
  for (std::uint64_t i = 0; i < count; ++i) {
    Random random(seed + i);
    auto machine = plain_machine();
    machine.planner.scheduler = machine::SchedulerKind::blockwise;
    machine.planner.whole_ticks = false;
    ProgramWriter w(machine);
    double length[3];
    for (double& l : length) {
      l = random.decades(0.1, 10.0);
      w.line(xyz(w.at()[0] + l), 100.0);
    }
    const auto path = w.take();
    const double planned = planner::plan(path, machine)->law.duration_s;
    const auto time = [&](double v0, double v1, double l) {
      const double low = std::min(v0, v1), high = std::max(v0, v1);
      return planner::ramp_length_u(low, high, kLimits) <= l ? block(l, v0, v1, 100.0).time_s() : kInfinity;
    };
    const double first = planner::reach_speed_u_s(0.0, length[0], kLimits, 100.0) / kGrid;
    const double second = planner::reach_speed_u_s(0.0, length[2], kLimits, 100.0) / kGrid;
    double best = kInfinity;
    for (int m = 1; m <= kGrid; ++m)
      for (int n = 1; n <= kGrid; ++n)
        best = std::min(best, time(0.0, m * first, length[0]) + time(m * first, n * second, length[1]) +
                                  time(n * second, 0.0, length[2]));
    worst = std::max(worst, planned / best - 1.0);
  }
  MESSAGE("slower than the grid's best by at most " << 100.0 * worst << " %");
  CHECK(worst <= 1e-3);
}

}  // namespace kadr::test
