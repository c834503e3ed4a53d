#pragma once
#include <cstddef>
#include <vector>

#include "planner/bezier/bezier_curve.h"
#include "planner/bezier/length_panels.h"

namespace kadr::planner {

/// Arc length S(t) of a Bezier curve and t(S), see LengthPanels.
class ArcLength {
 public:
  explicit ArcLength(const Bezier& curve);
  const Bezier& curve() const { return curve_; }
  double length_u() const { return panels_.length_u(); }
  double s_u(double t) const;
  /// Exact to rounding: |S(t) - s| within some ulp of the length.
  double t(double s_u) const;

 private:
  Bezier curve_;
  LengthPanels panels_;
};

/// t(S) by quintic pieces over equal parts of the length, with the exact dt/dS = 1/|B'| and d2t/dS2 =
/// -(B'.B'')/|B'|^4 at their ends: 48 bytes a part, some ns an evaluation.
class ArcTable {
 public:
  /// @pre parts >= 1
  ArcTable(const ArcLength& arc, int parts);
  /// The table with the fewest parts (a power of two, 8 to 4096) whose feed is right to `feed_error` and
  /// whose place to `place_error` of the length, looked at between its nodes. A curve near a cusp may need
  /// more than there are: then it is the finest one.
  static ArcTable fitted(const ArcLength& arc, double feed_error = 1e-6, double place_error = 1e-9);

  int parts() const { return parts_; }
  double length_u() const { return length_u_; }
  /// 0 and 1 bit for bit at both ends.
  double t(double s_u) const {
    if (!(s_u > 0)) return 0;
    if (s_u >= length_u_) return 1;
    double x = s_u * parts_per_u_;
    auto i = static_cast<std::size_t>(x);
    if (i >= last_) i = last_;
    x -= static_cast<double>(i);
    const Piece& c = pieces_[i];
    return c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
  }
  double dt_ds(double s_u) const;

 private:
  using Piece = std::array<double, 6>;

  std::vector<Piece> pieces_;  // [parts], by powers of the share of the part
  int parts_;
  std::size_t last_;
  double length_u_, parts_per_u_;
};

/// One step of Newton's method on S(t) = s from a table's t.
double polished(const ArcLength& arc, double t, double s_u);

/// Largest errors of a t(S): |t~ - t|, |B(t~) - B(t)| and |ds~/ds - 1|, at 1201 points that lie closer at the
/// ends (u = (1 - cos)/2).
struct ReparameterisationError {
  double reduced = 0;
  double position_u = 0;
  double feed = 0;
};
inline constexpr int kErrorPlaces = 1201;
/// Place i of them, as a share of the length.
double error_place(int i);
/// Errors at one of these points, with their signs.
struct PlaceError {
  double u = 0;  ///< share of the length
  double reduced = 0;
  double position_u = 0;  ///< a distance
  double feed = 0;
};
/// @param t_of  t~ at a share u = S/length of the length
template <class TOf>
PlaceError error_at(const ArcLength& arc, TOf&& t_of, int place) {
  constexpr double kApart = 1e-6;  // of the length: for the derivative
  const double u = error_place(place);
  const double exact = place == 0 ? 0 : place + 1 == kErrorPlaces ? 1 : arc.t(u * arc.length_u());
  const double t = t_of(u);
  const double v = u < kApart ? kApart : u > 1 - kApart ? 1 - kApart : u;
  const double slope = (t_of(v + kApart) - t_of(v - kApart)) / (2 * kApart) / arc.length_u();
  const double inside = t_of(v) < 0 ? 0 : t_of(v) > 1 ? 1 : t_of(v);
  BezierVector off = arc.curve().position(t);
  const BezierVector at = arc.curve().position(exact);
  for (std::size_t k = 0; k < kMostBezierAxes; ++k) off[k] -= at[k];
  return {u, t - exact, norm(off), slope * arc.curve().speed(inside) - 1};
}
/// The largest of them.
template <class TOf>
ReparameterisationError measure_error(const ArcLength& arc, TOf&& t_of) {
  ReparameterisationError worst;
  const auto keep = [](double& most, double v) { most = v > most ? v : -v > most ? -v : most; };
  for (int i = 0; i < kErrorPlaces; ++i) {
    const PlaceError e = error_at(arc, t_of, i);
    keep(worst.reduced, e.reduced);
    keep(worst.position_u, e.position_u);
    keep(worst.feed, e.feed);
  }
  return worst;
}

}  // namespace kadr::planner
