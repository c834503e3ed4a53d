#include "gcode/flow/arithmetic.h"

#include <cmath>

#include <fmt/format.h>

#include "machine/base/numbers.h"

namespace kadr::gcode {
namespace {

constexpr double kEqualTolerance = 1e-4;    // RS-274/NGC: EQ and NE
constexpr double kLargestExponent = 700;    // of exp: beyond it a double overflows or vanishes
constexpr double kLargestWholePower = 1e9;  // integer exponents by repeated squaring: at most 30 steps
constexpr double kDegrees = 180.0 / kPi;

/// Remainder of a / b, 0 <= r < |b|, exact: subtracts |b| 2^k, largest k first (k falls, so it ends).
double modulo(double a, double b) {
  const double divisor = std::fabs(b);
  double rest = std::fabs(a);
  if (rest >= divisor) {
    double part = divisor;
    while (part <= rest * 0.5) part *= 2;
    for (; part >= divisor; part *= 0.5) {
      if (rest >= part) rest -= part;
    }
  }
  if (a < 0 && rest > 0) rest = divisor - rest;
  return rest;
}

double whole_power(double base, double exponent) {
  double result = 1;
  double factor = base;
  for (auto n = static_cast<std::int64_t>(std::fabs(exponent)); n > 0; n >>= 1) {
    if (n & 1) result *= factor;
    factor *= factor;
  }
  return exponent < 0 ? 1 / result : result;
}

Arithmetic power(double a, double b) {
  if (b == std::floor(b) && std::fabs(b) <= kLargestWholePower) {
    if (a == 0 && b < 0) return {0, "0 to a negative power", false};
    return {whole_power(a, b), {}, false};
  }
  if (a < 0) return {0, fmt::format("{} ** {}: a negative base needs a whole exponent", a, b), false};
  if (a == 0) return b > 0 ? Arithmetic{} : Arithmetic{0, "0 to a negative power", false};
  const double exponent = b * exact_log(a);
  if (std::fabs(exponent) > kLargestExponent)
    return {0, fmt::format("{} ** {} is too large or too small", a, b), false};
  return {exact_exp(exponent), {}, false};
}

/// sine and cosine of an angle in degrees, exact at multiples of 90
SinCos sincos_degrees(double angle_deg) {
  const double turn = modulo(angle_deg, 360.0);
  const double quarter = std::floor(turn / 90.0);
  const SinCos s = exact_sincos((turn - quarter * 90.0) / kDegrees);
  if (turn == quarter * 90.0) {
    constexpr SinCos kQuarters[] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    return kQuarters[static_cast<int>(quarter) & 3];
  }
  switch (static_cast<int>(quarter)) {
    case 0:
      return s;
    case 1:
      return {s.cos, -s.sin};
    case 2:
      return {-s.sin, -s.cos};
    default:
      return {-s.cos, s.sin};
  }
}

Arithmetic tangent(double angle_deg) {
  const SinCos s = sincos_degrees(angle_deg);
  if (s.cos == 0) return {0, fmt::format("TAN of {} degrees is infinite", angle_deg), false};
  return {s.sin / s.cos, {}, false};
}

Arithmetic arc_function(Operation operation, double a) {
  if (std::fabs(a) > 1) {
    return {0, fmt::format("argument {}, allowed -1 to 1", a), false};
  }
  const double other = std::sqrt((1 - a) * (1 + a));
  const double angle = operation == Operation::asin ? exact_atan2(a, other) : exact_atan2(other, a);
  return {angle * kDegrees, {}, false};
}

/// A zero of either sign becomes +0.
double round_away(double a) { return (a < 0 ? -std::floor(0.5 - a) : std::floor(a + 0.5)) + 0.0; }

/// A zero keeps the sign of a, as in the controller: ATAN distinguishes them.
double signed_modulo(double a, double b) {
  const double rest = modulo(a, b);
  return rest == 0 ? std::copysign(0.0, a) : rest;
}

}  // namespace

double atan_deg(double y, double x) {
  // zeros have signs here, as in the controller: -#1 of a parameter that is 0 reverses the angle
  if (y == 0) return std::copysign(std::signbit(x) ? 180.0 : 0.0, y);
  if (x == 0) return y > 0 ? 90.0 : -90.0;
  return exact_atan2(y, x) * kDegrees;
}

Arithmetic apply(Operation operation, double a, double b) {
  const auto truth = [](bool holds) { return Arithmetic{holds ? 1.0 : 0.0, {}, false}; };
  switch (operation) {
    case Operation::add:
      return {a + b, {}, false};
    case Operation::subtract:
      return {a - b, {}, false};
    case Operation::multiply:
      return {a * b, {}, false};
    case Operation::divide:
      if (b == 0) return {0, "the divisor is 0", true};
      return {a / b, {}, false};
    case Operation::modulo:
      if (b == 0) return {0, "the divisor is 0", true};
      return {signed_modulo(a, b), {}, false};
    case Operation::power:
      return power(a, b);
    case Operation::equal:
      return truth(std::fabs(a - b) < kEqualTolerance);
    case Operation::not_equal:
      return truth(!(std::fabs(a - b) < kEqualTolerance));
    case Operation::greater:
      return truth(a > b);
    case Operation::greater_equal:
      return truth(a >= b);
    case Operation::less:
      return truth(a < b);
    case Operation::less_equal:
      return truth(a <= b);
    case Operation::logical_and:
      return truth(a != 0 && b != 0);
    case Operation::logical_or:
      return truth(a != 0 || b != 0);
    case Operation::logical_xor:
      return truth((a != 0) != (b != 0));
    case Operation::none:
    case Operation::sin:
    case Operation::cos:
    case Operation::tan:
    case Operation::asin:
    case Operation::acos:
    case Operation::atan:
    case Operation::sqrt:
    case Operation::exp:
    case Operation::ln:
    case Operation::abs:
    case Operation::round:
    case Operation::fix:
    case Operation::fup:
      break;
  }
  return {0, "not a binary operation", false};
}

Arithmetic apply(Operation operation, double a) {
  switch (operation) {
    case Operation::sin:
      return {a == 0 ? a : sincos_degrees(a).sin, {}, false};
    case Operation::cos:
      return {sincos_degrees(a).cos, {}, false};
    case Operation::tan:
      return a == 0 ? Arithmetic{a, {}, false} : tangent(a);
    case Operation::asin:
    case Operation::acos:
      return arc_function(operation, a);
    case Operation::sqrt:
      if (a < 0) return {0, fmt::format("argument {}, allowed 0 and above", a), false};
      return {std::sqrt(a), {}, false};
    case Operation::exp:
      if (std::fabs(a) > kLargestExponent) {
        return {0, fmt::format("argument {}, allowed -{} to {}", a, kLargestExponent, kLargestExponent),
                false};
      }
      return {exact_exp(a), {}, false};
    case Operation::ln:
      if (a <= 0) return {0, fmt::format("argument {}, allowed above 0", a), false};
      return {exact_log(a), {}, false};
    case Operation::abs:
      return {a < 0 ? -a : a, {}, false};
    case Operation::round:
      return {round_away(a), {}, false};
    case Operation::fix:
      return {std::floor(a), {}, false};
    case Operation::fup:
      return {-std::floor(-a), {}, false};
    case Operation::atan:
      return {atan_deg(a, 1), {}, false};
    case Operation::none:
    case Operation::add:
    case Operation::subtract:
    case Operation::multiply:
    case Operation::divide:
    case Operation::modulo:
    case Operation::power:
    case Operation::equal:
    case Operation::not_equal:
    case Operation::greater:
    case Operation::greater_equal:
    case Operation::less:
    case Operation::less_equal:
    case Operation::logical_and:
    case Operation::logical_or:
    case Operation::logical_xor:
      break;
  }
  return {0, "not a function", false};
}

}  // namespace kadr::gcode
