#include "planner/bezier/path_curve.h"

#include <algorithm>
#include <cmath>

#include "machine/base/require.h"
#include "planner/bezier/bezier_curve.h"

namespace kadr::planner {
namespace {

// parts of curves, and corners, are near enough to lines and arcs that one panel is often all it takes
constexpr int kCurvePanels = 1;

using Vector = std::array<double, kProgramAxes>;

double dot(const Vector& a, const Vector& b, std::size_t axes) {
  double sum = 0;
  for (std::size_t k = 0; k < axes; ++k) sum += a[k] * b[k];
  return sum;
}

}  // namespace

PathCurve::PathCurve(std::span<const double> control_u, std::size_t axes)
    : axes_(axes), c_(axes * kPowers, 0.0) {
  const std::size_t points = control_u.size() / axes;
  require(points >= 2 && points <= kPowers && points * axes == control_u.size(),
          "a path's curve has degree 1 to 5");
  const std::size_t degree = points - 1;
  std::array<double, kPowers> difference{};
  for (std::size_t k = 0; k < axes; ++k) {
    for (std::size_t i = 0; i < points; ++i) difference[i] = control_u[i * axes + k];
    double binomial = 1;
    for (std::size_t j = 0; j <= degree; ++j) {
      // c_j = C(n, j) times the j-th difference of the points
      c_[k * kPowers + j] = binomial * difference[0];
      for (std::size_t i = 0; i + 1 < points - j; ++i) difference[i] = difference[i + 1] - difference[i];
      binomial = binomial * static_cast<double>(degree - j) / static_cast<double>(j + 1);
    }
  }
  panels_.measure([this](double t) { return speed(t); }, kCurvePanels);
}

bool PathCurve::moves(std::size_t axis) const {
  const double* c = c_.data() + axis * kPowers;
  return std::any_of(c + 1, c + kPowers, [](double x) { return x != 0.0; });
}

double PathCurve::speed(double t) const {
  double sum = 0;
  for (std::size_t k = 0; k < axes_; ++k) {
    const double v = derivative(k, t);
    sum += v * v;
  }
  return std::sqrt(sum);
}

double PathCurve::s_u(double t) const {
  if (t >= 1) return length_u();
  return panels_.s_u([this](double at) { return speed(at); }, t);
}

double PathCurve::t(double s_u) const {
  return panels_.t([this](double at) { return speed(at); }, s_u);
}

void PathCurve::position(double t, std::span<double> position_u) const {
  for (std::size_t k = 0; k < axes_; ++k) position_u[k] = position(k, t);
}

PathCurve PathCurve::part(double from, double to) const {
  // x(from + (to - from) u) by powers of u
  PathCurve part = *this;
  for (std::size_t k = 0; k < axes_; ++k) {
    double* c = part.c_.data() + k * kPowers;
    // Horner's scheme again and again leaves the Taylor coefficients at `from`
    for (std::size_t j = 0; j + 1 < kPowers; ++j)
      for (std::size_t i = kPowers - 1; i-- > j;) c[i] += from * c[i + 1];
    double scale = 1;
    for (std::size_t j = 0; j < kPowers; ++j, scale *= to - from) c[j] *= scale;
  }
  part.panels_.measure([&part](double t) { return part.speed(t); }, kCurvePanels);
  return part;
}

std::vector<double> PathCurve::turning_points(std::size_t axis) const {
  const double* c = c_.data() + axis * kPowers;
  const double bend = std::fabs(2 * c[2]) + std::fabs(3 * c[3]) + std::fabs(4 * c[4]) + std::fabs(5 * c[5]);
  if (std::fabs(c[1]) > bend) return {};
  return zeros_in_unit({c[1], 2 * c[2], 3 * c[3], 4 * c[4], 5 * c[5]});
}

LengthDerivatives PathCurve::by_length(double t) const {
  Vector b1{}, b2{}, b3{};  // by t
  for (std::size_t k = 0; k < axes_; ++k) {
    const double* c = c_.data() + k * kPowers;
    b1[k] = derivative(k, t);
    b2[k] = 2 * c[2] + t * (6 * c[3] + t * (12 * c[4] + t * (20 * c[5])));
    b3[k] = 6 * c[3] + t * (24 * c[4] + t * (60 * c[5]));
  }
  // B' = x' v,  B'' = x'' v^2 + x' v1,  B''' = x''' v^3 + 3 x'' v v1 + x' v2,  v = |B'|, |x'| = 1
  LengthDerivatives x;
  const double v = std::sqrt(dot(b1, b1, axes_));
  for (std::size_t k = 0; k < axes_; ++k) x.d1[k] = b1[k] / v;
  const double v1 = dot(x.d1, b2, axes_);
  for (std::size_t k = 0; k < axes_; ++k) x.d2[k] = (b2[k] - x.d1[k] * v1) / (v * v);
  const double v2 = dot(x.d1, b3, axes_) + v * dot(x.d2, b2, axes_);
  for (std::size_t k = 0; k < axes_; ++k)
    x.d3[k] = (b3[k] - 3 * x.d2[k] * v * v1 - x.d1[k] * v2) / (v * v * v);
  return x;
}

std::vector<double> part_of_curve(std::span<const double> control_u, std::size_t axes, double from,
                                  double to) {
  const std::size_t points = control_u.size() / axes;
  std::vector<double> part(control_u.size()), level(points);
  for (std::size_t k = 0; k < axes; ++k)
    for (std::size_t i = 0; i < points; ++i) {
      // blossom of point i: i arguments `to`, the others `from`
      for (std::size_t m = 0; m < points; ++m) level[m] = control_u[m * axes + k];
      for (std::size_t step = 0; step + 1 < points; ++step) {
        const double t = step < i ? to : from;
        for (std::size_t m = 0; m + 1 < points - step; ++m) level[m] = (1 - t) * level[m] + t * level[m + 1];
      }
      part[i * axes + k] = level[0];
    }
  return part;
}

}  // namespace kadr::planner
