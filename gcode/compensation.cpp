#include "gcode/interpreter.h"

namespace kadr::gcode {

void Interpreter::compensation() {}

}  // namespace kadr::gcode
