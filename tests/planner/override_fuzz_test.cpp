#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>

#include "machine/machine.h"
#include "planner/override/override_source.h"
#include "planner/scheduler/pieces.h"
#include "planner_support.h"

namespace kadr::test {
namespace {

using planner::FeedTerrain;
using planner::FeedTracker;
using planner::Percent;

/// Percents of a timeline: rests, steps, S-shaped changes tick by tick.
class Timeline {
 public:
  Timeline(std::uint64_t seed, double most) : random_(seed), most_(most) {}
  Percent next() {
    if (left_-- <= 0) choose();
    if (kind_ == 1) at_.feed = random_.chance(0.3) ? random_.between(0.05, most_) : at_.feed;
    if (kind_ == 2) {
      const double x = std::min(1.0, static_cast<double>(++step_) / 80.0);
      at_.feed = from_ + (to_ - from_) * x * x * (3.0 - 2.0 * x);
    }
    at_.rapid = std::min(at_.feed, 1.0);
    return at_;
  }

 private:
  void choose() {
    kind_ = random_.below(4);
    left_ = 5 + random_.below(300);
    if (kind_ == 0) at_.feed = random_.between(0.05, most_);
    if (kind_ == 3) {
      at_.feed = 0.0;
      left_ = 20 + random_.below(100);
    }
    if (kind_ == 2) from_ = at_.feed, to_ = random_.between(0.05, most_), step_ = 0;
  }
  Random random_;
  double most_;
  Percent at_;
  int kind_ = 0, left_ = 0, step_ = 0;
  double from_ = 1, to_ = 1;
};

/// Runs a whole path through the tracker and writes the law down.
planner::FeedPlan track(const planner::Path& path, const machine::MachineModel& machine, double most,
                        std::uint64_t seed, std::vector<double>* speeds = nullptr) {
  auto table = planner::limit_table(path, machine, most);
  REQUIRE(table);
  const FeedTerrain terrain(path, machine, *table);
  FeedTracker tracker(terrain);
  planner::FeedPlan plan;
  plan.law.length_u = path.length_u();
  tracker.record(&plan.law);
  Timeline timeline(seed, most);
  std::size_t segment = 0;
  int ticks = 0;
  while (segment < path.size()) {
    planner::MotionState rest{path.start_s_u[segment], 0.0, 0.0, 0.0};
    tracker.start(segment, rest, timeline.next(), kInfinity);
    while (!tracker.run_ended() && ticks < 4'000'000) {
      tracker.set_percent(ticks > 60'000 ? Percent{} : timeline.next());
      tracker.advance(machine.clock.tau_s());
      ++ticks;
      if (speeds) speeds->push_back(tracker.state().speed_u_s);
    }
    REQUIRE(tracker.run_ended());
    segment = tracker.segment() + 1;
  }
  planner::fill_segment_table(path, *table, plan);
  return plan;
}

/// The path with the feeds that the highest override allows: the reference for verify().
planner::Path at_most_percent(planner::Path path, double most) {
  for (planner::PathSegment& s : path.segments) s.feed_u_s *= most;
  return path;
}

std::string first_of(const std::vector<planner::Violation>& found) {
  if (found.empty()) return "";
  const planner::Violation& v = found.front();
  return fmt::format("{} at {} s, segment {}: {}, limit {}", v.what, v.time_s, v.segment, v.value, v.limit);
}

}  // namespace

TEST_CASE(
    "whatever the percent does, the motion keeps every limit of the machine and ends where the path does") {
  const std::uint64_t seed = environment("KADR_SEED", 1);
  for (std::uint64_t i = 0; i < environment("KADR_COUNT", 500); ++i) {
    Random random(seed + i);
    auto machine = random_machine(random);
    machine.planner.whole_ticks = false;
    AxisValues end{};
    const auto path = random_path(random, machine, end);
    const auto plain = planner::plan(path, machine);
    if (path.size() == 0 || !plain || plain->law.duration_s > 60.0) continue;
    const double most = random.chance(0.3) ? 1.0 : random.between(1.0, 2.0);
    CAPTURE(seed + i);
    const planner::FeedPlan plan = track(path, machine, most, seed + i);
    planner::VerifyOptions look;
    look.stands_at_pauses_alone = false;
    const auto found = planner::verify(at_most_percent(path, most), plan, machine, look);
    CHECK_MESSAGE(found.empty(), first_of(found));
    CHECK(plan.law.pieces.back().speed_u_s >= 0.0);
  }
}

}  // namespace kadr::test
