#include "planner/bezier/corner.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kadr::planner {
namespace {

// beyond them: lines that go straight on, and lines that turn back
constexpr double kLeastSine = 1e-6;
constexpr double kMostSine = 0.999;

struct Spread {
  double sine, r;
};
// r of the least largest curvature by sin(theta/2), found by trying all r; the minimum is flat
constexpr std::array<Spread, 14> kSpread = {{{0.0, 0.365},
                                             {0.2, 0.360},
                                             {0.3, 0.360},
                                             {0.4, 0.350},
                                             {0.5, 0.345},
                                             {0.6, 0.330},
                                             {0.7, 0.315},
                                             {0.8, 0.290},
                                             {0.87, 0.260},
                                             {0.9, 0.240},
                                             {0.95, 0.190},
                                             {0.966, 0.170},
                                             {0.996, 0.070},
                                             {1.0, 0.030}}};

double spread(double sine) {
  for (std::size_t i = 1; i < kSpread.size(); ++i) {
    const Spread a = kSpread[i - 1], b = kSpread[i];
    if (sine <= b.sine) return a.r + (b.r - a.r) * (sine - a.sine) / (b.sine - a.sine);
  }
  return kSpread.back().r;
}

}  // namespace

std::optional<RoundedCorner> round_corner(std::span<const double> corner_u,
                                          std::span<const double> direction_before,
                                          std::span<const double> direction_after, double deviation_u,
                                          double most_trim_u) {
  const std::size_t axes = corner_u.size();
  double square = 0;  // |u1 - u0| = 2 sin(theta/2)
  for (std::size_t k = 0; k < axes; ++k) {
    const double turn = direction_after[k] - direction_before[k];
    square += turn * turn;
  }
  const double sine = 0.5 * std::sqrt(square);
  if (!(sine >= kLeastSine && sine <= kMostSine)) return {};
  const double r = spread(sine);
  const double per_trim = sine * (16 - 25 * r) / 16;
  RoundedCorner out;
  out.trim_u = std::min(deviation_u / per_trim, most_trim_u);
  out.deviation_u = out.trim_u * per_trim;
  const std::array<double, 3> share = {1, 1 - r, 1 - 2 * r};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t k = 0; k < axes; ++k)
      out.control_u.push_back(i < 3 ? corner_u[k] - share[i] * out.trim_u * direction_before[k]
                                    : corner_u[k] + share[5 - i] * out.trim_u * direction_after[k]);
  return out;
}

}  // namespace kadr::planner
