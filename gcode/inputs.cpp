#include "gcode/interpreter.h"

namespace kadr::gcode {

void Interpreter::inputs_and_outputs() {}

}  // namespace kadr::gcode
