#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace kadr::planner {
class Path;
}

namespace kadr::machine {
struct AxisModel;
struct MachineModel;
}  // namespace kadr::machine

namespace kadr::answers {

/// Travel of one axis in a program; axis units (mm or deg), machine coordinates.
struct AxisTravel {
  double min_u = 0;
  double max_u = 0;
  double travel_u = 0;  ///< distance back and forth together; on arcs within 1 %
};

/// Per machine axis. [axes]
std::vector<AxisTravel> axis_travel(const planner::Path& path);
/// Step pulses of the travel, all axes together; an estimate within about 1 %.
std::int64_t estimate_pulses(const std::vector<AxisTravel>& travel, const machine::MachineModel& machine);

/// What F measures on a segment (NIST rule): "mm" as soon as a linear axis moves, else "deg".
const char* segment_unit(const planner::Path& path, std::size_t segment,
                         const machine::MachineModel& machine);
/// Unit of a program's path: "mm", "deg", or "mm+deg" if it has segments of both kinds.
std::string path_unit(const planner::Path& path, const machine::MachineModel& machine);

}  // namespace kadr::answers
