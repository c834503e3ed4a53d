#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "planner/limits/run_method.h"
#include "planner/positioning/positioning.h"
#include "planner/scheduler/pieces.h"
#include "planner/scheduler/whole_ticks.h"

namespace kadr::planner {

/// Plans the runs of a path, from rest to rest, one after the other: by planner.method, and rapids of
/// planner.rapid_law by PositioningPlanner. Joints, machine and table outlive it.
class RunMaker {
 public:
  RunMaker(const Joints& joints, const machine::MachineModel& machine, const PathLimitTable& table);

  /// Plans the next run; false after the last one, or where it can't be planned: error().
  bool next();

  const Run& run() const { return run_; }
  /// Writes it, to end at a prescribed time or, negative, as it is.
  void write(PieceWriter& writer, double end_time_s) const;
  /// Plan entry of a run that is a rapid of planner.rapid_law.
  const std::optional<PositionedSegment>& positioned() const { return positioned_; }
  /// Duration of the elements before they fill whole control ticks.
  double time_s() const { return time_s_; }
  const WholeTicks& whole() const { return whole_; }
  std::optional<PlanError>& error() { return error_; }

 private:
  void position();
  bool plan_by_method();

  RunTask task_;
  std::unique_ptr<RunMethod> method_;
  PositioningPlanner rapids_;
  std::optional<PositionedSegment> positioned_;
  Run run_;
  std::size_t behind_ = 0;
  PlannedRun planned_;
  double time_s_ = 0;
  WholeTicks whole_;
  std::optional<PlanError> error_;
};

}  // namespace kadr::planner
