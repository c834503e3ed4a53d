#include "gcode/interpreter.h"

namespace kadr::gcode {

void Interpreter::spline() {}

void Interpreter::add_nurbs_point() {}

void Interpreter::end_nurbs() {}

}  // namespace kadr::gcode
