#pragma once
#include <optional>

#include "gcode/arc.h"

/// Corner points of a tool that stays one radius off a contour.
///
/// Everything is in the plane of compensation. `side` is +1 if the tool runs left of the contour, -1 if
/// right. A move with direction d keeps the centre of the tool on the offset by radius · normal,
///   normal = side · (d turned left by 90 degrees).
namespace kadr::gcode {

/// Vectors of the plane are points, too.
using PlaneVector = PlanePoint;

constexpr PlaneVector operator+(PlaneVector a, PlaneVector b) {
  return {a.first_mm + b.first_mm, a.second_mm + b.second_mm};
}
constexpr PlaneVector operator-(PlaneVector a, PlaneVector b) {
  return {a.first_mm - b.first_mm, a.second_mm - b.second_mm};
}
constexpr PlaneVector operator*(double k, PlaneVector a) { return {k * a.first_mm, k * a.second_mm}; }
constexpr double dot(PlaneVector a, PlaneVector b) {
  return a.first_mm * b.first_mm + a.second_mm * b.second_mm;
}
constexpr bool same(PlanePoint a, PlanePoint b) {
  return a.first_mm == b.first_mm && a.second_mm == b.second_mm;
}
/// Turned by 90 degrees: left if `side` is +1, right if -1.
constexpr PlaneVector turned(PlaneVector a, double side) { return {-side * a.second_mm, side * a.first_mm}; }
double length(PlaneVector a);
/// Of length 1; the zero vector stays.
PlaneVector unit(PlaneVector a);

/// A circle of the plane and how it is run.
struct OffsetCircle {
  PlanePoint center;
  double radius_mm = 0;
  bool inside = false;  ///< the tool runs inside the arc
  bool counterclockwise = false;
};

enum class Corner : std::uint8_t {
  straight,  ///< within kStraightCorner_rad of no corner at all: the moves are joined as they are
  outside,   ///< the contour turns away from the tool: an arc about the corner leads around it
  inside,    ///< it turns towards the tool: both moves end where their offsets meet
};

/// Corners flatter than this are neither rounded nor trimmed, as in LinuxCNC.
inline constexpr double kStraightCorner_rad = 0.05;

/// The kind of corner between a move at whose end the tool is along `normal` and one in direction `next`
/// (both of length 1).
///
///   turn = atan2(-normal·next, tangent·next), tangent = normal turned back; positive: outside
///
/// @param reversal_inside  a contour that turns back on itself is an inside corner, as where an arc's convex
///                         side meets the next move; else the tool goes round it
Corner corner_between(PlaneVector normal, PlaneVector next, double side, bool reversal_inside);

/// Where two offset lines meet. The first ends at `tool` in direction `tangent`.
///   tool - radius · tan(turn/2) · tangent
PlanePoint meet(PlanePoint tool, PlaneVector normal, PlaneVector next, double side, double radius_mm);

/// Where a line through `point` with unit `direction` crosses a circle: before or after the foot of its
/// behind.
/// @param height_mm  distance of the centre from the line, to the left
/// @return nothing if line and circle don't meet
std::optional<PlanePoint> cross(PlaneVector direction, double height_mm, const OffsetCircle& circle,
                                bool ahead);

/// Where two circles cross, on the side of the line of centres where the contour runs.
/// @return nothing if they don't
std::optional<PlanePoint> cross(const OffsetCircle& before, const OffsetCircle& after);

}  // namespace kadr::gcode
