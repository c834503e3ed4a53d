#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "machine/base/axes.h"
#include "planner/bezier/length_panels.h"

namespace kadr::planner {

/// dx/ds, d2x/ds2 and d3x/ds3 of a curve by its arc length s, one value per axis.
struct LengthDerivatives {
  std::array<double, kProgramAxes> d1{}, d2{}, d3{};
};

/// A Bezier curve of degree 1 to 5 in the path's axes, B(t) = sum C(n, i) t^i (1 - t)^(n-i) P_i, 0 <= t <= 1
/// (paper 004, eq. 1), as powers of t, with its arc length. mm and deg count alike, as in path.h.
class PathCurve {
 public:
  static constexpr std::size_t kPowers = 6;

  /// @param control_u  [points * axes], two to six points one after the other
  PathCurve(std::span<const double> control_u, std::size_t axes);

  std::size_t axes() const { return axes_; }
  double length_u() const { return panels_.length_u(); }
  /// c_j of x(t) = c_0 + c_1 t + ... + c_5 t^5
  double coefficient(std::size_t axis, std::size_t j) const { return c_[axis * kPowers + j]; }
  bool moves(std::size_t axis) const;
  double speed(double t) const;  ///< |B'(t)| = ds/dt
  double s_u(double t) const;
  double t(double s_u) const;

  void position(double t, std::span<double> position_u) const;
  double position(std::size_t axis, double t) const {
    const double* c = c_.data() + axis * kPowers;
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
  }
  /// dx/dt
  double derivative(std::size_t axis, double t) const {
    const double* c = c_.data() + axis * kPowers;
    return c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * (5 * c[5]))));
  }
  /// The part from t = `from` to t = `to`.
  PathCurve part(double from, double to) const;
  /// Where an axis turns round: the zeros of dx/dt inside (0, 1), ascending.
  std::vector<double> turning_points(std::size_t axis) const;
  /// @pre speed(t) > 0
  LengthDerivatives by_length(double t) const;

 private:
  std::size_t axes_;
  std::vector<double> c_;  ///< [axes * kPowers]
  LengthPanels panels_;
};

/// Control points of the part from t = `from` to t = `to` of a Bezier curve (blossoms, de Casteljau).
std::vector<double> part_of_curve(std::span<const double> control_u, std::size_t axes, double from,
                                  double to);

}  // namespace kadr::planner
