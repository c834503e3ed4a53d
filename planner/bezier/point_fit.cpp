#include "planner/bezier/point_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "machine/base/axes.h"
#include "machine/base/require.h"

namespace kadr::planner {
namespace {

using Vector = std::array<double, kProgramAxes>;

/// Thomas' method; the matrix is diagonally dominant.
std::vector<Vector> slopes(const std::vector<double>& h, const std::vector<Vector>& d, std::size_t axes) {
  const std::size_t n = h.size();  // chords
  std::vector<Vector> m(n + 1);
  m.front() = d.front();
  m.back() = d.back();
  std::vector<double> upper(n, 0.0);
  for (std::size_t i = 1; i < n; ++i) {
    const double below = 1 / h[i - 1], above = 1 / h[i];
    const double pivot = 2 * (below + above) - (i > 1 ? below * upper[i - 1] : 0.0);
    upper[i] = above / pivot;
    for (std::size_t k = 0; k < axes; ++k) {
      double right = 3 * (d[i - 1][k] * below + d[i][k] * above) - below * m[i - 1][k];
      if (i + 1 == n) right -= above * m[n][k];
      m[i][k] = right / pivot;
    }
  }
  // m[i] holds what the slopes below leave; the one above is still to come
  for (std::size_t i = n - 1; i-- > 1;)
    for (std::size_t k = 0; k < axes; ++k) m[i][k] -= upper[i] * m[i + 1][k];
  return m;
}

/// Largest distance of control points from the chord between the first and the last: the curve lies within.
double distance_from_chord(const std::vector<double>& control, std::size_t axes) {
  const std::size_t points = control.size() / axes;
  const double* from = control.data();
  const double* to = control.data() + (points - 1) * axes;
  double length2 = 0;
  for (std::size_t k = 0; k < axes; ++k) length2 += (to[k] - from[k]) * (to[k] - from[k]);
  double worst = 0;
  for (std::size_t i = 1; i + 1 < points; ++i) {
    const double* p = control.data() + i * axes;
    double along = 0;
    for (std::size_t k = 0; k < axes; ++k) along += (p[k] - from[k]) * (to[k] - from[k]);
    const double share = std::clamp(along / length2, 0.0, 1.0);
    double square = 0;
    for (std::size_t k = 0; k < axes; ++k) {
      const double off = p[k] - (from[k] + share * (to[k] - from[k]));
      square += off * off;
    }
    worst = std::max(worst, square);
  }
  return std::sqrt(worst);
}

}  // namespace

PointFit fit_points(std::span<const double> points_u, std::size_t axes) {
  const std::size_t n = points_u.size() / axes - 1;
  require(n >= 2 && (n + 1) * axes == points_u.size(), "a curve goes through three points or more");
  std::vector<double> h(n);
  std::vector<Vector> d(n);
  for (std::size_t i = 0; i < n; ++i) {
    double square = 0;
    for (std::size_t k = 0; k < axes; ++k) {
      d[i][k] = points_u[(i + 1) * axes + k] - points_u[i * axes + k];
      square += d[i][k] * d[i][k];
    }
    h[i] = std::sqrt(square);
    for (std::size_t k = 0; k < axes; ++k) d[i][k] /= h[i];
  }
  const std::vector<Vector> m = slopes(h, d, axes);

  PointFit fit;
  for (std::size_t i = 0; i < n; ++i) {
    const bool first = i == 0, last = i + 1 == n;
    const std::size_t degree = first || last ? 5 : 3;
    const auto q = static_cast<double>(degree);
    std::vector<double> control((degree + 1) * axes);
    for (std::size_t k = 0; k < axes; ++k) {
      const double p0 = points_u[i * axes + k], p1 = points_u[(i + 1) * axes + k];
      const double v0 = h[i] * m[i][k], v1 = h[i] * m[i + 1][k];  // by the share of the chord
      const auto point = [&](std::size_t j) -> double& { return control[j * axes + k]; };
      point(0) = p0;
      point(1) = p0 + v0 / q;
      point(degree - 1) = p1 - v1 / q;
      point(degree) = p1;
      if (degree == 3) continue;
      // second derivatives of the cubic: 6 d - 4 v0 - 2 v1 at its beginning, -6 d + 2 v0 + 4 v1 at its end
      const double chord = p1 - p0;
      const double a0 = first ? 0.0 : 6 * chord - 4 * v0 - 2 * v1;
      const double a1 = last ? 0.0 : -6 * chord + 2 * v0 + 4 * v1;
      point(2) = p0 + 2 * v0 / q + a0 / (q * (q - 1));
      point(3) = p1 - 2 * v1 / q + a1 / (q * (q - 1));
    }
    fit.deviation_u.push_back(distance_from_chord(control, axes));
    fit.control_u.push_back(std::move(control));
  }
  return fit;
}

}  // namespace kadr::planner
