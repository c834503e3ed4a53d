#include "planner/scheduler/ramp_method.h"

#include "planner/scheduler/trapezoid.h"

namespace kadr::planner {

tl::expected<void, PlanError> RampMethod::plan(const Run& run, PlannedRun& out) {
  if (limits_jerk(task_.table, run))
    valley_.plan(run, out.elements);
  else
    plan_trapezoids(task_.path(), task_.table, run, out.elements);
  return {};
}

}  // namespace kadr::planner
