#include <doctest/doctest.h>

#include "gcode/block.h"
#include "interpolator_paths.h"
#include "machine/machine.h"
#include "planner/planner.h"

using namespace kadr;
using namespace kadr::test;

namespace {

/// Arc blocks as a program gives them: coordinates with three decimals, so that both radii differ by rounding.
gcode::Block random_block(Dice& dice, const AxisValues& at) {
  gcode::Arc block;
  block.feed_u_s = dice.between(5.0, 80.0);
  block.end = at;
  const auto rounded = [&dice](double low, double high) {
    return std::floor(dice.between(low, high) * 1e3 + 0.5) * 1e-3;
  };
  block.end[2] = at[2] + (dice.chance(0.5) ? 0.0 : rounded(-1, 1));
  if (dice.chance(0.5)) {
    block.end[0] = rounded(-5, 5);
    block.end[1] = rounded(-5, 5);
    return {{}, gcode::Feed{block}};
  }
  block.center_first_mm = at[0] + rounded(0.5, 3);
  block.center_second_mm = at[1] + rounded(-3, 3);
  const double dx = at[0] - block.center_first_mm, dy = at[1] - block.center_second_mm;
  const SinCos turned = exact_sincos(dice.between(0.1, 6.0));
  block.end[0] = std::floor((block.center_first_mm + dx * turned.cos - dy * turned.sin) * 1e3 + 0.5) * 1e-3;
  block.end[1] = std::floor((block.center_second_mm + dx * turned.sin + dy * turned.cos) * 1e3 + 0.5) * 1e-3;
  block.turns = dice.whole(1, 2) * (dice.chance(0.5) ? 1 : -1);
  return {{}, block};
}

}  // namespace

TEST_CASE(
    "arcs and lines with three decimals keep every node and end on the step, driven along the built path") {
  const std::uint64_t seed = environment_count("KADR_SEED", 1), count = environment_count("KADR_COUNT", 200);
  for (std::uint64_t i = 0; i < count; ++i) {
    CAPTURE(seed);
    CAPTURE(i);
    Dice dice(seed * 7919 + i);
    const auto machine = machine_with(3, dice.chance(0.5) ? 0.001 : 0.0025);
    AxisValues at{};
    planner::PathBuilder builder(machine, at);
    for (int n = dice.whole(1, 10); n > 0; --n) {
      const gcode::Block block = random_block(dice, at);
      builder.add(block);
      at = gcode::move_of(block)->end;
    }
    const planner::Path path = builder.take();
    const Run run = run_path(path, machine, drive(path.length_u(), 40.0, machine, Feed::wild, i));
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(run.net[k] == lattice_node(at[k], machine.axis[k].step_u));
      CHECK(run.nodes[k] == run.net[k]);
      CHECK(run.worst_steps[k] <= 0.5 + 1e-9);
    }
  }
}

TEST_CASE(
    "a planned law, played whole or with the feed held per tick, gives the sequence of any other motion") {
  const std::uint64_t seed = environment_count("KADR_SEED", 1), count = environment_count("KADR_COUNT", 60);
  for (std::uint64_t i = 0; i < count; ++i) {
    CAPTURE(seed);
    CAPTURE(i);
    Dice dice(seed * 104'729 + i);
    auto machine = machine_with(3);
    for (auto& axis : machine.axis) {
      axis.max_feed_u_s = 200;
      axis.max_accel_u_s2 = 2000;
      axis.max_jerk_u_s3 = dice.chance(0.5) ? 50'000.0 : machine::kInfinity;
      axis.junction_accel_u_s2 = 500;
    }
    machine.planner.whole_ticks = dice.chance(0.5);
    AxisValues at{};
    planner::PathBuilder builder(machine, at);
    for (int n = dice.whole(1, 10); n > 0; --n) {
      gcode::Block block = random_block(dice, at);
      if (dice.chance(0.2)) gcode::move_of(block)->path_mode = gcode::PathMode::exact_stop;
      builder.add(block);
      at = gcode::move_of(block)->end;
    }
    const planner::Path path = builder.take();
    const auto plan = planner::plan(path, machine);
    REQUIRE(plan.has_value());
    const Run any = run_path(path, machine, drive(path.length_u(), 40.0, machine, Feed::wild, i));
    for (const auto feed : {machine::TickFeed::linear, machine::TickFeed::constant}) {
      machine.planner.tick_feed = feed;
      planner::LawSource source(plan->law, machine);
      std::vector<planner::TickMotion> motions;
      while (!source.finished() && motions.size() < 100'000) motions.push_back(source.advance({}));
      const Run run = run_path(path, machine, motions);
      for (std::size_t k = 0; k < 3; ++k) {
        CHECK(run.net[k] == lattice_node(at[k], machine.axis[k].step_u));
        CHECK(run.worst_steps[k] <= 0.5 + 1e-9);
      }
      REQUIRE(run.events.size() == any.events.size());
      bool same = true;
      for (std::size_t e = 0; e < run.events.size(); ++e)
        same = same && run.events[e].segment == any.events[e].segment &&
               run.events[e].axis == any.events[e].axis && run.events[e].sign == any.events[e].sign &&
               run.events[e].s_u == any.events[e].s_u;
      CHECK(same);
    }
  }
}
