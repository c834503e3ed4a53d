#pragma once
#include <vector>

#include "planner/bezier/arc_length.h"

namespace kadr::planner {

/// t(S) as paper 004 makes it, one polynomial of u = S/length, to be compared with ArcTable: Newton's
/// polynomial through equally spaced values of the exact t(S).
class NewtonOfLength {
 public:
  /// @pre 1 <= degree <= 20
  NewtonOfLength(const ArcLength& arc, int degree);
  double operator()(double u) const;

 private:
  std::vector<double> node_, a_;  // divided differences
};

/// The polynomial t = u + u (1 - u) q(u) of a degree whose largest |t - f(u)| is least; both ends are exact.
/// Remez' exchange over the points of measure_error(): as many errors of equal size and alternating sign as
/// there are unknowns and one.
class MinimaxOfLength {
 public:
  /// @param target  [kErrorPlaces], f at error_place(i)
  /// @pre 2 <= degree <= 16
  MinimaxOfLength(const std::vector<double>& target, int degree);
  double operator()(double u) const;
  /// q = sum c_j T_j(2u - 1)
  const std::vector<double>& coefficients() const { return c_; }
  double error() const {
    return error_;
  }  ///< the levelled error, a bound from below for every other polynomial

 private:
  std::vector<double> c_;
  double error_ = 0;
};

/// The exact t(S) and a Newton polynomial at the points of measure_error().
std::vector<double> exact_places(const ArcLength& arc);
std::vector<double> places_of(const NewtonOfLength& newton);

}  // namespace kadr::planner
