#include <fmt/format.h>

#include <optional>

#include "machine/base/require.h"
#include "machine/machine.h"
#include "planner/laws/pauses.h"
#include "planner/limits/limits.h"
#include "planner/planner.h"
#include "planner/run_maker.h"
#include "planner/scheduler/scheduler.h"

namespace kadr::planner {
namespace {

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
tl::expected<void, PlanError> plan_runs(const Joints& joints, const machine::MachineModel& machine,
                                        const PathLimitTable& limits, FeedPlan& plan,
                                        std::vector<RunBegin>& begins) {
  PieceWriter writer(plan.law);
  std::int64_t ticks = 0;
  const double tau = machine.clock.tau_s();
  RunMaker runs(joints, machine, limits);
  while (runs.next()) {
    if (!(writer.time_s() + runs.time_s() < kLongest_s))
      return tl::unexpected(too_long(joints.path(), runs.run(), writer.time_s() + runs.time_s()));
    ticks += runs.whole().ticks;
    begins.push_back({runs.run().first, plan.law.pieces.size()});
    runs.write(writer, machine.planner.whole_ticks ? static_cast<double>(ticks) * tau : -1.0);
    if (runs.positioned()) plan.positioned.push_back(*runs.positioned());
  }
  if (runs.error()) return tl::unexpected(std::move(*runs.error()));
  plan.law.duration_s = writer.time_s();
  require(!plan.law.pieces.empty(), "a path that moves has a law");
  fill_segment_table(joints.path(), limits, plan);
  return {};
}

}  // namespace

tl::expected<FeedPlan, PlanError> plan(const Path& path, const machine::MachineModel& machine,
                                       std::span<const Pause> pauses) {
  return plan(*machine_joints(path, machine), machine, pauses);
}

tl::expected<FeedPlan, PlanError> plan(const Joints& joints, const machine::MachineModel& machine,
                                       std::span<const Pause> pauses) {
  const Path& path = joints.path();
  if (!path.faults.empty()) return tl::unexpected(PlanError{path.faults.front()});
  FeedPlan result;
  result.law.length_u = path.length_u();
  std::vector<RunBegin> begins;
  if (path.size() > 0) {
    auto limits = limit_table(joints, machine);
    if (!limits) return tl::unexpected(std::move(limits.error()));
    const bool blockwise = machine.planner.scheduler == machine::SchedulerKind::blockwise;
    auto planned = blockwise ? plan_blocks(path, machine, *limits, result, begins)
                             : plan_runs(joints, machine, *limits, result, begins);
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
  const auto joints = machine_joints(rest, machine);
  auto limits = limit_table(*joints, machine);
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
  RunMaker runs(*joints, machine, *limits);
  while (runs.next()) {
    time += runs.time_s() * runs.whole().stretch;
    if (!(time < kLongest_s)) return tl::unexpected(too_long(rest, runs.run(), time));
    ticks += runs.whole().ticks;
  }
  if (runs.error()) return tl::unexpected(std::move(*runs.error()));
  return machine.planner.whole_ticks ? static_cast<double>(ticks) * machine.clock.tau_s() : time;
}

}  // namespace kadr::planner
