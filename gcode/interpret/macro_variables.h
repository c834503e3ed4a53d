#pragma once
#include <limits>
#include <optional>
#include <string>

#include "gcode/interpret/state.h"
#include "gcode/read/tree.h"

/// Variables of macro B by number.
namespace kadr::gcode {

namespace macro_variable {
inline constexpr int kLast = 999;    ///< of those that hold what the program writes
inline constexpr int kInput = 1000;  ///< is_input_variable()
inline constexpr int kOutput = 1100, kOutputLast = 1131;
inline constexpr int kAlarm = 3000, kStop = 3006;
inline constexpr int kSingleBlock = 3003, kHoldAndOverride = 3004;
// .. and one for each axis, X Y Z A B C U V W
inline constexpr int kBlockEnd = 5001;         ///< end of the last move, work coordinates
inline constexpr int kMachinePosition = 5021;  ///< machine coordinates
inline constexpr int kWorkPosition = 5041;     ///< work coordinates, tool length included
inline constexpr int kSkipPosition = 5061;     ///< where the last probe tripped
inline constexpr int kToolOffset = 5081;       ///< in force
inline constexpr int kExternalOffset = 5201;   ///< 0: kadr has none
}  // namespace macro_variable

/// A variable that nothing has set holds this; no calculation gives it.
inline constexpr double kVacant = std::numeric_limits<double>::quiet_NaN();
constexpr bool is_vacant(double value) { return value != value; }

/// Variables that hold what the program writes: #1 to #33 of each call, #100 to #199, #500 to #999.
constexpr bool is_macro_variable(int number) {
  return (number >= 1 && number <= kMacroLocals) || (number >= 100 && number <= 199) ||
         (number >= 500 && number <= 999);
}
/// Makes all of them vacant.
void clear_macro_variables(State& state);

/// Length or diameter of a tool.
struct ToolVariable {
  int tool = 0;
  bool diameter = false;
};
std::optional<ToolVariable> tool_variable_of(const MacroRules& rules, int number);
/// Zero point of a work system, 1 .. 6: G54 .. G59.
struct WorkOffsetVariable {
  int system = 1;
  int axis = 0;
};
std::optional<WorkOffsetVariable> work_offset_variable_of(int number);

/// Value of #0 or a system variable, in the units in force; none if kadr does not have it.
std::optional<double> read_system_variable(const State& state, int number);
/// True if it tells where the tool is, which cutter compensation decides one move later.
bool tells_position(int number);
/// What a system variable that kadr does not have is: "#1000 is an input".
std::string system_variable_text(int number);

}  // namespace kadr::gcode
