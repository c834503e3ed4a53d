#pragma once
#include <utility>

#include "machine/base/numbers.h"
#include "planner/path/path.h"

namespace kadr::planner {

/// A place of an arc: its two circular coordinates, and their derivatives by u = s/length.
///   p = c + r e,   e = (cos, sin), n = (-sin, cos),   phi' = sweep = w, r' = dr (constant)
///   p' = dr e + r w n,   p'' = 2 dr w n - r w^2 e,   p''' = -3 dr w^2 e - r w^3 n
class ArcPlace {
 public:
  /// First and second coordinate of the arc's plane.
  using Pair = std::pair<double, double>;

  /// @param u  in [0, 1]
  ArcPlace(const ArcShape& arc, double u)
      : center_first_u_(arc.center_first_u),
        center_second_u_(arc.center_second_u),
        dr_(arc.radius_end_u - arc.radius_begin_u),
        r_(arc.radius_begin_u + dr_ * u),
        w_(arc.sweep_rad),
        angle_(exact_sincos(arc.angle_begin_rad + arc.sweep_rad * u)) {}

  Pair position() const { return {center_first_u_ + r_ * angle_.cos, center_second_u_ + r_ * angle_.sin}; }
  Pair first() const {
    return {dr_ * angle_.cos - r_ * w_ * angle_.sin, dr_ * angle_.sin + r_ * w_ * angle_.cos};
  }
  Pair second() const {
    return {-2.0 * dr_ * w_ * angle_.sin - r_ * w_ * w_ * angle_.cos,
            2.0 * dr_ * w_ * angle_.cos - r_ * w_ * w_ * angle_.sin};
  }
  Pair third() const {
    return {-3.0 * dr_ * w_ * w_ * angle_.cos + r_ * w_ * w_ * w_ * angle_.sin,
            -3.0 * dr_ * w_ * w_ * angle_.sin - r_ * w_ * w_ * w_ * angle_.cos};
  }

 private:
  double center_first_u_, center_second_u_;
  double dr_, r_, w_;
  SinCos angle_;
};

}  // namespace kadr::planner
