#pragma once

/// Elementary functions from + - * / and sqrt alone: the same bits with every compiler, optimisation level
/// and CPU (libm picks FMA variants when it loads, so its results differ between machines). Used wherever a
/// result can reach a step pulse or a log; errors are below 2 ulp in the stated range.
namespace kadr {

inline constexpr double kPi = 3.14159265358979323846;

struct SinCos {
  double sin;
  double cos;
};
/// Sine and cosine of an angle in radians, |angle_rad| <= 1e6 (absolute error <= 1e-15 near zero turns,
/// growing with the reduction by multiples of pi/2 to <= 1e-13 at 1e4 turns).
SinCos exact_sincos(double angle_rad);
/// Angle of (x, y) in (-pi, pi], as std::atan2.
double exact_atan2(double y, double x);
double exact_exp(double x);                      ///< e^x, |x| <= 700
double exact_log(double x);                      ///< natural logarithm, x > 0
double exact_pow(double base, double exponent);  ///< base > 0

}  // namespace kadr
