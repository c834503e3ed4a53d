#include <doctest/doctest.h>

#include "emulator/interpolator/lattice/bezier_events.h"
#include "gcode/block.h"
#include "interpolator_paths.h"
#include "machine/machine.h"
#include "planner/planner.h"

using namespace kadr;
using namespace kadr::test;

namespace {

planner::Path curve_path(const std::vector<double>& control, std::size_t axes) {
  planner::Path path(static_cast<int>(axes));
  path.curves.emplace_back(control, axes);
  planner::PathSegment segment;
  segment.kind = planner::SegmentKind::curve;
  segment.shape = 0;
  segment.length_u = segment.feed_length_u = path.curves[0].length_u();
  path.segments.push_back(segment);
  path.start_s_u = {0.0, segment.length_u};
  path.nodes_u.assign(control.begin(), control.begin() + static_cast<std::ptrdiff_t>(axes));
  path.nodes_u.insert(path.nodes_u.end(), control.end() - static_cast<std::ptrdiff_t>(axes), control.end());
  return path;
}

struct Moment {
  double t = 0;
  int sign = 1;
};
using Moments = std::vector<Moment>;

/// An extreme that just touches the middle between two nodes may step out and in again, or not: both are
/// within half a step.
void add_moment(Moments& moments, Moment m) {
  if (!moments.empty() && moments.back().sign != m.sign && m.t - moments.back().t < 1e-6)
    moments.pop_back();
  else
    moments.push_back(m);
}

}  // namespace

TEST_CASE("curves of degree 2 to 5 in 2 to 6 axes keep every node within half a step and end on the step") {
  const std::uint64_t seed = environment_count("KADR_SEED", 1), count = environment_count("KADR_COUNT", 120);
  for (std::uint64_t i = 0; i < count; ++i) {
    CAPTURE(seed);
    CAPTURE(i);
    Dice dice(seed * 6151 + i);
    const int axes = dice.whole(2, 6);
    const auto machine = machine_with(axes, dice.chance(0.5) ? 0.001 : 0.01);
    std::vector<double> control;
    for (int p = dice.whole(3, 6); p > 0; --p)
      for (int k = 0; k < axes; ++k) control.push_back(dice.between(-2, 2));
    const planner::Path path = curve_path(control, static_cast<std::size_t>(axes));
    const Run wild = run_path(path, machine, drive(path.length_u(), 40.0, machine, Feed::wild, i));
    const Run steady = run_path(path, machine, drive(path.length_u(), 25.0, machine, Feed::constant, i));
    for (std::size_t k = 0; k < static_cast<std::size_t>(axes); ++k) {
      const double step = machine.axis[k].step_u;
      CHECK(wild.net[k] == lattice_node(path.node(1)[k], step) - lattice_node(path.node(0)[k], step));
      CHECK(wild.worst_steps[k] <= 0.5 + 1e-9);
      CHECK(steady.worst_steps[k] <= 0.5 + 1e-9);
    }
    // which pulses there are, and where, is geometry alone
    REQUIRE(wild.events.size() == steady.events.size());
    bool same = true;
    for (std::size_t e = 0; e < wild.events.size(); ++e)
      same = same && wild.events[e].axis == steady.events[e].axis &&
             wild.events[e].sign == steady.events[e].sign && wild.events[e].s_u == steady.events[e].s_u;
    CHECK(same);
  }
}

TEST_CASE("the pulses along a curve are those of the lattice's Bezier events, in the same order") {
  const std::uint64_t seed = environment_count("KADR_SEED", 1), count = environment_count("KADR_COUNT", 60);
  for (std::uint64_t i = 0; i < count; ++i) {
    CAPTURE(i);
    Dice dice(seed * 9973 + i);
    const auto machine = machine_with(3, 0.01);
    interpolator::lattice::BezierCurve lattice;
    lattice.axes = 3;
    lattice.degree = dice.whole(2, 3);
    std::vector<double> control;
    for (int p = 0; p <= lattice.degree; ++p)
      for (std::size_t k = 0; k < 3; ++k) {
        const int node = dice.whole(-150, 150);
        lattice.control[static_cast<std::size_t>(p)][k] = node;
        control.push_back(node * 0.01);
      }
    const planner::Path path = curve_path(control, 3);
    const Run run = run_path(path, machine, drive(path.length_u(), 5.0, machine, Feed::linear, i));
    // by axis: events of two axes at one position may swap by rounding
    std::array<Moments, 3> of_run, of_lattice;
    for (const auto& e : run.events)
      add_moment(of_run[static_cast<std::size_t>(e.axis)], {path.curves[0].t(e.s_u), e.sign});
    interpolator::lattice::BezierEvents events(lattice);
    interpolator::lattice::BezierEvents::Event event;
    while (events.next(event)) add_moment(of_lattice[event.axis], {event.t, event.direction});
    for (std::size_t k = 0; k < 3; ++k) {
      REQUIRE(of_run[k].size() == of_lattice[k].size());
      double off = 0;
      bool same = true;
      for (std::size_t n = 0; n < of_run[k].size(); ++n) {
        off = std::max(off, std::fabs(of_run[k][n].t - of_lattice[k][n].t));
        same = same && of_run[k][n].sign == of_lattice[k][n].sign;
      }
      CHECK(same);
      CHECK(off < 1e-7);
    }
  }
}

TEST_CASE("rounded corners and dense lines run from the program to the last step") {
  auto machine = machine_with(3);
  for (auto& axis : machine.axis) {
    axis.max_feed_u_s = 200;
    axis.max_accel_u_s2 = 2000;
    axis.max_jerk_u_s3 = 50'000;
    axis.junction_accel_u_s2 = 500;
  }
  planner::PathBuilder builder(machine, {});
  gcode::Feed block;
  block.feed_u_s = 30;
  block.path_mode = gcode::PathMode::continuous;
  block.path_tolerance_mm = 0.05;
  for (int i = 1; i <= 40; ++i) {
    const SinCos at = exact_sincos(2 * kPi * i / 40);
    block.end = {5 - 5 * at.cos, 5 * at.sin, 0.01 * i, 0, 0, 0, 0, 0, 0};
    builder.add({{}, block});
  }
  block.end[0] -= 4;
  builder.add({{}, block});
  const planner::Path path = builder.take();
  CHECK(path.smoothing.corners == 1);
  CHECK(path.smoothing.curves == 40);
  const auto plan = planner::plan(path, machine);
  REQUIRE(plan);
  planner::LawSource source(plan->law, machine);
  std::vector<planner::TickMotion> motions;
  while (!source.finished()) motions.push_back(source.advance({}));
  const Run run = run_path(path, machine, motions);
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(run.net[k] == lattice_node(block.end[k], machine.axis[k].step_u));
    CHECK(run.worst_steps[k] <= 0.5 + 1e-9);
  }
}
