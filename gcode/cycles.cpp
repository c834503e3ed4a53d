#include "gcode/interpreter.h"

namespace kadr::gcode {

void Interpreter::cycle() {}

void Interpreter::retract_mode() {}

}  // namespace kadr::gcode
