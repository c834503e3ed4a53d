#pragma once
#include <variant>
#include <vector>

#include "emulator/interpolator/lattice/slot.h"

namespace kadr::interpolator::lattice {

/// Straight from the origin to delta.
struct LineCurve {
  int axes = 2;
  Point delta{};
};

enum class Turn : std::uint8_t { ccw, cw };

/// About the origin, from begin to end; R^2 = |begin|^2. Where end is begin: a full turn.
struct ArcCurve {
  PlaneNode begin;
  PlaneNode end;
  Turn turn = Turn::ccw;
};

/// y^2 = 2 p x, from the node nearest to the curve at y_begin to that at y_end.
struct ParabolaCurve {
  std::int64_t p = 1;  ///< may be negative
  std::int64_t y_begin = 0;
  std::int64_t y_end = 0;
};

/// c x^px y^py
struct Term {
  Wide c = 0;
  int px = 0;
  int py = 0;
};

/// A polynomial of x and y with whole coefficients.
class Polynomial {
 public:
  explicit Polynomial(std::vector<Term> terms);
  int degree() const { return degree_; }
  const std::vector<Term>& terms() const { return terms_; }
  /// 2^degree F(X/2, Y/2): exact between nodes, since X = 2x and Y = 2y are whole.
  Wide doubled(std::int64_t x2, std::int64_t y2) const;
  double value(double x, double y) const;
  Polynomial derivative_x() const;
  Polynomial derivative_y() const;
  /// Whether doubled() stays below 2^125 for |x|, |y| <= reach.
  bool fits(std::int64_t reach) const;

 private:
  std::vector<Term> terms_;
  int degree_ = 0;
};

/// F(x, y) = 0 from begin to end; where end is begin, once around.
struct ImplicitCurve {
  Polynomial f;
  PlaneNode begin;
  PlaneNode end;
  int side = 1;  ///< +1: F < 0 lies to the left of travel, -1: to the right
};

/// A Bezier curve of degree 1 to 3 whose control points are nodes.
struct BezierCurve {
  int axes = 2;
  int degree = 3;
  std::array<Point, 4> control{};
};

using Curve = std::variant<LineCurve, ArcCurve, ParabolaCurve, ImplicitCurve, BezierCurve>;

/// The axis v of a polynomial that is c v + P(u), so that F = 0 is v = -P(u)/c: 1 (y of x), 0 (x of y), or
/// -1. Where both are, y. -1 too where P is of a higher degree than kMostExplicitDegree.
inline constexpr int kMostExplicitDegree = 6;
int explicit_axis(const Polynomial& f);
/// (x/a)^2 + (y/b)^2 = 1 from (a, 0), once around.
ImplicitCurve ellipse(std::int64_t a, std::int64_t b, Turn turn = Turn::ccw);
ImplicitCurve implicit_of(const ParabolaCurve& parabola);
/// The parabola that a quadratic Bezier from the origin is, with b = 2 P1, a = P2 - 2 P1, D = a2 b1 - a1 b2:
///   F = (a2 x - a1 y)^2 + D (b2 x - b1 y)
/// @pre D != 0: the control points are not in line
ImplicitCurve conic_of(const BezierCurve& quadratic);

int axes_of(const Curve& curve);
/// Nodes of both ends; a curve begins at its stated start, a line at the origin.
Point begin_of(const Curve& curve);
Point end_of(const Curve& curve);

}  // namespace kadr::interpolator::lattice
