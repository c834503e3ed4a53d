#include "planner/point_to_point/work.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kadr::planner {
namespace {

/// Places inside a piece, in order, with its ends.
struct Cuts {
  std::array<double, 5> at_s{};
  std::size_t count = 0;

  void add(double time_s, double duration_s) {
    if (time_s > 0.0 && time_s < duration_s) at_s[count++] = time_s;
  }
};

/// Where the power of a piece may be largest: P/m = v (q a + c) with v of second and a of first order has
///   P'/m = a (q a + c) + v q j = 3/2 q j^2 t^2 + j (3 q a0 + c) t + a0 (q a0 + c) + q j v0.
Cuts power_extrema(const PointPiece& p, double q, double c) {
  Cuts cuts;
  const double a0 = p.accel_u_s2, j = p.jerk_u_s3;
  const double c2 = 1.5 * q * j * j, c1 = j * (3 * q * a0 + c), c0 = a0 * (q * a0 + c) + q * j * p.speed_u_s;
  const double root2 = c1 * c1 - 4 * c2 * c0;
  if (c2 == 0.0 || root2 < 0.0) return cuts;
  // without cancellation: the larger root first, the other one by Vieta
  const double half = -(c1 + (c1 < 0 ? -std::sqrt(root2) : std::sqrt(root2))) / 2;
  cuts.add(half / c2, p.duration_s);
  if (half != 0.0) cuts.add(c0 / half, p.duration_s);
  return cuts;
}

}  // namespace

double printed_gravity_m_s2(double distance_m, double duration_s) {
  return 9.81 * distance_m / (duration_s * duration_s);
}

Work work_of(const PointLaw& law, const Load& load) {
  const double q = load.inertia_ratio(), c = load.weight_m_s2(), m = load.mass_kg;
  Work w;
  for (const PointPiece& p : law.pieces()) {
    const auto look = [&](double time_s) {
      const PointState s = p.at(time_s);
      const double power_W = m * s.speed_u_s * (q * s.accel_u_s2 + c);
      w.peak_W = std::max(w.peak_W, power_W);
      w.least_W = std::min(w.least_W, power_W);
    };
    look(0);
    look(p.duration_s);
    const Cuts extrema = power_extrema(p, q, c);
    for (std::size_t i = 0; i < extrema.count; ++i) look(extrema.at_s[i]);

    const double turn_s = p.jerk_u_s3 != 0.0 ? -(c / q + p.accel_u_s2) / p.jerk_u_s3 : 0.0;
    const bool turns = turn_s > 0.0 && turn_s < p.duration_s;
    PointState from = p.at(0);
    for (const double to_s : {turns ? turn_s : p.duration_s, p.duration_s}) {
      const PointState to = p.at(to_s);
      const double work_J = m * (q * (to.speed_u_s - from.speed_u_s) * (to.speed_u_s + from.speed_u_s) / 2 +
                                 c * (to.position_u - from.position_u));
      (work_J > 0 ? w.positive_J : w.recuperated_J) += std::fabs(work_J);
      from = to;
    }
    const double a = p.accel_u_s2, j = p.jerk_u_s3, h = p.duration_s;
    w.copper_m2_s3 += h * (a * a + h * (a * j + h * j * j / 3));
  }
  w.absolute_J = w.positive_J + w.recuperated_J;
  return w;
}

double t_law_energy_J(double distance_m, double duration_s, double xi, const Load& load) {
  const double accel = distance_m / (duration_s * duration_s * xi * (1 - xi));
  const double speed = distance_m / (duration_s * (1 - xi));
  const double c = std::fabs(load.weight_m_s2());  // played backwards, a motion with -c has power -P
  return load.mass_kg *
         (c * distance_m + speed * xi * duration_s * std::fmax(0.0, load.inertia_ratio() * accel - c));
}

}  // namespace kadr::planner
