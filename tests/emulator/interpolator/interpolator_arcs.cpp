#include <doctest/doctest.h>

#include <string>

#include "interpolator_paths.h"
#include "machine/machine.h"
#include "planner/path/path.h"

using namespace kadr;
using namespace kadr::test;

namespace {

void check_ends(const planner::Path& path, const machine::MachineModel& machine, const Run& run) {
  for (std::size_t k = 0; k < machine.axis.size(); ++k) {
    const double step = machine.axis[k].step_u;
    const std::int64_t begin = lattice_node(path.node(0)[k], step);
    const std::int64_t end = lattice_node(path.node(path.size())[k], step);
    CHECK(run.nodes[k] == end);
    CHECK(run.net[k] == end - begin);
    CHECK(run.worst_steps[k] <= 0.5 + 1e-9);
  }
}

}  // namespace

TEST_CASE(
    "a full circle of R steps has 4 R pulses on each axis, closes, and clockwise mirrors counter-clockwise") {
  const auto machine = machine_with(2, 1.0);
  for (const int radius : {1, 2, 7, 30, 300}) {
    std::string orders[2];
    for (const int way : {0, 1}) {
      PathMaker maker({static_cast<double>(radius), 0.0});
      maker.arc(0, 1, -radius, 0.0, way == 0 ? 2 * kPi : -2 * kPi, 0.0, {0.0, 0.0});
      const Run run =
          run_path(maker.path, machine, drive(maker.path.length_u(), 1e3, machine, Feed::linear, 1));
      CHECK(run.pulses == std::vector<std::int64_t>{4 * radius, 4 * radius});
      check_ends(maker.path, machine, run);
      for (const auto& e : run.events)
        orders[way] += e.axis == 0 ? (e.sign > 0 ? 'X' : 'x') : ((e.sign > 0) == (way == 0) ? 'Y' : 'y');
    }
    // ties go by axis number both ways, and the mirror image has none moved
    CHECK(orders[0] == orders[1]);
    if (radius == 7) CHECK(orders[0].substr(0, 3) == "YYY");
  }
}

TEST_CASE("a quarter of 10 mm radius crosses the first half-steps where cosine and sine say") {
  // x = 10 cos(phi): 9.9995 at phi = acos(0.99995) = 0.0100000417; y = 0.0005 at phi = asin(0.00005); s = 10 phi
  const auto machine = machine_with(2);
  PathMaker maker({10.0, 0.0});
  maker.arc(0, 1, -10.0, 0.0, 0.5 * kPi, 0.0, {0.0, 0.0});
  const Run run = run_path(maker.path, machine, drive(maker.path.length_u(), 50.0, machine, Feed::linear, 1));
  CHECK(run.pulses == std::vector<std::int64_t>{10'000, 10'000});
  CHECK(run.events[0].axis == 1);
  CHECK(run.events[0].s_u == doctest::Approx(10.0 * std::asin(0.00005)).epsilon(1e-13));
  double first_x = 0;
  for (const auto& e : run.events)
    if (e.axis == 0) {
      first_x = e.s_u;
      break;
    }
  CHECK(first_x == doctest::Approx(10.0 * std::acos(0.99995)).epsilon(1e-12));
}

TEST_CASE(
    "an extreme exactly on a half-step belongs to the upper node: up and down again at a maximum, nothing at "
    "a minimum") {
  const auto machine = machine_with(2, 1.0);
  // radius 10.5 about 0: from -90 degrees, the maximum x = 10.5 is node 11, the minimum -10.5 is node -10
  PathMaker right({0.0, -10.5});
  right.arc(0, 1, 0.0, 10.5, kPi, 0.0, {0.0, 0.0});
  const Run up = run_path(right.path, machine, drive(right.path.length_u(), 1e3, machine, Feed::linear, 1));
  CHECK(up.pulses[0] == 22);
  PathMaker left({0.0, -10.5});
  left.arc(0, 1, 0.0, 10.5, -kPi, 0.0, {0.0, 0.0});
  const Run down = run_path(left.path, machine, drive(left.path.length_u(), 1e3, machine, Feed::linear, 1));
  CHECK(down.pulses[0] == 20);
}

