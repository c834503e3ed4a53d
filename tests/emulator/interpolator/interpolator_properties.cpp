#include <doctest/doctest.h>

#include <tuple>

#include "interpolator_paths.h"
#include "machine/machine.h"
#include "planner/path/path.h"

using namespace kadr;
using namespace kadr::test;

namespace {

/// Difficult coordinates: anywhere, on nodes, on half-steps, unchanged, slightly off.
double coordinate(Dice& dice, double from, double step_u, double reach_u) {
  switch (dice.whole(0, 5)) {
    case 0:
      return from;
    case 1:
      return static_cast<double>(lattice_node(from + dice.between(-reach_u, reach_u), step_u)) * step_u;
    case 2:
      return (static_cast<double>(lattice_node(from + dice.between(-reach_u, reach_u), step_u)) + 0.5) *
             step_u;
    case 3:
      return from + dice.between(-1e-6, 1e-6);
    default:
      return from + dice.between(-reach_u, reach_u);
  }
}

struct Case {
  machine::MachineModel machine;
  planner::Path path;
};

Case random_case(Dice& dice) {
  const int axes = dice.whole(1, 9);
  const auto n = static_cast<std::size_t>(axes);
  const double steps[] = {0.001, 0.0025, 0.01, 0.25};
  machine::MachineModel machine = machine_with(axes);
  for (auto& axis : machine.axis) axis.step_u = steps[dice.whole(0, 3)];
  const double far = dice.chance(0.1) ? 1e5 : 100.0;
  std::vector<double> start(n);
  for (std::size_t k = 0; k < n; ++k)
    start[k] = coordinate(dice, dice.between(-far, far), machine.axis[k].step_u, 1.0);
  PathMaker maker(start);
  const int segments = dice.whole(1, 12);
  for (int i = 0; i < segments; ++i) {
    std::vector<double> end(n);
    const double reach = dice.chance(0.2) ? 1e-6 : dice.between(0.01, 2.0);
    for (std::size_t k = 0; k < n; ++k) end[k] = coordinate(dice, maker.at[k], machine.axis[k].step_u, reach);
    if (axes < 2 || dice.chance(0.5)) {
      maker.line(end);
      continue;
    }
    const int first = dice.whole(0, axes - 1), second = (first + dice.whole(1, axes - 1)) % axes;
    const bool full = dice.chance(0.2);
    const double sweep = full ? 2 * kPi * dice.whole(1, 3) : dice.between(0.01, 8.0);
    const double growth = dice.chance(0.5) ? 0.0 : dice.between(-0.01, 0.01);
    double a = dice.between(-reach, reach), b = dice.chance(0.3) ? 0.0 : dice.between(-reach, reach);
    if (a == 0.0) a = 0.5 * reach;
    maker.arc(first, second, a, b, dice.chance(0.5) ? sweep : -sweep, growth, end);
  }
  if (maker.path.size() == 0) {
    std::vector<double> end = maker.at;
    end[0] += 0.5;
    maker.line(end);
  }
  return {std::move(machine), std::move(maker.path)};
}

/// Which pulses and in which order: everything but time.
std::vector<std::tuple<std::size_t, std::int32_t, std::int32_t, double>> sequence(const Run& run) {
  std::vector<std::tuple<std::size_t, std::int32_t, std::int32_t, double>> all;
  for (const auto& e : run.events) all.emplace_back(e.segment, e.axis, e.sign, e.s_u);
  return all;
}

/// Rounding of coordinates and of path length, in steps: positions closer than that cannot be told apart.
double blur_steps(const Case& c, std::size_t axis) {
  double reach = c.path.length_u();
  for (std::size_t i = 0; i <= c.path.size(); ++i) reach = std::max(reach, std::fabs(c.path.node(i)[axis]));
  return 1e-9 + 8 * 2.2e-16 * (reach + 10.0) / c.machine.axis[axis].step_u;
}

/// Every event lies on its half-level, and between the events the node is the nearest one.
void check_against_exact_path(const Case& c, const Run& run) {
  const std::size_t axes = c.machine.axis.size();
  std::vector<std::int64_t> node(axes);
  for (std::size_t k = 0; k < axes; ++k) node[k] = lattice_node(c.path.node(0)[k], c.machine.axis[k].step_u);
  std::size_t next = 0;
  for (std::size_t segment = 0; segment < c.path.size(); ++segment) {
    const double length = c.path.segments[segment].length_u;
    for (int sample = 0; sample <= 40; ++sample) {
      const double s = sample == 40 ? length : length * sample / 40.0;
      for (; next < run.events.size() && run.events[next].segment == segment && run.events[next].s_u <= s;
           ++next) {
        const auto& e = run.events[next];
        const auto k = static_cast<std::size_t>(e.axis);
        const long double x = exact_position(c.path, segment, e.axis, e.s_u) / c.machine.axis[k].step_u;
        const long double level = static_cast<long double>(node[k]) + 0.5L * e.sign;
        CHECK(std::fabs(static_cast<double>(x - level)) <= blur_steps(c, k));
        node[k] += e.sign;
      }
      for (std::size_t k = 0; k < axes; ++k) {
        const long double x =
            exact_position(c.path, segment, static_cast<int>(k), s) / c.machine.axis[k].step_u;
        CHECK(std::fabs(static_cast<double>(x - static_cast<long double>(node[k]))) <=
              0.5 + blur_steps(c, k));
      }
    }
  }
  CHECK(next == run.events.size());
}

}  // namespace

