#pragma once
#include <cmath>

namespace kadr::planner {

/// minimise() ends there at the latest.
inline constexpr int kMostEvaluations = 100;

/// A point and the value of a function there.
struct Minimum {
  double at = 0, value = 0;
};

/// Brent's search for a minimum between two points (Brent 1973, chapter 5): parabolas through the three best
/// points, golden sections where these do not help. At most kMostEvaluations; the same ones everywhere, since
/// only + - * / and sqrt take part.
/// @param tolerance  of the place, absolute, > 0
template <class Function>
Minimum minimise(Function&& f, double low, double high, double tolerance) {
  const double golden = (3.0 - std::sqrt(5.0)) / 2;
  double x = low + golden * (high - low), w = x, v = x;
  double fx = f(x), fw = fx, fv = fx;
  double step = 0, before = 0;
  for (int i = 0; i < kMostEvaluations; ++i) {
    const double middle = (low + high) / 2;
    if (std::fabs(x - middle) <= 2 * tolerance - (high - low) / 2) break;
    // a parabola through x, w and v, unless it leaves the bracket or shrinks too slowly
    double p = 0, q = 0;
    if (std::fabs(before) > tolerance) {
      const double r = (x - w) * (fx - fv);
      q = (x - v) * (fx - fw);
      p = (x - v) * q - (x - w) * r;
      q = 2 * (q - r);
      if (q > 0) p = -p;
      q = std::fabs(q);
    }
    const double last = before;
    before = step;
    if (q > 0 && std::fabs(p) < std::fabs(q * last / 2) && p > q * (low - x) && p < q * (high - x)) {
      step = p / q;
      const double to = x + step;
      if (to - low < 2 * tolerance || high - to < 2 * tolerance) step = x < middle ? tolerance : -tolerance;
    } else {
      before = (x < middle ? high : low) - x;
      step = golden * before;
    }
    const double u = x + (std::fabs(step) >= tolerance ? step : step > 0 ? tolerance : -tolerance);
    const double fu = f(u);
    if (fu <= fx) {
      (u < x ? high : low) = x;
      v = w, fv = fw, w = x, fw = fx, x = u, fx = fu;
    } else {
      (u < x ? low : high) = u;
      if (fu <= fw || w == x) {
        v = w, fv = fw, w = u, fw = fu;
      } else if (fu <= fv || v == x || v == w) {
        v = u, fv = fu;
      }
    }
  }
  return {x, fx};
}

}  // namespace kadr::planner
