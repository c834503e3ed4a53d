#include "gcode/arc.h"

#include <algorithm>
#include <cmath>

#include "machine/base/numbers.h"

namespace kadr::gcode {
namespace {

// the dialect's limits, in the units of the program
constexpr double kLeast_mm = 0.0283, kCeiling_mm = 2.83;
constexpr double kLeast_in = 0.00283, kCeiling_in = 0.283;
constexpr double kMillimetres = 25.4;

double distance(PlanePoint a, PlanePoint b) {
  const double x = a.first_mm - b.first_mm;
  const double y = a.second_mm - b.second_mm;
  return std::sqrt(x * x + y * y);
}

}  // namespace

double ArcLimits::allowed_mm(double radius_mm) const {
  return std::min(ceiling_mm, std::max(least_mm, relative * radius_mm));
}

ArcLimits arc_limits(bool inches, double tolerance_mm, double tolerance_relative) {
  const double least = inches ? kLeast_in * kMillimetres : kLeast_mm;
  const double ceiling = inches ? kCeiling_in * kMillimetres : kCeiling_mm;
  return {std::max(least, tolerance_mm), tolerance_relative, ceiling};
}

ArcGeometry arc_about(PlanePoint start, PlanePoint end, PlanePoint center, const ArcLimits& limits) {
  ArcGeometry arc;
  arc.center = center;
  arc.radius_start_mm = distance(start, center);
  arc.radius_end_mm = distance(end, center);
  arc.allowed_mm = limits.allowed_mm(std::max(arc.radius_start_mm, arc.radius_end_mm));
  if (std::min(arc.radius_start_mm, arc.radius_end_mm) < kRadiusTolerance_mm) {
    arc.fault = ArcFault::zero_radius;
  } else if (std::fabs(arc.radius_start_mm - arc.radius_end_mm) > arc.allowed_mm) {
    arc.fault = ArcFault::off_circle;
  }
  return arc;
}

ArcGeometry arc_of_radius(PlanePoint start, PlanePoint end, double radius_mm, bool clockwise) {
  ArcGeometry arc;
  const double along_first = end.first_mm - start.first_mm;
  const double along_second = end.second_mm - start.second_mm;
  const double chord = std::sqrt(along_first * along_first + along_second * along_second);
  double radius = std::fabs(radius_mm);
  arc.half_chord_mm = chord / 2;
  arc.radius_start_mm = arc.radius_end_mm = radius;
  if (chord == 0) {
    arc.fault = ArcFault::no_chord;
    return arc;
  }
  if (arc.half_chord_mm - radius > kRadiusTolerance_mm) {
    arc.fault = ArcFault::radius_too_small;
    return arc;
  }
  if (radius < arc.half_chord_mm) {
    arc.half_circle_taken = true;
    radius = arc.half_chord_mm;
  }
  const double offset = std::sqrt((radius - arc.half_chord_mm) * (radius + arc.half_chord_mm));
  const double side = (radius_mm > 0) == clockwise ? -1.0 : 1.0;  // left of the chord is positive
  arc.center = {(start.first_mm + end.first_mm) / 2 - side * offset * (along_second / chord),
                (start.second_mm + end.second_mm) / 2 + side * offset * (along_first / chord)};
  arc.radius_start_mm = arc.radius_end_mm = radius;
  if (radius < kRadiusTolerance_mm) arc.fault = ArcFault::zero_radius;
  return arc;
}

double arc_sweep_rad(PlanePoint start, PlanePoint end, PlanePoint center, bool clockwise, int turns) {
  const double ax = start.first_mm - center.first_mm, ay = start.second_mm - center.second_mm;
  const double bx = end.first_mm - center.first_mm, by = end.second_mm - center.second_mm;
  double angle = exact_atan2(ax * by - ay * bx, ax * bx + ay * by);  // counter-clockwise, (-pi, pi]
  if (clockwise) angle = -angle;
  if (angle <= 0) angle += 2 * kPi;
  return angle + 2 * kPi * (turns - 1);
}

}  // namespace kadr::gcode
