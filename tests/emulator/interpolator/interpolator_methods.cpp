#include <doctest/doctest.h>

#include "emulator/interpolator/lattice/lattice.h"
#include "interpolator_paths.h"
#include "machine/machine.h"
#include "planner/path/path.h"

using namespace kadr;
using namespace kadr::test;
using machine::StepMethod;
namespace lattice = interpolator::lattice;

namespace {

constexpr StepMethod kAll[] = {
    StepMethod::classic,       StepMethod::half_step,       StepMethod::diagonal,
    StepMethod::extra_points,  StepMethod::octant_midpoint, StepMethod::dda,
    StepMethod::dda_preloaded, StepMethod::dda_sequential,  StepMethod::dda_simultaneous,
    StepMethod::progression,   StepMethod::chords,          StepMethod::ptp};

std::vector<planner::TickMotion> steady(const planner::Path& path, const machine::MachineModel& machine) {
  return drive(path.length_u(), 20.0, machine, Feed::wild, 3);
}

/// Nodes after each slot of the lattice's own trace, from the origin.
std::vector<std::array<std::int64_t, 2>> lattice_nodes(const lattice::Curve& curve, lattice::Method method) {
  const auto made = lattice::make_stepper(curve, method);
  REQUIRE(made.stepper);
  std::vector<std::array<std::int64_t, 2>> nodes;
  std::array<std::int64_t, 2> at{};
  for (lattice::Slot slot; made.stepper->next(slot);) {
    at[0] += slot.step[0];
    at[1] += slot.step[1];
    nodes.push_back(at);
  }
  return nodes;
}

/// Nodes of a run after all pulses of one position.
std::vector<std::array<std::int64_t, 2>> run_nodes(const Run& run) {
  std::vector<std::array<std::int64_t, 2>> nodes;
  std::array<std::int64_t, 2> at{};
  for (std::size_t i = 0; i < run.events.size(); ++i) {
    const auto& e = run.events[i];
    at[static_cast<std::size_t>(e.axis)] += e.sign;
    if (i + 1 == run.events.size() || run.events[i + 1].s_u != e.s_u) nodes.push_back(at);
  }
  return nodes;
}

}  // namespace

TEST_CASE("a run by any method of paper 002 ends on the program's nodes, whatever the feed") {
  const std::uint64_t count = environment_count("KADR_COUNT", 20);
  for (const StepMethod method : kAll)
    for (std::uint64_t i = 0; i < count; ++i) {
      CAPTURE(static_cast<int>(method));
      CAPTURE(i);
      Dice dice(i * 31 + 7);
      auto machine = machine_with(3, 0.01);
      machine.interpolator = method;
      PathMaker maker({0, 0, 0});
      for (int n = dice.whole(1, 4); n > 0; --n) {
        std::vector<double> end = maker.at;
        for (double& x : end) x += 0.01 * dice.whole(-200, 200);
        if (dice.chance(0.5))
          maker.line(end);
        else
          // a full turn about a node; helices are left to the crossings
          maker.arc(0, 1, 0.01 * dice.whole(20, 100), 0.01 * dice.whole(-50, 50), 2 * kPi, 0.0, maker.at);
      }
      const Run run = run_path(maker.path, machine, steady(maker.path, machine));
      for (std::size_t k = 0; k < 3; ++k) CHECK(run.net[k] == lattice_node(maker.at[k], 0.01));
    }
}

TEST_CASE("the pulses of a run are the lattice's, one slot after the other, evenly along the segment") {
  auto machine = machine_with(2, 0.01);
  PathMaker maker({0, 0});
  maker.line({10, 6.18});
  for (const auto& [step, method] : {std::pair(StepMethod::classic, lattice::Method::classic),
                                     std::pair(StepMethod::half_step, lattice::Method::half_step),
                                     std::pair(StepMethod::diagonal, lattice::Method::diagonal),
                                     std::pair(StepMethod::extra_points, lattice::Method::extra_points),
                                     std::pair(StepMethod::progression, lattice::Method::progression)}) {
    machine.interpolator = step;
    const Run run = run_path(maker.path, machine, steady(maker.path, machine));
    const auto expected = lattice_nodes(lattice::LineCurve{2, {1000, 618}}, method);
    CHECK(run_nodes(run) == expected);
    // slots lie L/N apart
    const double slot_u = maker.path.length_u() / static_cast<double>(expected.size());
    double off = 0;
    for (const auto& e : run.events) {
      const double place = e.s_u / slot_u - 0.5;
      off = std::max(off, std::fabs(place - std::floor(place + 0.5)));
    }
    CHECK(off < 1e-6);
  }
  PathMaker circle({0.5, 0});
  circle.arc(0, 1, -0.5, 0, 2 * kPi, 0.0, {0.5, 0});
  machine.interpolator = StepMethod::half_step;
  const Run run = run_path(circle.path, machine, steady(circle.path, machine));
  CHECK(run_nodes(run) == lattice_nodes(lattice::ArcCurve{{50, 0}, {50, 0}}, lattice::Method::half_step));
  CHECK(run.events.size() == 8 * 50);
}

TEST_CASE("one slot a step modulates even the leading axis 2 : 1, crossings do not") {
  // interpolators of paper 002: line 1000 x 618 by half_step, X every 1 or 2 slots, Y every 2 or 3
  auto machine = machine_with(2, 0.01);
  PathMaker maker({0, 0});
  maker.line({10, 6.18});
  const auto spacing = [&](StepMethod method, int axis) {
    machine.interpolator = method;
    const Run run = run_path(maker.path, machine, steady(maker.path, machine));
    double last = -1, least = 1e300, most = 0;
    for (const auto& e : run.events) {
      if (e.axis != axis) continue;
      if (last >= 0) least = std::min(least, e.s_u - last), most = std::max(most, e.s_u - last);
      last = e.s_u;
    }
    return most / least;
  };
  CHECK(spacing(StepMethod::half_step, 0) == doctest::Approx(2));
  CHECK(spacing(StepMethod::half_step, 1) == doctest::Approx(1.5));
  CHECK(spacing(StepMethod::diagonal, 0) == doctest::Approx(1));
  CHECK(spacing(StepMethod::diagonal, 1) == doctest::Approx(2));
  CHECK(spacing(StepMethod::crossing, 0) == doctest::Approx(1));
  CHECK(spacing(StepMethod::crossing, 1) == doctest::Approx(1));
}

TEST_CASE(
    "what a method does not follow is left to the crossings: helices, curves, unequal steps, odd centres") {
  const auto same = [](const planner::Path& path, machine::MachineModel machine) {
    const auto motions = steady(path, machine);
    const std::uint64_t crossing = run_path(path, machine, motions).hash;
    machine.interpolator = StepMethod::half_step;
    return run_path(path, machine, motions).hash == crossing;
  };
  const auto machine = machine_with(3, 0.01);
  PathMaker helix({0, 0, 0});
  helix.arc(0, 1, 1, 0, 2 * kPi, 0.0, {0, 0, 1});
  CHECK(same(helix.path, machine));
  PathMaker odd({0, 0, 0});
  odd.arc(0, 1, 1.005, 0, 2 * kPi, 0.0, {0, 0, 0});
  CHECK(same(odd.path, machine));
  PathMaker arc({0, 0, 0});
  arc.arc(0, 1, 1, 0, 2 * kPi, 0.0, {0, 0, 0});
  CHECK_FALSE(same(arc.path, machine));
  auto unequal = machine;
  unequal.axis[1].step_u = 0.005;
  CHECK(same(arc.path, unequal));
}
