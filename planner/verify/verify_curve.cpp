#include "planner/verify/verify_curve.h"

#include <cmath>

namespace kadr::planner {

VerifiedDerivatives verified_curve(const PathCurve& curve, double local_s) {
  const double t = curve.t(local_s);
  std::array<double, kProgramAxes> f1{}, f2{}, f3{};
  double p11 = 0, p12 = 0, p22 = 0, p13 = 0;
  for (std::size_t k = 0; k < curve.axes(); ++k) {
    double p1 = 1, p2 = 0, p3 = 0;  // t^(n-1), t^(n-2), t^(n-3), 0 for negative powers
    for (std::size_t n = 1; n < PathCurve::kPowers; ++n) {
      const double c = curve.coefficient(k, n), m = static_cast<double>(n);
      f1[k] += c * m * p1;
      f2[k] += c * m * (m - 1) * p2;
      f3[k] += c * m * (m - 1) * (m - 2) * p3;
      p3 = p2, p2 = p1, p1 *= t;
    }
    p11 += f1[k] * f1[k], p12 += f1[k] * f2[k], p22 += f2[k] * f2[k], p13 += f1[k] * f3[k];
  }
  // derivatives of w by t, then by s: d/ds = w d/dt
  const double w = 1 / std::sqrt(p11);
  const double w_t = -w * w * w * p12;
  const double w_tt = 3 * w * w * w * w * w * p12 * p12 - w * w * w * (p22 + p13);
  VerifiedDerivatives d;
  for (std::size_t k = 0; k < curve.axes(); ++k) {
    d.d1[k] = w * f1[k];
    const double slope = w_t * f1[k] + w * f2[k];  // of x' by t
    d.d2[k] = w * slope;
    d.d3[k] = w * (w_t * slope + w * (w_tt * f1[k] + 2 * w_t * f2[k] + w * f3[k]));
  }
  return d;
}

bool turns_back(const PathCurve& curve) {
  constexpr int kPlaces = 32;
  for (int k = 1; k <= kPlaces; ++k) {
    double along = 0;
    for (std::size_t j = 0; j < curve.axes(); ++j)
      along += curve.coefficient(j, 1) * curve.derivative(j, static_cast<double>(k) / kPlaces);
    if (along < 0) return true;
  }
  return false;
}

}  // namespace kadr::planner
