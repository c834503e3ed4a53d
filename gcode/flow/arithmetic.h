#pragma once
#include <optional>
#include <string>

#include "gcode/read/tree.h"

namespace kadr::gcode {

/// Result of an operation, or the reason why there is none.
struct Arithmetic {
  double value = 0;
  std::string refusal;  ///< measured value and what is allowed; empty: value is good
  bool divided_by_zero = false;
};

/// RS-274/NGC binary operations. MOD is never negative; EQ holds within 1e-4; comparisons and logic give 1 or 0.
Arithmetic apply(Operation operation, double a, double b);
/// Functions of one argument, angles in degrees. ROUND goes away from zero, FIX down, FUP up.
Arithmetic apply(Operation operation, double a);
/// ATAN[y]/[x] in degrees, [-180, 180]; -180 for y = -0 and x < 0.
double atan_deg(double y, double x);

}  // namespace kadr::gcode
