#include "planner/point_to_point/synthesis.h"

#include <algorithm>
#include <cmath>

#include "planner/point_to_point/builders.h"
#include "planner/point_to_point/minimise.h"

namespace kadr::planner {
namespace {

constexpr double kRounding = 1e-12;   ///< relative; limits may be exceeded by so little
constexpr double kMostPeriods = 1e5;  ///< in a motion; angles stay below the 1e6 rad of exact_sincos
constexpr int kPointsPerPeriod = 24;
constexpr double kXiTolerance = 1e-10;

double ceil_rounded(double x) { return std::ceil(x * (1 - kRounding)); }
double floor_rounded(double x) { return std::floor(x * (1 + kRounding)); }

tl::unexpected<PointFault> too_short(std::string what, double measured_s, double allowed_s) {
  return tl::unexpected(PointFault{PointFault::Kind::too_short, std::move(what), measured_s, allowed_s, "s"});
}

/// The least amplitude over D1. Between two zeros of either factor of eq. 20 there is one minimum; the grid
/// is fine enough to bracket each of them.
TChoice least_amplitude(const PointTask& task, double duration_s, const DrivenMode& driven,
                        const XiRange& range) {
  const auto amplitude = [&](double xi) {
    return driven.gain * t_law_amplitude_u(task.distance_u, duration_s, xi, driven.mode);
  };
  const double periods = (range.high - range.low) * duration_s / driven.mode.period_s();
  const int cells = std::max(8, static_cast<int>(std::ceil(kPointsPerPeriod * periods)));
  const double step = (range.high - range.low) / cells;
  const auto xi_of = [&](int i) { return i == cells ? range.high : range.low + i * step; };
  Minimum best{range.low, amplitude(range.low)};
  const auto take = [&](const Minimum& m) {
    if (m.value < best.value) best = m;
  };
  double before = best.value, here = amplitude(xi_of(1));
  for (int i = 1; i < cells; ++i) {
    const double next = amplitude(xi_of(i + 1));
    if (here < before && here <= next) take(minimise(amplitude, xi_of(i - 1), xi_of(i + 1), kXiTolerance));
    before = here, here = next;
  }
  take({range.high, here});
  TChoice choice;
  choice.xi = best.at;
  choice.amplitude_u = best.value;
  return choice;
}

}  // namespace

double shortest_time_s(const PointTask& t) {
  const double d = t.distance_u, v = t.speed_limit_u_s, a = t.accel_limit_u_s2;
  return d <= v * v / a ? 2 * std::sqrt(d / a) : d / v + v / a;
}

bool XiRange::has(double xi) const { return xi >= low * (1 - kRounding) && xi <= high * (1 + kRounding); }

XiRange xi_range(const PointTask& t, double duration_s) {
  const double r = t.distance_u / (t.accel_limit_u_s2 * duration_s * duration_s);
  double under_root = 1 - 4 * r;
  if (std::fabs(under_root) <= 4 * kRounding) under_root = 0;
  if (under_root < 0) return {1, 0};
  XiRange range;
  range.low = 2 * r / (1 + std::sqrt(under_root));
  range.high = std::min(0.5, 1 - t.distance_u / (t.speed_limit_u_s * duration_s));
  // the fastest law's interval is a point, whose ends rounding may swap
  if (range.low > range.high && range.low <= range.high * (1 + 1e3 * kRounding)) range.high = range.low;
  return range;
}

PointResult<std::vector<ZeroLaw>> zero_laws(const PointTask& task, double duration_s, const Mode& mode,
                                            const Load& load) {
  const XiRange range = xi_range(task, duration_s);
  if (range.empty()) return too_short("time", duration_s, shortest_time_s(task));
  const double periods = duration_s / mode.period_s();
  if (periods > kMostPeriods)
    return tl::unexpected(PointFault{PointFault::Kind::too_fine, "periods of the vibration in the motion",
                                     periods, kMostPeriods, ""});
  std::vector<ZeroLaw> found;
  const auto look = [&](ZeroBranch branch, double count, double xi) {
    if (count < 1 || !range.has(xi)) return;
    const bool known = std::any_of(found.begin(), found.end(), [&](const ZeroLaw& z) {
      return std::fabs(z.xi - xi) <= kRounding;  // both at once: a double zero
    });
    if (!known)
      found.push_back({branch, static_cast<int>(count), std::min(xi, 0.5),
                       t_law_energy_J(task.distance_u, duration_s, xi, load)});
  };
  for (double n = ceil_rounded(range.low * periods); n <= floor_rounded(range.high * periods); ++n)
    look(ZeroBranch::ramp, n, n / periods);
  for (double m = ceil_rounded((1 - range.high) * periods); m <= floor_rounded((1 - range.low) * periods);
       ++m)
    look(ZeroBranch::rest, m, 1 - m / periods);
  // int a^2 dt is 2 d^2/(tf^3 xi (1 - xi)^2)
  const auto copper = [](double xi) { return 1 / (xi * (1 - xi) * (1 - xi)); };
  std::sort(found.begin(), found.end(), [&](const ZeroLaw& a, const ZeroLaw& b) {
    if (std::fabs(a.energy_J - b.energy_J) > kRounding * std::fabs(a.energy_J))
      return a.energy_J < b.energy_J;
    return copper(a.xi) < copper(b.xi);
  });
  return found;
}

PointResult<TChoice> best_t_law(const PointTask& task, double duration_s, const DrivenMode& driven,
                                const Load& load) {
  const auto zeros = zero_laws(task, duration_s, driven.mode, load);
  if (!zeros) return tl::unexpected(zeros.error());
  TChoice choice;
  if (driven.mode.zeta == 0.0 && !zeros->empty()) {
    choice.xi = zeros->front().xi;
    choice.zero = zeros->front();
    choice.amplitude_u = driven.gain * t_law_amplitude_u(task.distance_u, duration_s, choice.xi, driven.mode);
  } else {
    choice = least_amplitude(task, duration_s, driven, xi_range(task, duration_s));
  }
  choice.periods = static_cast<int>(std::lround(choice.xi * duration_s / driven.mode.period_s()));
  choice.energy_J = t_law_energy_J(task.distance_u, duration_s, choice.xi, load);
  return choice;
}

PointLaw FastZero::law(double distance_u) const {
  return ramp_law(distance_u, ramp_s, std::max(0.0, shift_s - ramp_s), ramp_s);
}

FastZero fastest_zero_law(const PointTask& t, const Mode& mode) {
  const double d = t.distance_u, v = t.speed_limit_u_s, a = t.accel_limit_u_s2, period_s = mode.period_s();
  FastZero best;
  const auto take = [&](const FastZero& candidate) {
    if (best.count == 0 || candidate.duration_s() < best.duration_s()) best = candidate;
  };
  const double at = std::min(v / a, std::sqrt(d / a)) / period_s;
  for (const double n : {floor_rounded(at), floor_rounded(at) + 1}) {
    if (n < 1) continue;
    const double ramp_s = n * period_s;
    take({ZeroBranch::ramp, static_cast<int>(n), ramp_s, std::max({d / (a * ramp_s), d / v, ramp_s})});
  }
  const double m = std::max(1.0, ceil_rounded(std::max(d / v, std::sqrt(d / a)) / period_s));
  take({ZeroBranch::rest, static_cast<int>(m), d / (a * m * period_s), m * period_s});
  return best;
}

DoubleZero fastest_double_zero(const PointTask& t, const Mode& mode) {
  const double period_s = mode.period_s();
  const double product = t.distance_u / (t.accel_limit_u_s2 * period_s * period_s);
  const double least_shift = std::max(1.0, ceil_rounded(t.distance_u / (t.speed_limit_u_s * period_s)));
  double best_ramp = 0, best_shift = 0;
  for (double n = 1; n <= std::max(1.0, ceil_rounded(std::sqrt(product))); ++n) {
    const double m = std::max({n, ceil_rounded(product / n), least_shift});
    const bool sooner = n + m < best_ramp + best_shift, same = n + m == best_ramp + best_shift;
    // of equal times the one with the longer ramp and less acceleration
    if (best_ramp == 0 || sooner || (same && n > best_ramp)) best_ramp = n, best_shift = m;
  }
  return {static_cast<int>(best_ramp), static_cast<int>(best_shift)};
}

std::optional<DoubleZero> double_zero_of(const PointTask& t, double duration_s, const Mode& mode) {
  const double period_s = mode.period_s(), total = ceil_rounded(duration_s / period_s);
  const double product = t.distance_u / (t.accel_limit_u_s2 * period_s * period_s);
  for (double n = 1; 2 * n <= total; ++n) {
    const double m = total - n;
    if (n * m < product * (1 - kRounding)) continue;
    if (m * period_s * t.speed_limit_u_s < t.distance_u * (1 - kRounding))
      return {};  // longer ramps are faster
    return DoubleZero{static_cast<int>(n), static_cast<int>(m)};
  }
  return {};
}

PointResult<PointLaw> steepest_t_law(const PointTask& task, double duration_s) {
  const XiRange range = duration_s > 0 ? xi_range(task, duration_s) : XiRange{1, 0};
  if (range.empty()) return too_short("time", duration_s, shortest_time_s(task));
  return t_law(task.distance_u, duration_s, range.low);
}

}  // namespace kadr::planner
