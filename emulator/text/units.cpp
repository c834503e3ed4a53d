#include "emulator/text/units.h"

namespace kadr::text {

const char* axis_unit(const machine::AxisModel& axis) {
  return axis.kind == machine::AxisKind::rotary ? "deg" : "mm";
}

std::string speed_unit(const std::string& path_unit) {
  return path_unit == "mm+deg" ? "mm/s or deg/s" : path_unit + "/s";
}

}  // namespace kadr::text
