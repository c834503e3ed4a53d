#include "gcode/interpreter.h"

namespace kadr::gcode {

void Interpreter::modal_state() {}

void Interpreter::diameter_mode() {}

}  // namespace kadr::gcode