TEST_CASE(
    "random paths in 1 to 9 axes: counts exact, every node within half a step, order the same at any feed") {
  const std::uint64_t seed = environment_count("KADR_SEED", 1);
  const std::uint64_t count = environment_count("KADR_COUNT", 300);
  for (std::uint64_t i = 0; i < count; ++i) {
    CAPTURE(seed);
    CAPTURE(i);
    Dice dice(seed * 1'000'003 + i);
    const Case c = random_case(dice);
    const double length = c.path.length_u(), speed = dice.between(5.0, 60.0);
    const Run run = run_path(c.path, c.machine, drive(length, speed, c.machine, Feed::linear, i), true);
    for (std::size_t k = 0; k < c.machine.axis.size(); ++k) {
      const double step = c.machine.axis[k].step_u;
      CHECK(run.nodes[k] == lattice_node(c.path.node(c.path.size())[k], step));
      CHECK(run.net[k] == run.nodes[k] - lattice_node(c.path.node(0)[k], step));
      CHECK(run.worst_steps[k] <= 0.5 + 1e-9);
    }
    check_against_exact_path(c, run);
    for (const StepBatch& batch : run.batches)
      for (const AxisPulses& pulses : batch.axis) {
        CHECK(std::is_sorted(pulses.offset_ticks.begin(), pulses.offset_ticks.end()));
        CHECK((pulses.count() == 0 || pulses.offset_ticks.back() < 10'000));
      }
    // the same geometry under other motions
    const auto expected = sequence(run);
    const Run half = run_path(c.path, c.machine, drive(length, 0.5 * speed, c.machine, Feed::linear, i));
    const Run held = run_path(c.path, c.machine, drive(length, speed, c.machine, Feed::constant, i));
    const Run wild = run_path(c.path, c.machine, drive(length, speed, c.machine, Feed::wild, i));
    CHECK(sequence(half) == expected);
    CHECK(sequence(held) == expected);
    CHECK(sequence(wild) == expected);
    for (const Run* other : {&half, &held, &wild})
      for (const double worst : other->worst_steps) CHECK(worst <= 0.5 + 1e-9);
    if (run.events.size() > 100) CHECK(half.hash != run.hash);
  }
}

TEST_CASE("commands chain from tick to tick and are exact on the nodes at rest") {
  for (std::uint64_t i = 0; i < 100; ++i) {
    Dice dice(i + 77);
    const Case c = random_case(dice);
    const Run run =
        run_path(c.path, c.machine, drive(c.path.length_u(), 30.0, c.machine, Feed::wild, i), true);
    for (std::size_t k = 0; k < c.machine.axis.size(); ++k) {
      double position = c.path.node(0)[k];
      std::int64_t node = lattice_node(position, c.machine.axis[k].step_u);
      for (const StepBatch& batch : run.batches) {
        const AxisCommand& command = batch.axis[k].command;
        CHECK(command.position_begin_u == position);
        position = command.position_end_u;
        node += batch.axis[k].net_steps().value;
        CHECK(std::fabs(position / c.machine.axis[k].step_u - static_cast<double>(node)) <=
              0.5 + blur_steps(c, k));
      }
      CHECK(position == c.path.node(c.path.size())[k]);
    }
  }
}

TEST_CASE("command speeds are the change of command positions") {
  // constant path speed: on lines the speed is exact, on arcs the mean of both ends is, to second order
  Dice dice(5);
  const auto machine = machine_with(3);
  PathMaker maker({0.0, 0.0, 0.0});
  maker.arc(0, 1, 20.0, 5.0, 4.0, 0.01, {0.0, 0.0, 3.0});
  const Run run =
      run_path(maker.path, machine, drive(maker.path.length_u(), 40.0, machine, Feed::linear, 1), true);
  for (std::size_t i = 2; i + 2 < run.batches.size(); ++i)
    for (const AxisPulses& pulses : run.batches[i].axis) {
      const AxisCommand& c = pulses.command;
      const double mean = 0.5 * (c.speed_begin_u_s + c.speed_end_u_s);
      CHECK(std::fabs((c.position_end_u - c.position_begin_u) / 1e-3 - mean) <= 1e-4);
    }
}

TEST_CASE("a path driven backwards has the same crossings in reversed order") {
  Dice dice(environment_count("KADR_SEED", 21));
  for (int round = 0; round < 200; ++round) {
    const auto machine = machine_with(3, 0.01);
    std::vector<std::vector<double>> corners{{dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1)}};
    for (int i = 0; i < 4; ++i)
      corners.push_back({dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1)});
    PathMaker there(corners.front()), back(corners.back());
    for (std::size_t i = 1; i < corners.size(); ++i) there.line(corners[i]);
    for (std::size_t i = corners.size() - 1; i-- > 0;) back.line(corners[i]);
    const Run forward =
        run_path(there.path, machine, drive(there.path.length_u(), 20.0, machine, Feed::linear, 1));
    const Run reverse =
        run_path(back.path, machine, drive(back.path.length_u(), 20.0, machine, Feed::linear, 1));
    REQUIRE(forward.events.size() == reverse.events.size());
    const std::size_t n = forward.events.size();
    for (std::size_t i = 0; i < n; ++i) {
      CHECK(forward.events[i].axis == reverse.events[n - 1 - i].axis);
      CHECK(forward.events[i].sign == -reverse.events[n - 1 - i].sign);
    }
  }
}

