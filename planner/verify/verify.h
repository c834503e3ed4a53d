#pragma once
#include <string>
#include <vector>

#include "planner/laws/feed_plan.h"

namespace kadr::machine {
struct MachineModel;
}

namespace kadr::planner {

class Path;

/// One broken limit found by verify().
struct Violation {
  std::string what;  ///< "axis speed", "junction", "continuity", "length", ...
  double time_s = 0;
  std::uint32_t segment = 0;
  int axis = -1;
  double value = 0;
  double limit = 0;
};

struct VerifyOptions {
  double relative_tolerance = 1e-9;
  double sample_s = 1e-3;  ///< besides every piece end, joint and extreme of a piece
  std::size_t most = 20;   ///< stop after that many
};

/// Independent check of any planner's output against path and machine alone; it shares no code with the
/// planners (caps, junction rule and ramps are computed anew from the definitions). Checks, at every piece
/// end, joint, inner extreme and sample: s and speed continuous (acceleration too where jerk is limited, jerk
/// too with quintic ramps), speed >= 0, path and axis speed, axis acceleration and jerk (normal and
/// tangential parts together on arcs), centripetal acceleration, programmed feed, junction step per axis,
/// rest at the ends and at every stop, total length, whole ticks where asked. Laws of paper 000 promise no
/// jerk (PlannerSettings::keeps_jerk): theirs is not looked at. Of a plan block by block also: whole ticks
/// and acceleration zero at every block end, and a jump of speed there only if the table states it and kl
/// explains it.
std::vector<Violation> verify(const Path& path, const FeedPlan& plan, const machine::MachineModel& machine,
                              const VerifyOptions& options = {});

}  // namespace kadr::planner