TEST_CASE("a helix of 1000 turns has 1000 times the pulses of one turn and keeps every node") {
  const auto machine = machine_with(3, 0.01);
  PathMaker maker({1.0, 0.0, 0.0});
  maker.arc(0, 1, -1.0, 0.0, 1000 * 2 * kPi, 0.0, {0.0, 0.0, -50.0});
  const Run run =
      run_path(maker.path, machine, drive(maker.path.length_u(), 200.0, machine, Feed::linear, 1));
  // radius 100 steps: 400 pulses per turn and axis
  CHECK(run.pulses == std::vector<std::int64_t>{400'000, 400'000, 5'000});
  check_ends(maker.path, machine, run);
}

TEST_CASE("a million turns cost no memory and count exactly") {
  const auto machine = machine_with(2, 0.01);
  PathMaker maker({0.02, 0.0});
  maker.arc(0, 1, -0.02, 0.0, 1e6 * 2 * kPi, 0.0, {0.0, 0.0});
  interpolator::CrossingInterpolator interpolator(maker.path, machine);
  StepBatch batch;
  std::int64_t pulses = 0;
  for (const auto& m : drive(maker.path.length_u(), 50'000.0, machine, Feed::linear, 1)) {
    interpolator.advance(m, batch);
    pulses += static_cast<std::int64_t>(batch.axis[0].count());
  }
  CHECK(pulses == 8'000'000);
  CHECK(interpolator.position_steps() == std::vector<std::int64_t>{2, 0});
}

TEST_CASE("random arcs end on their exact node") {
  Dice dice(environment_count("KADR_SEED", 11));
  const std::uint64_t count = environment_count("KADR_COUNT", 60'000);
  std::uint64_t missed = 0;
  double worst = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto machine = machine_with(3, dice.chance(0.5) ? 0.01 : dice.between(0.001, 0.02));
    PathMaker maker({dice.between(-5, 5), dice.between(-5, 5), 0.0});
    const double growth = dice.chance(0.5) ? 0.0 : dice.between(-0.01, 0.01);
    const double sweep = dice.between(0.001, 7.0) * (dice.chance(0.5) ? 1 : -1);
    maker.arc(0, 1, dice.between(-1, 1), dice.between(-1, 1), sweep, growth,
              {0.0, 0.0, dice.between(-0.2, 0.2)});
    // every third is checked node by node, the others for their counts alone
    const auto motions = drive(maker.path.length_u(), 100.0, machine, Feed::linear, i);
    interpolator::CrossingInterpolator interpolator(maker.path, machine);
    interpolator.set_self_check(i % 3 == 0);
    StepBatch batch;
    for (const auto& m : motions) interpolator.advance(m, batch);
    for (std::size_t k = 0; k < 3; ++k) {
      if (interpolator.position_steps()[k] != lattice_node(maker.at[k], machine.axis[k].step_u)) ++missed;
      worst = std::max(worst, interpolator.worst_node_error_steps()[k]);
    }
  }
  CHECK(missed == 0);
  CHECK(worst <= 0.5 + 1e-9);
  CHECK(worst > 0.4999);
}

TEST_CASE("spirals from rounding to a doubled radius cross exactly, from 0.3 to 40 radians") {
  Dice dice(environment_count("KADR_SEED", 12));
  const auto machine = machine_with(2, 0.01);
  for (int round = 0; round < 400; ++round) {
    PathMaker maker({dice.between(-5, 5), dice.between(-5, 5)});
    const double radius = std::pow(10.0, dice.between(-2, 1));
    const double growth = radius * std::pow(10.0, dice.between(-12, 0)) * (dice.chance(0.5) ? 1 : -1);
    const double angle = dice.between(-kPi, kPi);
    maker.arc(0, 1, radius * std::cos(angle), radius * std::sin(angle),
              dice.between(0.3, 40.0) * (dice.chance(0.5) ? 1 : -1), growth, {0.0, 0.0});
    const Run run =
        run_path(maker.path, machine, drive(maker.path.length_u(), 100.0, machine, Feed::wild, 5));
    check_ends(maker.path, machine, run);
    std::vector<std::int64_t> node{lattice_node(maker.path.node(0)[0], 0.01),
                                   lattice_node(maker.path.node(0)[1], 0.01)};
    for (const auto& e : run.events) {
      auto& n = node[static_cast<std::size_t>(e.axis)];
      const long double level = static_cast<long double>(n) + 0.5L * e.sign;
      n += e.sign;
      CHECK(std::fabs(static_cast<double>(exact_position(maker.path, e.segment, e.axis, e.s_u) / 0.01L -
                                          level)) <= 1e-9);
    }
  }
}