TEST_CASE("ten thousand segments of 1e-6 mm in one tick add up to ten steps") {
  const auto machine = machine_with(2);
  PathMaker maker({0.0, 0.0});
  for (int i = 1; i <= 10'000; ++i) maker.line({1e-6 * i, i % 2 == 0 ? 0.0 : 1e-6});
  const Run run = run_path(maker.path, machine, drive(maker.path.length_u(), 40.0, machine, Feed::linear, 1));
  CHECK(run.net == std::vector<std::int64_t>{10, 0});
  CHECK(run.pulses == std::vector<std::int64_t>{10, 0});
}

TEST_CASE("the step hash names pulses, directions, axes and ticks, and skips ticks without pulses") {
  StepBatch one;
  one.axis.resize(2);
  one.tick = ControlTicks{7};
  one.axis[0].offset_ticks = {10, 20, 30};
  const auto digest = [](std::initializer_list<StepBatch> batches) {
    StepHash hash;
    for (const StepBatch& b : batches) hash.add(b);
    return hash.digest();
  };
  const std::uint64_t base = digest({one});
  StepBatch empty;
  empty.axis.resize(2);
  empty.tick = ControlTicks{3};
  CHECK(digest({empty, one, empty}) == base);
  StepBatch other = one;
  other.tick = ControlTicks{8};
  CHECK(digest({other}) != base);
  other = one;
  other.axis[0].first_sign = -1;
  CHECK(digest({other}) != base);
  other = one;
  other.axis[0].reversals = {1};
  CHECK(digest({other}) != base);
  other = one;
  std::swap(other.axis[0], other.axis[1]);
  CHECK(digest({other}) != base);
  other = one;
  other.axis[0].offset_ticks[2] = 31;
  CHECK(digest({other}) != base);
}

TEST_CASE("the step stream of 40 fixed random paths is the same with every compiler and optimisation") {
  StepHash hash;
  for (std::uint64_t i = 0; i < 40; ++i) {
    Dice dice(i + 4000);
    const Case c = random_case(dice);
    interpolator::CrossingInterpolator interpolator(c.path, c.machine);
    StepBatch batch;
    for (const auto& m : drive(c.path.length_u(), 20.0, c.machine, Feed::wild, i)) {
      interpolator.advance(m, batch);
      hash.add(batch);
    }
  }
  CHECK(hash.digest() == 0xd2de30514a2d40a3u);
}
