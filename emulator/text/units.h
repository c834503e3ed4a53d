#pragma once
#include <string>

#include "machine/machine.h"

namespace kadr::text {

/// "mm" or "deg"
const char* axis_unit(const machine::AxisModel& axis);
/// "mm/s", "deg/s", or "mm/s or deg/s": speeds along a path that is counted in "mm", "deg" or "mm+deg".
std::string speed_unit(const std::string& path_unit);

}  // namespace kadr::text
