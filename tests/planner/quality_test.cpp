#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "machine/machine.h"
#include "planner_support.h"

// How good the plans are: against a lower bound that no planner can beat, and against the optimum without jerk limit.
namespace kadr::test {
namespace {

/// Facets of a random smooth curve with grid rounding, all axes alike.
planner::Path smooth_path(Random& random, const machine::MachineModel& machine, double step, int n,
                          double feed) {
  ProgramWriter w(machine);
  double angle = 0.0, turn = 0.0, x = 0.0, y = 0.0;
  for (int i = 0; i < n; ++i) {
    turn = 0.95 * turn + random.between(-0.01, 0.01);
    angle += turn;
    const SinCos d = exact_sincos(angle);
    x += step * d.cos;
    y += step * d.sin;
    w.line(xyz(std::floor(x * 1e4 + 0.5) / 1e4, std::floor(y * 1e4 + 0.5) / 1e4), feed);
  }
  return w.take();
}

/// Time optimum under the same caps with acceleration limits alone, on a grid of `grid` cells per segment:
/// forward and backward pass over v^2 in cells of constant acceleration. A lower bound for every jerk-limited
/// plan. Caps are computed again here: program, axis speed and junction rule of straight segments.
double accel_optimum_s(const planner::Path& path, const machine::MachineModel& machine, int grid) {
  const std::size_t n = path.size();
  const std::size_t cells = n * static_cast<std::size_t>(grid);
  std::vector<double> cap2(cells + 1, kInfinity), accel(cells), length(cells);
  const double tau = machine.clock.tau_s();
  std::vector<double> before(machine.axis.size(), 0.0), tangent(machine.axis.size());
  for (std::size_t i = 0; i < n; ++i) {
    double v = path.segments[i].feed_u_s, a = kInfinity, corner = i == 0 ? 0.0 : kInfinity;
    for (std::size_t j = 0; j < tangent.size(); ++j) {
      const auto& axis = machine.axis[j];
      tangent[j] = (path.node(i + 1)[j] - path.node(i)[j]) / path.segments[i].length_u;
      const double e = std::fabs(tangent[j]);
      if (e > 0.0) v = std::min(v, axis.max_feed_u_s / e), a = std::min(a, axis.max_accel_u_s2 / e);
      const double turn = std::fabs(tangent[j] - before[j]);
      if (i > 0 && turn > 0.0) corner = std::min(corner, axis.junction_accel_u_s2 * tau / turn);
    }
    before = tangent;
    const std::size_t first = i * static_cast<std::size_t>(grid);
    for (std::size_t k = first; k < first + static_cast<std::size_t>(grid); ++k) {
      accel[k] = a;
      length[k] = path.segments[i].length_u / grid;
      cap2[k] = std::min(cap2[k], v * v);
      cap2[k + 1] = std::min(cap2[k + 1], v * v);
    }
    cap2[first] = std::min(cap2[first], corner * corner);
  }
  cap2[cells] = 0.0;
  for (std::size_t k = 0; k < cells; ++k)
    cap2[k + 1] = std::min(cap2[k + 1], cap2[k] + 2.0 * accel[k] * length[k]);
  for (std::size_t k = cells; k-- > 0;) cap2[k] = std::min(cap2[k], cap2[k + 1] + 2.0 * accel[k] * length[k]);
  double time = 0.0;
  for (std::size_t k = 0; k < cells; ++k) {
    time += 2.0 * length[k] / (std::sqrt(cap2[k]) + std::sqrt(cap2[k + 1]));
  }
  return time;
}

}  // namespace

// The reference has no jerk limit, so a part of the ratio can't be had by any plan.
TEST_CASE(
    "on smooth curves of short facets the plan takes at most 1.4 times the optimum without jerk limit") {
  double worst = 0.0, sum = 0.0;
  const std::uint64_t seed = environment("KADR_SEED", 1),
                      count = std::min<std::uint64_t>(environment("KADR_COUNT", 40), 400);
  for (std::uint64_t i = 0; i < count; ++i) {
    Random random(seed + i);
    auto machine = plain_machine();
    machine.planner.whole_ticks = false;
    const double step = random.decades(0.05, 1.0);
    const auto path =
        smooth_path(random, machine, step, static_cast<int>(200.0 / step), random.between(30.0, 100.0));
    const auto plan = planner::plan(path, machine);
    REQUIRE(plan);
    CHECK(planner::verify(path, *plan, machine).empty());
    const double bound = accel_optimum_s(path, machine, 20);
    const double ratio = plan->law.duration_s / bound;
    CHECK(ratio >= 0.999);
    worst = std::max(worst, ratio);
    sum += ratio;
  }
  MESSAGE("time over the optimum without jerk limit: worst " << worst << ", mean "
                                                             << sum / static_cast<double>(count));
  CHECK(worst <= 1.4);
  CHECK(sum / static_cast<double>(count) <= 1.12);
}

TEST_CASE("no plan is faster than length over the highest feed plus what the two ramps cost") {
  // from rest to w and back costs at least T(w) more than passing at w: T - S/w = T/2 per ramp
  for (std::uint64_t i = 0; i < 200; ++i) {
    Random random(1000 + i);
    auto machine = plain_machine();
    machine.planner.whole_ticks = random.chance(0.5);
    ProgramWriter w(machine);
    const double feed = random.between(5.0, 100.0);
    const int n = 1 + random.below(40);
    for (int k = 0; k < n; ++k)
      w.line(xyz(w.at()[0] + random.decades(0.01, 20.0), 0.0, 0.0),
             feed * (k == 0 ? 1.0 : random.between(0.3, 1.0)));
    const auto path = w.take();
    const auto plan = planner::plan(path, machine);
    REQUIRE(plan);
    double ideal = 0.0;
    for (const auto& seg : path.segments) ideal += seg.length_u / seg.feed_u_s;
    CHECK(plan->law.duration_s >= ideal);
    double peak = 0.0;
    for (const auto& row : plan->segments) peak = std::max(peak, row.peak_u_s);
    const double ramp = peak <= 100.0 ? 2.0 * std::sqrt(peak / 40000.0) : peak / 2000.0 + 0.05;
    CHECK(plan->law.duration_s >= path.length_u() / peak + ramp - 1e-9);
  }
}

}  // namespace kadr::test
