#include "planner/point_to_point/residual.h"

#include <algorithm>
#include <cmath>

#include "machine/base/numbers.h"
#include "planner/point_to_point/minimise.h"

namespace kadr::planner {
namespace {

double decay(const Mode& mode, double time_s) {
  return mode.zeta == 0.0 ? 1.0 : exact_exp(std::fmax(-700.0, -mode.zeta * mode.omega_rad_s * time_s));
}

/// |1 - e^{-S t}| with S = zeta w + i wd
double one_less_turned(const Mode& mode, double time_s) {
  if (mode.zeta == 0.0) return 2 * std::fabs(exact_sincos(mode.omega_rad_s * time_s / 2).sin);
  const double e = decay(mode, time_s);
  const SinCos turn = exact_sincos(mode.damped_rad_s() * time_s);
  const double re = 1 - e * turn.cos, im = e * turn.sin;
  return std::sqrt(re * re + im * im);
}

/// Largest |y| from the first extremum on or now, of y'' + 2 zeta w y' + w^2 y = 0.
double free_peak(double y, double dy, const Mode& mode) {
  const double w = mode.omega_rad_s, wd = mode.damped_rad_s(), z = mode.zeta;
  if (y == 0.0 && dy == 0.0) return 0.0;
  // y' = 0 where tan(wd t) = dy wd/(w^2 y + zeta w dy)
  double angle = exact_atan2(dy * wd, w * w * y + z * w * dy);
  if (angle < 0.0) angle += kPi;
  const SinCos at = exact_sincos(angle);
  const double extremum = decay(mode, angle / wd) * (y * at.cos + (dy + z * w * y) / wd * at.sin);
  return std::max(std::fabs(y), std::fabs(extremum));
}

}  // namespace

LinkState advance_link(const LinkState& state, const Mode& mode, double a, double j, double t) {
  const double w = mode.omega_rad_s, wd = mode.damped_rad_s(), zw = mode.zeta * w;
  const double w2 = w * w, drift = -j / w2;
  const double rest = -a / w2 + 2 * mode.zeta * j / (w2 * w);
  const double y = state.link_u - rest, dy = state.link_u_s - drift;
  const double e = decay(mode, t);
  const SinCos turn = exact_sincos(wd * t);
  return {rest + drift * t + e * (y * turn.cos + (dy + zw * y) / wd * turn.sin),
          drift + e * (dy * turn.cos - (w2 * y + zw * dy) / wd * turn.sin)};
}

LinkState link_at(const PointLaw& law, const DrivenMode& driven, double time_s) {
  LinkState state;
  for (const PointPiece& p : law.pieces()) {
    if (time_s <= p.begin_s) return state;
    state = advance_link(state, driven.mode, driven.gain * p.accel_u_s2, driven.gain * p.jerk_u_s3,
                         std::min(p.duration_s, time_s - p.begin_s));
  }
  if (time_s > law.duration_s()) state = advance_link(state, driven.mode, 0, 0, time_s - law.duration_s());
  return state;
}

double envelope_u(const LinkState& s, const Mode& mode) {
  const double quadrature = (s.link_u_s + mode.zeta * mode.omega_rad_s * s.link_u) / mode.damped_rad_s();
  return std::sqrt(s.link_u * s.link_u + quadrature * quadrature);
}

double residual_amplitude_u(const PointLaw& law, const DrivenMode& driven) {
  const Mode& mode = driven.mode;
  const double wd = mode.damped_rad_s(), zw = mode.zeta * mode.omega_rad_s;
  // 1/S = (zw - i wd)/w^2
  const double w2 = mode.omega_rad_s * mode.omega_rad_s, re = zw / w2, im = -wd / w2;
  double sum_re = 0, sum_im = 0;
  for (const PointEdge& e : law.edges()) {
    // da/S - dj/S^2 = (da - dj/S)/S
    const double c_re = e.accel_u_s2 - e.jerk_u_s3 * re, c_im = -e.jerk_u_s3 * im;
    const double p_re = c_re * re - c_im * im, p_im = c_re * im + c_im * re;
    const double before_s = law.duration_s() - e.time_s, fall = decay(mode, before_s);
    const SinCos turn = exact_sincos(-wd * before_s);
    sum_re += fall * (p_re * turn.cos - p_im * turn.sin);
    sum_im += fall * (p_re * turn.sin + p_im * turn.cos);
  }
  return driven.gain * std::sqrt(sum_re * sum_re + sum_im * sum_im) / wd;
}

double t_law_amplitude_u(double distance_u, double duration_s, double xi, const Mode& mode) {
  const double ramp_s = xi * duration_s, shift_s = duration_s - ramp_s;
  return distance_u / (ramp_s * shift_s) / (mode.damped_rad_s() * mode.omega_rad_s) *
         one_less_turned(mode, ramp_s) * one_less_turned(mode, shift_s);
}

ResidualPeaks residual_peaks(const LinkState& end, const Mode& mode) {
  const double w = mode.omega_rad_s;
  return {free_peak(end.link_u, end.link_u_s, mode),
          free_peak(end.link_u_s, -2 * mode.zeta * w * end.link_u_s - w * w * end.link_u, mode)};
}

double worst_amplitude_u(const PointLaw& law, const DrivenMode& driven, double band, int samples) {
  const auto amplitude = [&](double off) {
    DrivenMode d = driven;
    d.mode.omega_rad_s *= 1 + off;
    return residual_amplitude_u(law, d);
  };
  if (band == 0.0) return amplitude(0);
  const double step = band / samples;
  double worst = -1, at = 0;
  for (int i = -samples; i <= samples; ++i) {
    const double x = amplitude(i * step);
    if (x > worst) worst = x, at = i * step;
  }
  const Minimum refined = minimise([&](double off) { return -amplitude(off); }, std::max(-band, at - step),
                                   std::min(band, at + step), 1e-9);
  return std::max(worst, -refined.value);
}

}  // namespace kadr::planner
