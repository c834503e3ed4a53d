#pragma once
#include <array>
#include <cstddef>
#include <vector>

namespace kadr::planner {

inline constexpr std::size_t kMostBezierAxes = 9;
using BezierVector = std::array<double, kMostBezierAxes>;  ///< by axis; beyond the curve's axes 0

double dot(const BezierVector& a, const BezierVector& b);
double norm(const BezierVector& a);

/// B(t) = sum C(n, i) t^i (1 - t)^(n-i) P_i, 0 <= t <= 1 (paper 004, eq. 1), in any axes; mm and deg alike.
class Bezier {
 public:
  /// @param control  [degree + 1], degree 1 to 3
  Bezier(int axes, const std::vector<BezierVector>& control);
  int axes() const { return axes_; }
  int degree() const { return degree_; }
  const std::vector<BezierVector>& control() const { return control_; }
  /// c_j of B(t) = c_0 + c_1 t + c_2 t^2 + c_3 t^3, j = 0 to 3
  const BezierVector& coefficient(std::size_t j) const { return c_[j]; }

  BezierVector position(double t) const;  ///< exact at both ends
  BezierVector derivative(double t) const;
  BezierVector second(double t) const;
  double speed(double t) const { return norm(derivative(t)); }  ///< |B'(t)| = ds/dt
  /// d2B/ds2 = (B'' - B' (B'.B'')/|B'|^2)/|B'|^2, length 1/R, towards the centre of curvature
  BezierVector curvature_vector(double t) const;
  double curvature_per_u(double t) const { return norm(curvature_vector(t)); }

 private:
  int axes_, degree_;
  std::vector<BezierVector> control_;
  std::array<BezierVector, 4> c_{};
};

/// The smallest radius of curvature, and where it lies.
struct SmallestRadius {
  double radius_u = 0;  ///< infinite on a straight line, 0 at a cusp
  double t = 0;
};

/// Quadratic: R = |B'|^3/|B' x B''| at t* = -B'(0).B''/|B''|^2, since the cross product is constant.
/// Cubic: the ends and the zeros of N'D - 3ND' (degree 7) with N = |B' x B''|^2, D = |B'|^2, isolated between
/// the zeros of its derivatives; nothing is sampled.
SmallestRadius smallest_radius(const Bezier& curve);

/// Zeros of sum c_j t^j inside (0, 1), ascending: each is bracketed by two zeros of the derivative.
std::vector<double> zeros_in_unit(const std::vector<double>& c);

}  // namespace kadr::planner
