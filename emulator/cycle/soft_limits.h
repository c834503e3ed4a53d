#pragma once
#include "emulator/emulator.h"

namespace kadr::cycle {

/// Checks every segment's extent (arc extremes included) against the soft limits; one diagnostic per block
/// and axis, with the worst position of the block. Geometry only, so it holds under any override.
void check_soft_limits(const planner::Path& path, const machine::MachineModel& machine, SoftLimitRule rule,
                       Diagnostics& diagnostics);

}  // namespace kadr::cycle
