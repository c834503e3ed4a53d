#pragma once
#include <cstddef>
#include <vector>

namespace kadr {

/// A control point of a spline in a plane and its weight.
struct SplineControl {
  double first = 0;
  double second = 0;
  double weight = 1;
};

/// A point of a curve and its derivatives by the parameter.
struct SplineValue {
  double first = 0, second = 0;
  double first_d1 = 0, second_d1 = 0;
  double first_d2 = 0, second_d2 = 0;
};

/// A rational B-spline in a plane over clamped uniform knots 0 .. 0 1 2 .. n n .. n: it begins at the first
/// control point and ends at the last one.
///
///   C(u) = sum w_i N_i(u) P_i / sum w_i N_i(u)
///
/// A span is the curve between two knots; there it is smooth, at an inner knot it has order - 2 continuous derivatives.
class PlaneSpline {
 public:
  /// @pre order >= 2, at least `order` points, weights > 0
  PlaneSpline(std::vector<SplineControl> points, int order);
  std::size_t spans() const { return points_.size() - static_cast<std::size_t>(order_) + 1; }
  /// Point, velocity and acceleration by u, at 0 <= u <= 1 within a span.
  SplineValue eval(std::size_t span, double u) const;
  /// Arc length of the whole curve, within 1e-10 of it or what rounding of coordinates leaves: Gauss-Legendre on halves,
  /// until two agree.
  double length() const;
  /// Arc length of [from, to] within a span.
  double length(std::size_t span, double from, double to) const;

  /// Weighted sums: (w P, w). Their quotient is the point.
  struct Homogeneous {
    double first = 0, second = 0, weight = 0;
  };

 private:
  Homogeneous de_boor(std::vector<Homogeneous> d, std::size_t span, std::size_t m, double at) const;
  double knot(std::size_t i) const;
  double speed_rounding(std::size_t span) const;

  std::vector<SplineControl> points_;
  int order_;
};

}  // namespace kadr
