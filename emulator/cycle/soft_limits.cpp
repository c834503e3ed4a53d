#include "emulator/cycle/soft_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kadr::cycle {
namespace {

const char* limit_unit(const machine::AxisModel& axis) {
  return axis.kind == machine::AxisKind::rotary ? "deg" : "mm";
}

void report(const planner::PathSegment& segment, const machine::AxisModel& axis, double reached_u,
            double limit_u, SoftLimitRule rule, Diagnostics& diagnostics) {
  Diagnostic d{Code::soft_limit,
               rule == SoftLimitRule::error ? Severity::error : Severity::warning,
               segment.span,
               fmt::format("axis {} leaves its soft limits", axis.letter),
               fmt::format("{} reaches {:.3f} {}, {:.3f} {} beyond the limit", axis.letter, reached_u,
                           limit_unit(axis), std::abs(reached_u - limit_u), limit_unit(axis)),
               {},
               {}};
  d.notes.push_back(fmt::format("allowed {:.3f} to {:.3f} {} (axis {} range_{}, machine coordinates)",
                                axis.soft_min_u, axis.soft_max_u, limit_unit(axis), axis.letter,
                                limit_unit(axis)));
  if (segment.made_by == gcode::BlockKind::approach)
    d.notes.push_back("on the way from home to the line where the program is entered (--from-line)");
  diagnostics.add(std::move(d));
}

/// Smallest and largest position of one axis on the segments of a block.
std::pair<double, double> block_extent(const planner::Path& path, std::size_t begin, std::size_t end,
                                       int axis) {
  auto extent = planner::axis_extent(path, begin, axis);
  for (std::size_t i = begin + 1; i < end; ++i) {
    const auto [low_u, high_u] = planner::axis_extent(path, i, axis);
    extent = {std::min(extent.first, low_u), std::max(extent.second, high_u)};
  }
  return extent;
}

}  // namespace

void check_soft_limits(const planner::Path& path, const machine::MachineModel& machine, SoftLimitRule rule,
                       Diagnostics& diagnostics) {
  for (std::size_t a = 0; a < machine.axis.size(); ++a) {
    const machine::AxisModel& axis = machine.axis[a];
    if (axis.soft_min_u == -machine::kInfinity && axis.soft_max_u == machine::kInfinity) continue;
    for (std::size_t i = 0; i < path.size();) {
      const std::size_t end = path.block_end(i);
      const auto [low_u, high_u] = block_extent(path, i, end, static_cast<int>(a));
      // a move that only comes back from outside is not reported again
      const double start_u = path.node(i)[a];
      if (high_u > std::max(axis.soft_max_u, start_u) + kSamePoint_u ||
          (i == 0 && start_u > axis.soft_max_u + kSamePoint_u))
        report(path.segments[i], axis, high_u, axis.soft_max_u, rule, diagnostics);
      if (low_u < std::min(axis.soft_min_u, start_u) - kSamePoint_u ||
          (i == 0 && start_u < axis.soft_min_u - kSamePoint_u))
        report(path.segments[i], axis, low_u, axis.soft_min_u, rule, diagnostics);
      i = end;
    }
  }
}

}  // namespace kadr::cycle
