#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "machine/base/require.h"
#include "machine/machine.h"
#include "planner/laws/pauses.h"
#include "planner/limits/limits.h"
#include "planner/planner.h"
#include "planner/positioning/positioning.h"
#include "planner/scheduler/scheduler.h"
#include "planner/time_law/jerk_plan.h"
#include "planner/time_law/path_law.h"

namespace kadr::planner {
namespace {

bool all_trapezoids(const PathLimitTable& table, const Run& run) {
  return std::all_of(table.jerk_u_s3.begin() + static_cast<std::ptrdiff_t>(run.first),
                     table.jerk_u_s3.begin() + static_cast<std::ptrdiff_t>(run.last + 1),
                     [](double j) { return !(j < machine::kInfinity); });
}

PlanError too_long(const Path& path, const Run& run, double time_s) {
  // the slowest segment is where the user has to look
  Diagnostic d{};
  d.code = Code::motion_too_long;
  d.span = path.segments[run.first].span;
  double slowest = machine::kInfinity;
  for (std::size_t i = run.first; i <= run.last; ++i)
    if (path.segments[i].feed_u_s < slowest)
      slowest = path.segments[i].feed_u_s, d.span = path.segments[i].span;
  d.message = std::string(code_entry(d.code).title);
  d.label = fmt::format("feed {:.3g} mm/s; the motion takes {:.3g} s", slowest, time_s);
  d.notes.push_back(fmt::format("allowed: {:.0e} s in all", kLongest_s));
  d.help = "check the feed and the units of the program";
  return {std::move(d)};
}

double sum_of_times_s(const std::vector<Element>& run) {
  double sum = 0.0;
  for (const Element& e : run) sum += e.time_s();
  return sum;
}

double sum_of_times_s(const std::vector<JerkPiece>& run) {
  double sum = 0.0, lost = 0.0;  // compensated: the last piece ends a run exactly
  for (const JerkPiece& p : run) {
    const double y = p.duration_s - lost;
    const double next = sum + y;
    lost = (next - sum) - y;
    sum = next;
  }
  return sum;
}

/// Plans the runs of a path, from rest to rest, one after the other.
class RunMaker {
 public:
  RunMaker(const Path& path, const machine::MachineModel& machine, const PathLimitTable& table)
      : path_(path), machine_(machine), table_(table), valley_(path, table), rapids_(machine) {}

  /// Plans the next run; false after the last one, or where it can't be planned: error().
  bool next() {
    if (behind_ >= path_.size()) return false;
    run_.first = run_.last = behind_;
    while (table_.cap_u_s[2 * run_.last + 2] > 0.0) ++run_.last;
    behind_ = run_.last + 1;
    elements_.clear();
    pieces_.clear();
    positioned_.reset();
    if (is_positioning(path_, run_.first, machine_)) {
      position();
      return true;
    }
    if (machine_.planner.method == machine::PlanMethod::jerk_limited && !all_trapezoids(table_, run_))
      return next_jerk_limited();
    if (machine_.planner.method != machine::PlanMethod::scheduler) {
      auto planned = plan_time_law(path_, table_, run_, machine_, elements_);
      if (!planned) {
        error_ = std::move(planned.error());
        return false;
      }
    } else if (all_trapezoids(table_, run_))
      plan_trapezoids(path_, table_, run_, elements_);
    else
      valley_.plan(run_, elements_);
    time_s_ = sum_of_times_s(elements_);
    whole_ = {};
    if (machine_.planner.whole_ticks && time_s_ < kLongest_s)
      whole_ = fill_whole_ticks(elements_, machine_.clock.tau_s());
    return true;
  }

  const Run& run() const { return run_; }
  /// Writes it, to end at a prescribed time or, negative, as it is.
  void write(PieceWriter& writer, double end_time_s) const {
    if (pieces_.empty())
      writer.add(elements_, whole_.stretch, end_time_s);
    else
      writer.add(pieces_, whole_.stretch, end_time_s);
  }
  /// What the plan tells of a run that is a rapid of planner.rapid_law.
  const std::optional<PositionedSegment>& positioned() const { return positioned_; }
  /// What the elements last before they fill whole control ticks.
  double time_s() const { return time_s_; }
  const WholeTicks& whole() const { return whole_; }
  std::optional<PlanError>& error() { return error_; }

 private:
  void position() {
    const std::size_t i = run_.first;
    require(run_.last == i, "a positioning move is a run of its own");
    const Positioning rapid =
        rapids_.plan(path_, i, table_.cap_u_s[2 * i + 1], table_.accel_u_s2[i], table_.jerk_u_s3[i]);
    append_pieces(rapid.law, path_.start_s_u[i], table_.signature[2 * i + 1], pieces_);
    time_s_ = rapid.law.duration_s();
    whole_ = {};
    if (machine_.planner.whole_ticks)
      whole_.ticks = static_cast<std::int64_t>(std::floor(time_s_ / machine_.clock.tau_s() + 0.5));
    positioned_ = {static_cast<std::uint32_t>(i), rapid.shape, rapid.reason, rapid.loss_s, {}};
    for (const ExcitedMode& m : rapids_.excited(path_, i))
      positioned_->residual_u[static_cast<std::size_t>(m.axis)] += residual_u(rapid.law, m);
  }

