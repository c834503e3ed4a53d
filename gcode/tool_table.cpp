#include "gcode/tool_table.h"

#include <algorithm>
#include <utility>

namespace kadr::gcode {

const Tool* ToolTable::find(int number) const {
  const auto it =
      std::find_if(tools.begin(), tools.end(), [&](const Tool& tool) { return tool.number == number; });
  return it == tools.end() ? nullptr : &*it;
}

Tool* ToolTable::find(int number) { return const_cast<Tool*>(std::as_const(*this).find(number)); }

}  // namespace kadr::gcode
