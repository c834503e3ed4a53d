#pragma once
#include <cstddef>
#include <vector>

#include "machine/base/vocabulary.h"
#include "planner/time_law/formula_path.h"

namespace kadr::planner {

/// What a spline does at its ends.
enum class SplineEnds : std::uint8_t {
  /// The third derivative does not jump at the second and the last but one row either, so that a cubic is met
  /// exactly and X'' of a smooth path is off by O(ds^2) up to the ends.
  not_a_knot,
  natural,  ///< X'' = 0, whatever the path does: limits of the first and last intervals are off
  clamped   ///< X' is that of the first and last chord, as of a path that begins and ends straight
};
inline constexpr Vocabulary<SplineEnds, 3> kSplineEnds{{
    {SplineEnds::not_a_knot, "not-a-knot", "the third derivative does not jump next to the ends"},
    {SplineEnds::natural, "natural", "no second derivative at the ends"},
    {SplineEnds::clamped, "clamped", "the slope of the first and last chord"},
}};
static_assert(kSplineEnds.complete());

/// Axes given by their values at rows s_0 < s_1 < ..., joined by a cubic spline each: X, X' and X'' are
/// continuous, X'' is linear between rows.
class TablePath {
 public:
  /// @param s_u     [rows], >= 4, strictly ascending
  /// @param values  [rows][axes], axis units
  TablePath(std::vector<double> s_u, std::vector<double> values, std::size_t axes,
            SplineEnds ends = SplineEnds::not_a_knot);

  std::size_t rows() const { return s_u_.size(); }
  std::size_t axes() const { return axes_; }
  double begin_u() const { return s_u_.front(); }
  double end_u() const { return s_u_.back(); }
  double row_u(std::size_t row) const { return s_u_[row]; }
  /// X, X', X'' of an axis at s; outside the rows the first or last piece goes on.
  AxisPoint eval(std::size_t axis, double s_u) const;

  /// Nodes at the rows. Of `out` axes, s_u, slope and curvature are set, the rest stays.
  void place_rows(LawProblem& out) const;
  /// Nodes that divide the length evenly.
  void sample(std::size_t nodes, LawProblem& out) const;
  /// For verify_law(); this path outlives it.
  PathDerivatives derivatives() const;

 private:
  std::size_t piece(double s_u) const;
  AxisPoint eval(std::size_t axis, std::size_t piece, double s_u) const;
  void place(LawProblem& out) const;

  std::vector<double> s_u_;
  std::vector<double> value_;   // [rows][axes]
  std::vector<double> second_;  // [rows][axes], X''
  std::size_t axes_;
};

}  // namespace kadr::planner
