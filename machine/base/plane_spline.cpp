#include "machine/base/plane_spline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "machine/base/require.h"

namespace kadr {
namespace {

using Homogeneous = PlaneSpline::Homogeneous;

Homogeneous blend(const Homogeneous& a, const Homogeneous& b, double part_a, double part_b) {
  return {a.first * part_a + b.first * part_b, a.second * part_a + b.second * part_b,
          a.weight * part_a + b.weight * part_b};
}

// Gauss-Legendre, five points: exact for polynomials of degree 9
constexpr std::array<double, 5> kNodes = {-0.9061798459386639928, -0.5384693101056830910, 0,
                                          0.5384693101056830910, 0.9061798459386639928};
constexpr std::array<double, 5> kWeights = {0.2369268850561890875, 0.4786286704993664680,
                                            0.5688888888888888889, 0.4786286704993664680,
                                            0.2369268850561890875};
constexpr double kLengthTolerance = 1e-10;
constexpr int kMostHalvings = 24;  // a cusp costs at most as many levels
constexpr int kMostParts = 4096;   // of a span: a curve of 16 points has fewer cusps than that allows for
// what rounding does to a speed, in units of order x coordinate x ratio of the weights
constexpr double kSpeedRounding = 4 * std::numeric_limits<double>::epsilon();

double speed(const SplineValue& v) { return std::sqrt(v.first_d1 * v.first_d1 + v.second_d1 * v.second_d1); }

double gauss(const PlaneSpline& spline, std::size_t span, double from, double to) {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0;
  for (std::size_t i = 0; i < kNodes.size(); ++i)
    sum += kWeights[i] * speed(spline.eval(span, middle + half * kNodes[i]));
  return sum * half;
}

/// @param parts  halvings that are left for this span
double refine(const PlaneSpline& spline, std::size_t span, double from, double to, double whole,
              double allowed, int level, int& parts) {
  const double middle = 0.5 * (from + to);
  const double left = gauss(spline, span, from, middle);
  const double right = gauss(spline, span, middle, to);
  if (level == 0 || --parts <= 0 || std::fabs(left + right - whole) <= allowed) return left + right;
  return refine(spline, span, from, middle, left, 0.5 * allowed, level - 1, parts) +
         refine(spline, span, middle, to, right, 0.5 * allowed, level - 1, parts);
}

}  // namespace

PlaneSpline::PlaneSpline(std::vector<SplineControl> points, int order)
    : points_(std::move(points)), order_(order) {
  require(order_ >= 2 && points_.size() >= static_cast<std::size_t>(order_),
          "a spline has at least as many control points as its order, which is 2 or more");
  for (const SplineControl& p : points_) require(p.weight > 0, "the weights of a spline are above zero");
}

double PlaneSpline::knot(std::size_t i) const {
  const auto order = static_cast<std::size_t>(order_);
  return i < order ? 0.0 : static_cast<double>(std::min(i - order + 1, spans()));
}

/// Value at `at` of the span's polynomial whose control points are d; they are those of the m-th derivative.
PlaneSpline::Homogeneous PlaneSpline::de_boor(std::vector<Homogeneous> d, std::size_t span, std::size_t m,
                                              double at) const {
  const std::size_t degree = d.size() - 1;
  for (std::size_t r = 1; r <= degree; ++r) {
    for (std::size_t i = degree; i >= r; --i) {
      const double low = knot(span + m + i), high = knot(span + m + i + 1 + degree - r);
      const double part = (at - low) / (high - low);
      d[i] = blend(d[i - 1], d[i], 1 - part, part);
    }
  }
  return d[degree];
}

SplineValue PlaneSpline::eval(std::size_t span, double u) const {
  const double at = static_cast<double>(span) + u;
  std::vector<Homogeneous> d(static_cast<std::size_t>(order_));
  for (std::size_t i = 0; i < d.size(); ++i) {
    const SplineControl& p = points_[span + i];
    d[i] = {p.first * p.weight, p.second * p.weight, p.weight};
  }
  std::array<Homogeneous, 3> h{};  // the weighted sums and their derivatives
  for (std::size_t m = 0; m < h.size() && !d.empty(); ++m) {
    h[m] = de_boor(d, span, m, at);
    const auto degree = static_cast<double>(d.size() - 1);
    for (std::size_t i = 0; i + 1 < d.size(); ++i) {
      const double scale = degree / (knot(span + m + i + d.size()) - knot(span + m + i + 1));
      d[i] = blend(d[i], d[i + 1], -scale, scale);
    }
    d.pop_back();
  }
  // quotient rule: C = A/w, C' = (A' - w' C)/w, C'' = (A'' - 2 w' C' - w'' C)/w
  const double w = h[0].weight;
  SplineValue v;
  v.first = h[0].first / w;
  v.second = h[0].second / w;
  v.first_d1 = (h[1].first - h[1].weight * v.first) / w;
  v.second_d1 = (h[1].second - h[1].weight * v.second) / w;
  v.first_d2 = (h[2].first - 2 * h[1].weight * v.first_d1 - h[2].weight * v.first) / w;
  v.second_d2 = (h[2].second - 2 * h[1].weight * v.second_d1 - h[2].weight * v.second) / w;
  return v;
}

double PlaneSpline::length(std::size_t span, double from, double to) const {
  const double whole = gauss(*this, span, from, to);
  // points that lie on each other far from zero: below this there is nothing but rounding
  const double rounding = speed_rounding(span) * (to - from);
  int parts = kMostParts;
  return refine(*this, span, from, to, whole, std::max(kLengthTolerance * whole, rounding), kMostHalvings,
                parts);
}

/// Bound of the error that rounding makes in the speed by u within a span.
double PlaneSpline::speed_rounding(std::size_t span) const {
  double largest = 0, least_weight = points_[span].weight, most_weight = least_weight;
  for (std::size_t i = span; i < span + static_cast<std::size_t>(order_); ++i) {
    const SplineControl& p = points_[i];
    largest = std::max({largest, std::fabs(p.first), std::fabs(p.second)});
    least_weight = std::min(least_weight, p.weight);
    most_weight = std::max(most_weight, p.weight);
  }
  return kSpeedRounding * order_ * largest * (most_weight / least_weight);
}

double PlaneSpline::length() const {
  double sum = 0;
  for (std::size_t span = 0; span < spans(); ++span) sum += length(span, 0, 1);
  return sum;
}

}  // namespace kadr
