#include "planner/bezier/bezier_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "machine/base/require.h"

namespace kadr::planner {
namespace {

using Poly = std::vector<double>;  // by ascending powers

// halvings of [0, 1] until doubles don't differ
constexpr int kHalvings = 60;

double value(const Poly& c, double t) {
  double r = 0;
  for (std::size_t j = c.size(); j-- > 0;) r = r * t + c[j];
  return r;
}

Poly derived(const Poly& c) {
  Poly out;
  for (std::size_t j = 1; j < c.size(); ++j) out.push_back(static_cast<double>(j) * c[j]);
  return out;
}

void add_product(Poly& sum, const Poly& a, const Poly& b, double factor) {
  sum.resize(std::max(sum.size(), a.size() + b.size() - 1));
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) sum[i + j] += factor * a[i] * b[j];
}

double bracketed_zero(const Poly& c, double low, double high) {
  const bool rising = value(c, low) < 0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    ((value(c, middle) < 0) == rising ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double dot(const BezierVector& a, const BezierVector& b) {
  double sum = 0;
  for (std::size_t k = 0; k < kMostBezierAxes; ++k) sum += a[k] * b[k];
  return sum;
}

double norm(const BezierVector& a) { return std::sqrt(dot(a, a)); }

std::vector<double> zeros_in_unit(const std::vector<double>& c) {
  Poly p = c;
  while (!p.empty() && p.back() == 0) p.pop_back();
  if (p.size() < 2) return {};
  std::vector<double> ends = {0};
  for (const double t : zeros_in_unit(derived(p))) ends.push_back(t);
  ends.push_back(1);
  std::vector<double> zeros;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double a = value(p, ends[i]), b = value(p, ends[i + 1]);
    if (a == 0 && ends[i] > 0) zeros.push_back(ends[i]);
    if ((a < 0 && b > 0) || (a > 0 && b < 0)) zeros.push_back(bracketed_zero(p, ends[i], ends[i + 1]));
  }
  return zeros;
}

Bezier::Bezier(int axes, const std::vector<BezierVector>& control)
    : axes_(axes), degree_(static_cast<int>(control.size()) - 1), control_(control) {
  require(degree_ >= 1 && degree_ <= 3, "a Bezier curve has degree 1 to 3");
  const std::vector<BezierVector>& p = control_;
  for (std::size_t k = 0; k < kMostBezierAxes; ++k) {
    c_[0][k] = p[0][k];
    if (degree_ == 1) {
      c_[1][k] = p[1][k] - p[0][k];
    } else if (degree_ == 2) {
      c_[1][k] = 2 * (p[1][k] - p[0][k]);
      c_[2][k] = p[2][k] - 2 * p[1][k] + p[0][k];
    } else {
      c_[1][k] = 3 * (p[1][k] - p[0][k]);
      c_[2][k] = 3 * (p[2][k] - 2 * p[1][k] + p[0][k]);
      c_[3][k] = p[3][k] - 3 * p[2][k] + 3 * p[1][k] - p[0][k];
    }
  }
}

BezierVector Bezier::position(double t) const {
  if (t == 1) return control_.back();
  BezierVector out{};
  for (std::size_t k = 0; k < kMostBezierAxes; ++k)
    out[k] = c_[0][k] + t * (c_[1][k] + t * (c_[2][k] + t * c_[3][k]));
  return out;
}

BezierVector Bezier::derivative(double t) const {
  BezierVector out{};
  for (std::size_t k = 0; k < kMostBezierAxes; ++k)
    out[k] = c_[1][k] + t * (2 * c_[2][k] + t * (3 * c_[3][k]));
  return out;
}

BezierVector Bezier::second(double t) const {
  BezierVector out{};
  for (std::size_t k = 0; k < kMostBezierAxes; ++k) out[k] = 2 * c_[2][k] + t * (6 * c_[3][k]);
  return out;
}

BezierVector Bezier::curvature_vector(double t) const {
  const BezierVector d = derivative(t), dd = second(t);
  const double d2 = dot(d, d), along = dot(d, dd) / d2;
  BezierVector out{};
  for (std::size_t k = 0; k < kMostBezierAxes; ++k) out[k] = (dd[k] - d[k] * along) / d2;
  return out;
}

SmallestRadius smallest_radius(const Bezier& curve) {
  std::vector<double> places = {0, 1};
  if (curve.degree() == 2) {
    const BezierVector dd = curve.second(0);
    const double t = -dot(curve.derivative(0), dd) / dot(dd, dd);
    if (t > 0 && t < 1) places.push_back(t);
  } else if (curve.degree() == 3) {
    Poly n, d;
    std::vector<Poly> first, second;
    for (std::size_t k = 0; k < static_cast<std::size_t>(curve.axes()); ++k) {
      const auto c = [&](std::size_t j) { return curve.coefficient(j)[k]; };
      first.push_back({c(1), 2 * c(2), 3 * c(3)});
      second.push_back({2 * c(2), 6 * c(3)});
      add_product(d, first[k], first[k], 1);
    }
    for (std::size_t k = 0; k < first.size(); ++k)
      for (std::size_t l = k + 1; l < first.size(); ++l) {
        Poly cross;
        add_product(cross, first[k], second[l], 1);
        add_product(cross, first[l], second[k], -1);
        cross.resize(3);  // the cubes cancel
        add_product(n, cross, cross, 1);
      }
    if (!n.empty()) {
      Poly slope;
      add_product(slope, derived(n), d, 1);
      add_product(slope, n, derived(d), -3);
      for (const double t : zeros_in_unit(slope)) places.push_back(t);
    }
  }
  SmallestRadius best{std::numeric_limits<double>::infinity(), 0};
  for (const double t : places) {
    const double curvature = curve.curvature_per_u(t);
    // at a cusp speed is 0 and the curvature not a number
    const double radius = curvature == curvature ? 1 / curvature : 0;
    if (radius < best.radius_u) best = {radius, t};
  }
  return best;
}

}  // namespace kadr::planner
