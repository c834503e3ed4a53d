#include "gcode/compensation/offset_corner.h"

#include <cmath>

#include "machine/base/numbers.h"

namespace kadr::gcode {

double length(PlaneVector a) { return std::sqrt(dot(a, a)); }

PlaneVector unit(PlaneVector a) {
  const double size = length(a);
  return size > 0 ? (1 / size) * a : a;
}

Corner corner_between(PlaneVector normal, PlaneVector next, double side, bool reversal_inside) {
  const PlaneVector tangent = turned(normal, -side);
  const double turn_rad = exact_atan2(-dot(normal, next), dot(tangent, next));
  if (std::fabs(turn_rad) <= kStraightCorner_rad) return Corner::straight;
  if (std::fabs(turn_rad) >= kPi - kStraightCorner_rad) {
    return reversal_inside ? Corner::inside : Corner::outside;
  }
  return turn_rad > 0 ? Corner::outside : Corner::inside;
}

PlanePoint meet(PlanePoint tool, PlaneVector normal, PlaneVector next, double side, double radius_mm) {
  const PlaneVector tangent = turned(normal, -side);
  // tan(turn/2) = sin(turn)/(1 + cos(turn))
  const double back_mm = radius_mm * dot(normal, next) / (1 + dot(tangent, next));
  return tool - back_mm * tangent;
}

std::optional<PlanePoint> cross(PlaneVector direction, double height_mm, const OffsetCircle& circle,
                                bool ahead) {
  const double square = (circle.radius_mm - height_mm) * (circle.radius_mm + height_mm);
  if (square < 0) return std::nullopt;
  const double along_mm = ahead ? std::sqrt(square) : -std::sqrt(square);
  return circle.center - height_mm * turned(direction, 1) + along_mm * direction;
}

std::optional<PlanePoint> cross(const OffsetCircle& before, const OffsetCircle& after) {
  const PlaneVector between = after.center - before.center;
  const double apart_mm = length(between);
  if (apart_mm == 0 || before.radius_mm == 0) return std::nullopt;
  // from the first centre: so far along the line of centres, then across it
  const double along_mm =
      (before.radius_mm * before.radius_mm + apart_mm * apart_mm - after.radius_mm * after.radius_mm) /
      (2 * apart_mm);
  const double square = (before.radius_mm - along_mm) * (before.radius_mm + along_mm);
  if (square < 0) return std::nullopt;
  const double left = before.inside == after.counterclockwise ? 1 : -1;
  const PlaneVector axis = unit(between);
  return before.center + along_mm * axis + std::sqrt(square) * turned(axis, left);
}

}  // namespace kadr::gcode
