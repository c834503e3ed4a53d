#pragma once
#include <vector>

#include <tl/expected.hpp>

#include "planner/limits/limits.h"
#include "planner/limits/plan_error.h"
#include "planner/limits/ramp.h"
#include "planner/path/joints.h"

/// The door through which plan() asks a planner.method for one motion from rest to rest.
namespace kadr::planner {

/// What every method works on; all three outlive it.
struct RunTask {
  const Joints& joints;
  const PathLimitTable& table;
  const machine::MachineModel& machine;
  const Path& path() const { return joints.path(); }
};

/// A run in path order, without gaps: ramps and holds, or else pieces of constant jerk, whose own beginnings
/// do not count.
struct PlannedRun {
  std::vector<Element> elements;
  std::vector<JerkPiece> pieces;
};

class RunMethod {
 public:
  virtual ~RunMethod() = default;
  /// @param out  empty; a method fills one of the two
  virtual tl::expected<void, PlanError> plan(const Run& run, PlannedRun& out) = 0;
};

/// Whether a segment of the run has a jerk limit.
bool limits_jerk(const PathLimitTable& table, const Run& run);

}  // namespace kadr::planner
