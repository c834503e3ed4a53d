#include "planner/bezier/curve_bounds.h"

#include <algorithm>
#include <cmath>

namespace kadr::planner {
namespace {

constexpr int kPlaces = 17;
// between places a parabola rises above the higher one by at most an eighth of the second difference
constexpr double kRise = 0.25;

using Row = std::array<double, kPlaces>;

double bound(const Row& y) {
  double most = *std::max_element(y.begin(), y.end()), bend = 0;
  for (int i = 1; i + 1 < kPlaces; ++i) {
    const auto k = static_cast<std::size_t>(i);
    bend = std::max(bend, std::fabs(y[k - 1] - 2 * y[k] + y[k + 1]));
  }
  return most + kRise * bend;
}

}  // namespace

CurveBounds curve_bounds(const PathCurve& curve) {
  const std::size_t axes = curve.axes();
  std::array<LengthDerivatives, kPlaces> x;
  Row row{};
  for (std::size_t i = 0; i < kPlaces; ++i) {
    x[i] = curve.by_length(static_cast<double>(i) / (kPlaces - 1));
    double square = 0;
    for (std::size_t k = 0; k < axes; ++k) square += x[i].d2[k] * x[i].d2[k];
    row[i] = std::sqrt(square);
  }
  CurveBounds b;
  b.curvature_per_u = bound(row);
  b.curvature_least_per_u = *std::min_element(row.begin(), row.end());
  const double inverse = b.curvature_per_u > 0 ? 1 / b.curvature_per_u : 0;
  for (std::size_t k = 0; k < axes; ++k) {
    const auto measure = [&](auto&& value) {
      for (std::size_t i = 0; i < kPlaces; ++i) row[i] = value(x[i]);
      return bound(row);
    };
    b.tangent[k] = std::min(measure([&](const LengthDerivatives& d) { return std::fabs(d.d1[k]); }), 1.0);
    const double square = measure([&](const LengthDerivatives& d) {
      const double across = d.d2[k] * inverse;
      return d.d1[k] * d.d1[k] + across * across;
    });
    b.plane[k] = std::min(std::sqrt(square), 1.0);
    b.third_u2[k] = measure([&](const LengthDerivatives& d) { return std::fabs(d.d3[k]); });
  }
  return b;
}

}  // namespace kadr::planner
