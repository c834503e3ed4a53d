#include "planner/time_law/jerk_motion.h"

#include <algorithm>
#include <cmath>

namespace kadr::planner {
namespace {

constexpr double kLeastPart = 1e-9;  ///< of a piece, that is parted from it
constexpr int kReductions = 40;      ///< of a node's acceleration; then it is 0
constexpr double kReduction = 0.8;

/// Extreme speeds of a piece of constant jerk that is parted where acceleration passes 0.
struct SpeedRange {
  double low, high;
  void add(double v) { low = std::min(low, v), high = std::max(high, v); }
};

void add_turning_point(SpeedRange& range, double v, double a0, double a1, double half_s) {
  if (a0 * a1 < 0.0) range.add(v + 0.5 * a0 * (half_s * a0 / (a0 - a1)));
}

SpeedRange speed_range(const IntervalMotion& m) {
  SpeedRange range{std::min(m.v0_u_s, m.v1_u_s), std::max(m.v0_u_s, m.v1_u_s)};
  range.add(m.middle_u_s());
  add_turning_point(range, m.v0_u_s, m.a0_u_s2, m.am_u_s2, 0.5 * m.time_s);
  add_turning_point(range, m.middle_u_s(), m.am_u_s2, m.a1_u_s2, 0.5 * m.time_s);
  return range;
}

/// Part of a change of acceleration that falls before a node: j0 t0/(j0 t0 + j1 t1).
double share(double j0, double t0, double j1, double t1) {
  const bool free0 = !(j0 < machine::kInfinity), free1 = !(j1 < machine::kInfinity);
  if (free0 != free1) return free0 ? 1.0 : 0.0;
  if (free0) j0 = j1 = 1.0;
  return j0 * t0 / (j0 * t0 + j1 * t1);
}

/// False if there is none, or one that runs back.
bool join(double ds, double v0, double v1, double a0, double a1, IntervalMotion& m) {
  if (!(0.25 * (v0 + v1) * (v0 + v1) + ds * (a0 - a1) / 3.0 >= 0.0)) return false;
  m = interval_motion(ds, v0, v1, a0, a1);
  return m.lowest_u_s() >= 0.0;
}

}  // namespace

double IntervalMotion::lowest_u_s() const { return speed_range(*this).low; }
double IntervalMotion::highest_u_s() const { return speed_range(*this).high; }

IntervalMotion interval_motion(double ds, double v0, double v1, double a0, double a1) {
  const double b = 0.5 * (v0 + v1);
  const double time = 2.0 * ds / (b + std::sqrt(b * b + ds * (a0 - a1) / 3.0));
  return {time, v0, v1, a0, 2.0 * (v1 - v0) / time - 0.5 * (a0 + a1), a1};
}

std::vector<IntervalMotion> jerk_motion(const std::vector<double>& s, const std::vector<double>& v,
                                        const std::vector<IntervalLimits>& limits, const NodeJerk& jerk) {
  const std::size_t n = s.size();
  std::vector<double> a(n, 0.0);
  const auto time = [&](std::size_t i) { return 2.0 * (s[i] - s[i - 1]) / (v[i - 1] + v[i]); };
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double t0 = time(i), t1 = time(i + 1);
    const double u0 = (v[i] - v[i - 1]) / t0, u1 = (v[i + 1] - v[i]) / t1;
    const double most = std::min(limits[i].accel_u_s2, limits[i + 1].accel_u_s2);
    a[i] = std::clamp(u0 + (u1 - u0) * share(jerk.before[i], t0, jerk.behind[i], t1), -most, most);
  }
  std::vector<IntervalMotion> out(n);
  bool all = false;
  for (int k = 0; !all; ++k) {
    all = true;
    for (std::size_t i = 1; i < n; ++i) {
      if (join(s[i] - s[i - 1], v[i - 1], v[i], a[i - 1], a[i], out[i])) continue;
      // without acceleration at both ends there is always one
      for (const std::size_t end : {i - 1, i}) a[end] = k < kReductions ? kReduction * a[end] : 0.0;
      all = false;
    }
  }
  return out;
}

void add_pieces(const IntervalMotion& m, double s_u, LimitedBy reason, std::int8_t axis,
                std::vector<JerkPiece>& out) {
  double s = s_u;
  const double t = 0.5 * m.time_s;
  const auto piece = [&](double duration, double v, double a, double jerk) {
    out.push_back({0.0, duration, s, v, a, jerk, reason, axis, 0.0});
    s += duration * (v + duration * (0.5 * a + jerk * duration / 6.0));
  };
  const auto half = [&](double v, double a, double jerk) {
    const double turn = -a / jerk;
    if (!(turn > kLeastPart * t && turn < (1.0 - kLeastPart) * t)) return piece(t, v, a, jerk);
    piece(turn, v, a, jerk);
    piece(t - turn, v + 0.5 * a * turn, 0.0, jerk);
  };
  half(m.v0_u_s, m.a0_u_s2, m.first_jerk_u_s3());
  half(m.middle_u_s(), m.am_u_s2, m.second_jerk_u_s3());
}

}  // namespace kadr::planner
