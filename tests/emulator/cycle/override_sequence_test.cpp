#include <doctest/doctest.h>

#include "gcode/block.h"
#include "machine/machine.h"
#include "planner/planner.h"
#include "tests/emulator/interpolator/interpolator_paths.h"

using namespace kadr;
using namespace kadr::test;

namespace {

planner::Path random_program(Dice& dice, const machine::MachineModel& machine) {
  AxisValues at{};
  planner::PathBuilder builder(machine, at);
  for (int n = dice.whole(1, 12); n > 0; --n) {
    gcode::Arc block;
    const bool rapid = dice.chance(0.15);
    block.feed_u_s = dice.between(5.0, 120.0);
    block.end = at;
    for (std::size_t k = 0; k < 3; ++k)
      if (dice.chance(0.6)) block.end[k] = at[k] + dice.between(-4, 4) * (dice.chance(0.3) ? 0.01 : 1.0);
    const bool arc = dice.chance(0.35);
    if (arc) {
      block.center_first_mm = at[0] + dice.between(0.3, 3);
      block.center_second_mm = at[1] + dice.between(-2, 2);
      const double dx = at[0] - block.center_first_mm, dy = at[1] - block.center_second_mm;
      const SinCos turned = exact_sincos(dice.between(0.1, 6.0));
      block.end[0] = block.center_first_mm + dx * turned.cos - dy * turned.sin;
      block.end[1] = block.center_second_mm + dx * turned.sin + dy * turned.cos;
      block.turns = dice.chance(0.5) ? 1 : -1;
    }
    if (dice.chance(0.15)) block.path_mode = gcode::PathMode::exact_stop;
    block.feed_override_enabled = !dice.chance(0.1);
    builder.add({{},
                 arc     ? gcode::Action(block)
                 : rapid ? gcode::Action(gcode::Traverse{block})
                         : gcode::Action(gcode::Feed{block})});
    at = block.end;
  }
  return builder.take();
}

/// An operator with a wild hand: steps, S-shaped changes, a new value each tick, holds.
class WildHand {
 public:
  WildHand(std::uint64_t seed, double most) : dice_(seed), most_(most) {}
  planner::OperatorInput next() {
    if (left_-- <= 0) {
      kind_ = dice_.whole(0, 3);
      left_ = dice_.whole(3, 200);
      from_ = input_.feed_override;
      to_ = dice_.between(0.1, most_);
      step_ = 0;
      input_.hold = kind_ == 0 && dice_.chance(0.5);
      input_.rapid_override = dice_.between(0.2, 1.0);
    }
    if (kind_ == 1) input_.feed_override = to_;
    if (kind_ == 2) input_.feed_override = dice_.between(0.1, most_);
    if (kind_ == 3) {
      const double x = std::min(1.0, ++step_ / 60.0);
      input_.feed_override = from_ + (to_ - from_) * x * x * (3 - 2 * x);
    }
    return input_;
  }

 private:
  Dice dice_;
  double most_;
  planner::OperatorInput input_;
  int kind_ = 0, left_ = 0;
  double from_ = 1, to_ = 1, step_ = 0;
};

}  // namespace

TEST_CASE(
    "under any timeline every block emits the steps that it emits without one; only the stamps differ") {
  const std::uint64_t seed = environment_count("KADR_SEED", 1), count = environment_count("KADR_COUNT", 500);
  std::int64_t later = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    CAPTURE(seed);
    CAPTURE(i);
    Dice dice(seed * 15'485'863 + i);
    auto machine = machine_with(3, dice.chance(0.5) ? 0.01 : 0.004);
    for (auto& axis : machine.axis) {
      axis.max_feed_u_s = 150;
      axis.max_accel_u_s2 = 2000;
      axis.max_jerk_u_s3 = dice.chance(0.8) ? 50'000.0 : machine::kInfinity;
      axis.junction_accel_u_s2 = 1500;
    }
    machine.feed_override.mode = static_cast<machine::OverrideMode>(dice.whole(0, 2));
    machine.feed_override.limiter = static_cast<machine::LimiterKind>(dice.whole(0, 3));
    machine.feed_override.predictive = dice.chance(0.5);
    CAPTURE(static_cast<int>(machine.feed_override.mode));
    CAPTURE(static_cast<int>(machine.feed_override.limiter));
    const planner::Path path = random_program(dice, machine);
    using machine::PlanMethod;
    constexpr PlanMethod kMethods[] = {PlanMethod::scheduler, PlanMethod::tube, PlanMethod::certified};
    machine.planner.method = kMethods[std::max(dice.whole(-6, 2), 0)];
    CAPTURE(static_cast<int>(machine.planner.method));
    const auto plan = planner::plan(path, machine);
    REQUIRE(plan.has_value());
    if (path.size() == 0) continue;

    planner::LawSource law(plan->law, machine);
    std::vector<planner::TickMotion> plain, changed;
    while (!law.finished()) plain.push_back(law.advance({}));
    const double most = dice.chance(0.5) ? 1.0 : 1.7;
    const auto source = planner::override_source(path, *plan, machine, most);
    WildHand hand(seed + i, most);
    while (!source->finished() && changed.size() < 1'000'000)
      changed.push_back(source->advance(changed.size() < 20'000 ? hand.next() : planner::OperatorInput{}));
    REQUIRE(source->finished());

    const Run a = run_path(path, machine, plain), b = run_path(path, machine, changed);
    REQUIRE(a.events.size() == b.events.size());
    bool same = true;
    for (std::size_t e = 0; e < a.events.size(); ++e)
      same = same && a.events[e].segment == b.events[e].segment && a.events[e].axis == b.events[e].axis &&
             a.events[e].sign == b.events[e].sign && a.events[e].s_u == b.events[e].s_u;
    CHECK(same);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(a.net[k] == b.net[k]);
      CHECK(b.worst_steps[k] <= 0.5 + 1e-9);
    }
    later += static_cast<std::int64_t>(changed.size()) - static_cast<std::int64_t>(plain.size());
  }
  CHECK(later != 0);
}
