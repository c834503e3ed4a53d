#include "reference_law.h"

#include "machine/base/numbers.h"

namespace kadr::planner {
namespace {

constexpr double kLength_mm = 2846.9;

}  // namespace

ReferenceLaw::ReferenceLaw(std::size_t nodes)
    : axes{{0.20, 0.60, {{0.060, 1.0, 0.40}, {0.006, 3.0, 1.10}}, {{0.840, 2020.0, 500.0}}},
           {-0.35, -1.20, {{0.060, 1.5, 2.10}, {0.005, 4.0, 0.30}}, {{-0.430, 2500.0, 330.0}}},
           {0.80, 1.30, {{0.070, 1.5, 0.90}, {0.006, 4.0, 2.60}}, {{0.400, 420.0, 300.0}}},
           {0.00, 1.70, {{0.030, 2.0, 1.70}, {0.003, 5.0, 0.20}}, {{0.030, 1750.0, 180.0}}},
           {0.60, -1.90, {{0.030, 2.0, 0.00}, {0.003, 5.0, 1.30}}, {{-0.030, 560.0, 180.0}}},
           {-0.10, 2.90, {{0.060, 2.0, 2.90}, {0.006, 5.0, 0.70}}, {{0.060, 2330.0, 180.0}}},
           {100.0, 1500.0, {{160.0, 1.0, 1.20}, {30.0, 3.0, 0.50}}, {}}} {
  problem.max_feed_u_s = {1.396, 1.309, 1.222, 1.230, 1.229, 1.914, 1866.667};
  problem.max_accel_u_s2 = {1.414, 1.239, 1.239, 0.611, 0.611, 0.943, 1240.0};
  problem.path_feed_u_s = 750.0;
  problem.path_accel_u_s2 = 2000.0;
  problem.zones = {{854.27, 854.27, 200.0}, {1300.0, 1300.0, 300.0}};
  place(nodes);
}

ReferenceLaw ReferenceLaw::random(std::uint32_t seed, std::size_t nodes) {
  ReferenceLaw out;
  const auto unit = [&seed] {
    seed = seed * 1664525u + 1013904223u;
    return static_cast<double>(seed >> 8) / 16777216.0;
  };
  for (FormulaAxis& axis : out.axes) {
    axis.slope *= 0.6 + 0.8 * unit();
    for (FormulaAxis::Wave& wave : axis.waves) {
      wave.amplitude *= 0.3 + 1.7 * unit();
      wave.phase_rad = 2.0 * kPi * unit();
    }
    for (FormulaAxis::Step& step : axis.steps) {
      step.height *= 0.3 + 1.2 * unit();
      step.at_u = 200.0 + 2400.0 * unit();
    }
  }
  out.problem.accel_test = AccelTest::end_node;
  out.place(nodes);
  return out;
}

void ReferenceLaw::place(std::size_t nodes) { sample(axes, kLength_mm, nodes, problem); }

ReferenceLaw paper_law(std::size_t nodes) {
  ReferenceLaw out(nodes);
  out.problem.accel_test = AccelTest::end_node;
  return out;
}

}  // namespace kadr::planner
