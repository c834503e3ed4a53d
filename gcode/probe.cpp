#include "gcode/interpreter.h"

namespace kadr::gcode {

void Interpreter::probe() {}

}  // namespace kadr::gcode
