#include <fmt/format.h>

#include <cmath>

#include "gcode/constants.h"
#include "gcode/interpret/interpreter.h"
#include "machine/base/numbers.h"

/// Polar words `@` radius and `^` angle: they become the X and Y of their line.
namespace kadr::gcode {
namespace {

constexpr double kOrigin_u = 1e-12;  // closer than this the angle is rounding noise

}  // namespace

bool Interpreter::polar_words() {
  if ((words_.present & letter_bits("@^")) == 0) return true;
  const char sign = words_.has('@') ? '@' : '^';
  const Span span = words_.span(*line_, sign);
  if (words_.has('X') || words_.has('Y')) {
    return error(problem(Code::polar_and_axis, span,
                         words_.has('X') ? "X is on this line too" : "Y is on this line too",
                         "give the end with @ and ^, or with X and Y"));
  }
  if (axis_words_taken() || words_.g(GGroup::nonmodal) == code::g53) {
    return error(problem(Code::polar_place, span, "no motion in program coordinates reads this word",
                         "give X and Y instead"));
  }
  // as in the controller, which checks the plane before the line changes it
  if (state_.plane != Plane::xy) {
    return error(problem(Code::polar_place, span,
                         fmt::format("the line begins in {}", state_.plane == Plane::zx ? "G18" : "G19"),
                         "write G17 on an earlier line, or give the end with axis words"));
  }
  words_.stand_in('X', sign);
  words_.stand_in('Y', sign);
  return true;
}

bool Interpreter::resolve_polar() {
  const char sign = words_.has('@') ? '@' : '^';
  const AxisValues at = state_.to_program(state_.position);
  const double x = state_.to_program_units(0, at[0]), y = state_.to_program_units(1, at[1]);
  double radius = std::sqrt(x * x + y * y);
  const bool at_origin = radius <= kOrigin_u;
  if (at_origin && (state_.incremental || !words_.has('^'))) {
    return error(
        problem(Code::polar_origin, words_.span(*line_, sign), "the move begins at X0 Y0",
                state_.incremental ? "leave the origin with an absolute move" : "give the angle ^ as well"));
  }
  double angle_rad = at_origin ? 0 : exact_atan2(y, x);
  const double turn_rad = words_.has('^') ? words_.value('^') * kRadiansPerDegree : 0;
  if (state_.incremental) {
    if (words_.has('@')) radius += words_.value('@');
    angle_rad += turn_rad;
  } else {
    if (words_.has('@')) radius = words_.value('@');
    if (words_.has('^')) angle_rad = turn_rad;
  }
  const SinCos direction = exact_sincos(angle_rad);
  const double begin_x = state_.incremental ? x : 0, begin_y = state_.incremental ? y : 0;
  words_.set('X', radius * direction.cos - begin_x);
  words_.set('Y', radius * direction.sin - begin_y);
  return true;
}

void Interpreter::take_diameters() {
  const int code = words_.g(GGroup::diameter);
  const bool diameters = code == kNoCode ? state_.diameter_mode : code == code::g7;
  if (diameters && words_.has('X')) words_.set('X', words_.value('X') / 2);
}

}  // namespace kadr::gcode
