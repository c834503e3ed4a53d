#pragma once
#include "planner/limits/run_method.h"
#include "planner/scheduler/valley.h"

namespace kadr::planner {

/// planner.method = "scheduler": ValleyPlanner, or plan_trapezoids() where nothing limits the jerk.
class RampMethod final : public RunMethod {
 public:
  explicit RampMethod(const RunTask& task) : task_(task), valley_(task.path(), task.table) {}
  tl::expected<void, PlanError> plan(const Run& run, PlannedRun& out) override;

 private:
  RunTask task_;
  ValleyPlanner valley_;
};

}  // namespace kadr::planner