  bool next_jerk_limited() {
    auto planned = plan_jerk_law(path_, table_, run_, machine_, pieces_);
    if (!planned) {
      error_ = std::move(planned.error());
      return false;
    }
    time_s_ = sum_of_times_s(pieces_);
    whole_ = {};
    if (machine_.planner.whole_ticks && time_s_ < kLongest_s)
      whole_ = stretched_to_ticks(time_s_, machine_.clock.tau_s());
    return true;
  }

  const Path& path_;
  const machine::MachineModel& machine_;
  const PathLimitTable& table_;
  ValleyPlanner valley_;
  PositioningPlanner rapids_;
  std::optional<PositionedSegment> positioned_;
  Run run_;
  std::size_t behind_ = 0;
  std::vector<Element> elements_;
  std::vector<JerkPiece> pieces_;  // of a run that has no elements
  double time_s_ = 0;
  WholeTicks whole_;
  std::optional<PlanError> error_;
};

/// Plans all motion of a path, block by block.
tl::expected<void, PlanError> plan_blocks(const Path& path, const machine::MachineModel& machine,
                                          const PathLimitTable& limits, FeedPlan& plan,
                                          std::vector<RunBegin>& begins) {
  BlockWriter writer(path, machine.clock.tau_s(), plan);
  BlockScheduler blocks(path, limits, machine);
  for (BlockDiagram block; blocks.next(block);) {
    const double time = writer.time_s() + block.time_s();
    if (!(time < kLongest_s)) return tl::unexpected(too_long(path, {0, blocks.segment()}, time));
    begins.push_back({plan.segments.size(), plan.law.pieces.size()});
    writer.add(block, blocks.reasons());
  }
  return {};
}

/// Plans all motion of a path, run by run.
tl::expected<void, PlanError> plan_runs(const Path& path, const machine::MachineModel& machine,
                                        const PathLimitTable& limits, FeedPlan& plan,
                                        std::vector<RunBegin>& begins) {
  PieceWriter writer(plan.law);
  std::int64_t ticks = 0;
  const double tau = machine.clock.tau_s();
  RunMaker runs(path, machine, limits);
  while (runs.next()) {
    if (!(writer.time_s() + runs.time_s() < kLongest_s))
      return tl::unexpected(too_long(path, runs.run(), writer.time_s() + runs.time_s()));
    ticks += runs.whole().ticks;
    begins.push_back({runs.run().first, plan.law.pieces.size()});
    runs.write(writer, machine.planner.whole_ticks ? static_cast<double>(ticks) * tau : -1.0);
    if (runs.positioned()) plan.positioned.push_back(*runs.positioned());
  }
  if (runs.error()) return tl::unexpected(std::move(*runs.error()));
  plan.law.duration_s = writer.time_s();
  require(!plan.law.pieces.empty(), "a path that moves has a law");
  fill_segment_table(path, limits, plan);
  return {};
}

}  // namespace

tl::expected<FeedPlan, PlanError> plan(const Path& path, const machine::MachineModel& machine,
                                       std::span<const Pause> pauses) {
  require(path.axes() == static_cast<int>(machine.axis.size()), "path and machine have the same axes");
  if (!path.faults.empty()) return tl::unexpected(PlanError{path.faults.front()});
  FeedPlan result;
  result.law.length_u = path.length_u();
  std::vector<RunBegin> begins;
  if (path.size() > 0) {
    auto limits = limit_table(path, machine);
    if (!limits) return tl::unexpected(std::move(limits.error()));
    const bool blockwise = machine.planner.scheduler == machine::SchedulerKind::blockwise;
    auto planned = blockwise ? plan_blocks(path, machine, *limits, result, begins)
                             : plan_runs(path, machine, *limits, result, begins);
    if (!planned) return tl::unexpected(std::move(planned.error()));
  }
  add_pauses(path, pauses, begins, result);
  return result;
}

tl::expected<double, PlanError> motion_time_s(const Path& path, const machine::MachineModel& machine,
                                              std::size_t first) {
  if (!path.faults.empty()) return tl::unexpected(PlanError{path.faults.front()});
  if (first >= path.size()) return 0.0;
  const Path rest = path.tail(first);
  auto limits = limit_table(rest, machine);
  if (!limits) return tl::unexpected(std::move(limits.error()));
  std::int64_t ticks = 0;
  double time = 0.0;
  if (machine.planner.scheduler == machine::SchedulerKind::blockwise) {
    BlockScheduler blocks(rest, *limits, machine);
    for (BlockDiagram block; blocks.next(block);) {
      time += block.time_s();
      if (!(time < kLongest_s)) return tl::unexpected(too_long(rest, {0, blocks.segment()}, time));
      ticks += block.ticks;
    }
    return machine.planner.whole_ticks ? static_cast<double>(ticks) * machine.clock.tau_s() : time;
  }
  RunMaker runs(rest, machine, *limits);
  while (runs.next()) {
    time += runs.time_s() * runs.whole().stretch;
    if (!(time < kLongest_s)) return tl::unexpected(too_long(rest, runs.run(), time));
    ticks += runs.whole().ticks;
  }
  if (runs.error()) return tl::unexpected(std::move(*runs.error()));
  return machine.planner.whole_ticks ? static_cast<double>(ticks) * machine.clock.tau_s() : time;
}

}  // namespace kadr::planner
