#include "planner/positioning/link_modes.h"

#include <cmath>
#include <optional>

#include "machine/motor.h"

namespace kadr::planner {
namespace {

constexpr int kNewtonSteps = 60;
constexpr double kSameRoot = 1e-6;  ///< relative distance of two roots that are one

/// A complex number by + - * / alone, the same bits with every compiler.
struct Complex {
  double re = 0, im = 0;
};
Complex operator+(Complex a, Complex b) { return {a.re + b.re, a.im + b.im}; }
Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
Complex operator*(Complex a, Complex b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
Complex operator/(Complex a, Complex b) {
  const double size = b.re * b.re + b.im * b.im;
  return {(a.re * b.re + a.im * b.im) / size, (a.im * b.re - a.re * b.im) / size};
}
double size_of(Complex a) { return std::sqrt(a.re * a.re + a.im * a.im); }

/// c4 s^4 + c3 s^3 + c2 s^2 + c1 s + c0.
struct Quartic {
  double c4, c3, c2, c1, c0;
  Complex at(Complex s) const {
    Complex sum{c4, 0};
    for (const double c : {c3, c2, c1, c0}) sum = sum * s + Complex{c, 0};
    return sum;
  }
  Complex slope(Complex s) const {
    Complex sum{4 * c4, 0};
    for (const double c : {3 * c3, 2 * c2, c1}) sum = sum * s + Complex{c, 0};
    return sum;
  }
};

Quartic characteristic(const machine::TwoMassModel& m, const machine::Motor& motor) {
  const double m0 = m.base_mass_kg, m1 = m.link_mass_kg, k = m.link_stiffness_N_per_m,
               c = m.link_damping_Ns_per_m;
  const double b = motor.damping_Ns_per_m() + m.base_friction_Ns_per_m, km = motor.stiffness();
  return {m0 * m1, m0 * c + (b + c) * m1, m0 * k + b * c + (km + k) * m1, b * k + km * c, km * k};
}

/// The root that Newton's method finds from an undamped one, if it oscillates.
std::optional<Complex> root_near(const Quartic& q, double omega_rad_s) {
  Complex s{0, omega_rad_s};
  for (int i = 0; i < kNewtonSteps; ++i) s = s - q.at(s) / q.slope(s);
  if (!(s.im > 0) || !(s.re <= 0)) return std::nullopt;
  return s;
}

void add_coupled_modes(const machine::TwoMassModel& m, const machine::Motor& motor,
                       std::vector<DrivenMode>& modes) {
  const double km = motor.stiffness();
  const Quartic q = characteristic(m, motor);
  // without damping: m0 m1 w^4 - (m0 k + (Km + k) m1) w^2 + Km k = 0
  const double sum =
      m.base_mass_kg * m.link_stiffness_N_per_m + (km + m.link_stiffness_N_per_m) * m.link_mass_kg;
  const double spread = std::sqrt(std::fmax(sum * sum - 4 * q.c4 * q.c0, 0.0));
  const double high = (sum + spread) / (2 * q.c4), low = q.c0 / (q.c4 * high);
  std::optional<Complex> last;
  for (const double square : {low, high}) {
    const std::optional<Complex> s = root_near(q, std::sqrt(square));
    if (!s || (last && size_of(*s - *last) <= kSameRoot * size_of(*s))) continue;
    last = s;
    const double omega = size_of(*s), zeta = -s->re / omega;
    if (!(zeta < kDampedEnough)) continue;
    const double residue = km * m.link_mass_kg / size_of(q.slope(*s));
    modes.push_back({{omega, zeta}, 2 * s->im * residue});
  }
}

}  // namespace

std::vector<DrivenMode> link_modes(const machine::AxisModel& axis) {
  std::vector<DrivenMode> modes;
  if (!axis.has_plant) return modes;
  const machine::TwoMassModel& m = axis.plant;
  const machine::Motor motor(axis);
  if (!motor.follows_command()) {
    add_coupled_modes(m, motor, modes);
    return modes;
  }
  const double omega = std::sqrt(m.link_stiffness_N_per_m / m.link_mass_kg);
  const double zeta = m.link_damping_Ns_per_m / (2 * std::sqrt(m.link_stiffness_N_per_m * m.link_mass_kg));
  if (zeta < kDampedEnough) modes.push_back({{omega, zeta}, 1});
  return modes;
}

}  // namespace kadr::planner
