#pragma once
#include <vector>

#include "emulator/emulator.h"

namespace kadr::cycle {

/// Finds the steps of a timeline at a position on the path.
/// @param blocks       motion blocks of the program
/// @param program      its file in the sources
/// @param diagnostics  K3203 for each line or block that makes no motion, and for each position beyond the path
/// @return [steps] path length s at which each step takes effect; 0 for the steps that have a tick
std::vector<double> place_on_path(const std::vector<OperatorStep>& steps, const planner::Path& path,
                                  std::uint32_t blocks, std::uint32_t program, Diagnostics& diagnostics);

}  // namespace kadr::cycle
