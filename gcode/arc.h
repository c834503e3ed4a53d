#pragma once
#include <cstdint>

namespace kadr::gcode {

/// A point of the arc's plane in its first and second axis, mm, machine coordinates.
struct PlanePoint {
  double first_mm = 0;
  double second_mm = 0;
};

/// Allowed distance of an arc's end from the circle through its start, decided as in rs274.
struct ArcLimits {
  double least_mm = 0;    ///< always accepted
  double relative = 0;    ///< accepted as part of the larger radius
  double ceiling_mm = 0;  ///< never exceeded
  /// min(ceiling, max(least, relative · radius))
  double allowed_mm(double radius_mm) const;
};

/// Limits of the dialect for lengths written in mm or inches, with least and relative widened by the machine file.
ArcLimits arc_limits(bool inches, double tolerance_mm, double tolerance_relative);

/// Radii and R words closer to zero than this are not arcs; an R word may be short of the half distance by as much.
inline constexpr double kRadiusTolerance_mm = 0.00127;

/// A radius short only by decimal rounding is a half circle, without a message.
inline constexpr double kHalfCircleNoise_mm = 1e-6;

enum class ArcFault : std::uint8_t {
  none,
  zero_radius,       ///< centre on start or end
  off_circle,        ///< |radius_start - radius_end| > allowed
  radius_too_small,  ///< R can't span start to end
  no_chord,          ///< R format with start = end: any centre fits
};

struct ArcGeometry {
  ArcFault fault = ArcFault::none;
  PlanePoint center;
  double radius_start_mm = 0;
  double radius_end_mm = 0;
  double allowed_mm = 0;           ///< for |radius_start - radius_end|
  double half_chord_mm = 0;        ///< R format
  bool half_circle_taken = false;  ///< R was short within tolerance: the half circle over the chord instead
};

/// The arc about a given centre.
ArcGeometry arc_about(PlanePoint start, PlanePoint end, PlanePoint center, const ArcLimits& limits);

/// The arc of a given radius, R format: R > 0 the arc up to half a turn, R < 0 the other one.
///   centre = mid of chord + n · sqrt(R² - (chord/2)²), n the left normal of the chord for G3, R > 0 and G2,
///   R < 0
ArcGeometry arc_of_radius(PlanePoint start, PlanePoint end, double radius_mm, bool clockwise);

/// Angle travelled, > 0, in radians: (0, 2 pi] for one turn (start = end: a whole one), 2 pi more for each further.
double arc_sweep_rad(PlanePoint start, PlanePoint end, PlanePoint center, bool clockwise, int turns);

}  // namespace kadr::gcode
