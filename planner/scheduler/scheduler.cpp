#include <fmt/format.h>

#include <algorithm>

#include "machine/base/require.h"
#include "planner/planner.h"
#include "planner/scheduler/limits.h"
#include "planner/scheduler/pieces.h"
#include "planner/scheduler/run_planner.h"

namespace kadr::planner {
namespace {

constexpr double kLongest_s = 1e9;

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

}  // namespace

std::string_view limited_by_name(LimitedBy reason) {
  switch (reason) {
    case LimitedBy::program:
      return "program";
    case LimitedBy::rapid:
      return "rapid";
    case LimitedBy::path_feed:
      return "path feed";
    case LimitedBy::axis_speed:
      return "axis speed";
    case LimitedBy::centripetal:
      return "centripetal";
    case LimitedBy::junction:
      return "junction";
    case LimitedBy::length:
      return "length";
    case LimitedBy::stop:
      return "stop";
  }
  return "unknown";
}

tl::expected<FeedPlan, PlanError> plan(const Path& path, const machine::MachineModel& machine) {
  require(path.axes() == static_cast<int>(machine.axis.size()), "path and machine have the same axes");
  if (!path.faults.empty()) return tl::unexpected(PlanError{path.faults.front()});
  FeedPlan result;
  result.law.length_u = path.length_u();
  if (path.size() == 0) return result;
  auto limits = limit_table(path, machine);
  if (!limits) return tl::unexpected(std::move(limits.error()));
  const PathLimitTable& table = *limits;

  ValleyPlanner valley(path, table);
  PieceWriter writer(result.law);
  std::vector<Element> elements;
  std::int64_t ticks = 0;
  const double tau = machine.clock.tau_s();
  for (Run run; run.first < path.size(); run.first = run.last + 1) {
    run.last = run.first;
    while (table.cap_u_s[2 * run.last + 2] > 0.0) ++run.last;
    elements.clear();
    if (all_trapezoids(table, run))
      plan_trapezoids(path, table, run, elements);
    else
      valley.plan(run, elements);

    const double time = sum_of_times_s(elements);
    if (!(writer.time_s() + time < kLongest_s))
      return tl::unexpected(too_long(path, run, writer.time_s() + time));
    if (machine.planner.whole_ticks) {
      const WholeTicks whole = fill_whole_ticks(elements, tau);
      ticks += whole.ticks;
      writer.add(elements, whole.stretch, static_cast<double>(ticks) * tau);
    } else {
      writer.add(elements, 1.0, -1.0);
    }
  }
  result.law.duration_s = writer.time_s();
  require(!result.law.pieces.empty(), "a path that moves has a law");
  fill_segment_table(path, table, result);
  return result;
}

}  // namespace kadr::planner
