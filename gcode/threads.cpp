#include "gcode/interpreter.h"

namespace kadr::gcode {

void Interpreter::thread() {}

void Interpreter::rigid_tap() {}

void Interpreter::thread_cycle() {}

void Interpreter::spindle_mode() {}

}  // namespace kadr::gcode
