#include <cmath>

#include "plant/integrator.h"

namespace kadr::plant {

namespace {

/// Base motion in one control tick: cubic through the command, in m and ticks; a(theta) = a0 + a1 theta.
struct BaseMotion {
  double v0, a0, a1;
};

/// Paper 001's prescribed base. In the tick its acceleration is linear, so the link's equation
///
///   x1'' + q1 x1' + p1 x1 = -(a0 + a1 theta)
///
/// is solved by one 4x4 exponential over (x1, v1, a, a1). A jump of the base's speed between two ticks (a
/// corner taken without a stop) leaves the tool's speed as it was: the link's speed jumps the other way.
class Rigid final : public Integrator {
 public:
  Rigid(AxisMotion& axis, bool energy) : axis_(axis), energy_(energy) {
    const AxisEquations& eq = axis.equations;
    const Matrix4 augmented{{{{0, 1, 0, 0}, {-eq.p1, -eq.q1, -1, 0}, {0, 0, 0, 1}, {0, 0, 0, 0}}}};
    whole_tick_ = exponential(augmented);
    parts_ = std::floor(std::sqrt(eq.p1) + eq.q1) + 1;
  }

  Outcome advance(const StepBatch& batch) override {
    const AxisPulses& pulses = batch.axis[static_cast<std::size_t>(axis_.axis)];
    const AxisCommand& command = pulses.command;
    const AxisEquations& eq = axis_.equations;
    const double speed_m = eq.metre_per_unit * eq.tau_s;  // m per tick of 1 unit per s
    const double moved_m = (command.position_end_u - command.position_begin_u) * eq.metre_per_unit;
    const double begin_m = command.speed_begin_u_s * speed_m;
    const double end_m = command.speed_end_u_s * speed_m;
    // by the mean acceleration, so that the rounding of a large position can't push the link
    const double slope_m = 6 * (begin_m + end_m) - 12 * moved_m;
    const BaseMotion base{begin_m, (end_m - begin_m) - slope_m / 2, slope_m};

    Vector4& z = axis_.z;
    const double before_m = z[kBaseSpeed];
    z[kLinkSpeed] -= begin_m - before_m;
    if (energy_) add_work(before_m, base);
    const Vector4 link = whole_tick_ * Vector4{z[kLink], z[kLinkSpeed], base.a0, base.a1};
    z = {0, end_m, link[0], link[1]};
    axis_.node += pulses.net_steps();
    axis_.equilibrium_u = command.position_end_u;
    axis_.motor_force_N = force(base.a0 + base.a1, end_m, link[0], link[1]);
    return {};
  }
  void reset() override {}

 private:
  // force of the motor for this motion of the base: m0 a + b0 v0 - k x1 - c v1
  double force(double accel_m, double speed_m, double link_m, double link_speed_m) const {
    const machine::TwoMassModel& m = axis_.equations.model;
    const double tau_s = axis_.equations.tau_s;
    return m.base_mass_kg * accel_m / (tau_s * tau_s) + m.base_friction_Ns_per_m * speed_m / tau_s -
           m.link_stiffness_N_per_m * link_m - m.link_damping_Ns_per_m * link_speed_m / tau_s;
  }

  // work of that force and of the impulse at the tick's beginning, which changes the base's kinetic energy alone
  void add_work(double before_m, const BaseMotion& base) {
    const machine::TwoMassModel& m = axis_.equations.model;
    const double tau_s = axis_.equations.tau_s;
    axis_.work.add_motor(0.5 * m.base_mass_kg * (base.v0 * base.v0 - before_m * before_m) / (tau_s * tau_s));
    Vector<2> link{axis_.z[kLink], axis_.z[kLinkSpeed]};
    const double h = 1 / parts_;
    for (double part = 0; part < parts_; ++part) {
      const double at = part * h;
      add_part(link, {base.v0 + at * (base.a0 + at * base.a1 / 2), base.a0 + at * base.a1, base.a1}, h);
    }
  }

  // Taylor series of the link over h and the integrals of the products, as TaylorAxis does
  void add_part(Vector<2>& link, const BaseMotion& base, double h) {
    constexpr int kOrders = 26;
    const AxisEquations& eq = axis_.equations;
    const machine::TwoMassModel& m = eq.model;
    std::array<double, kOrders + 1> x{}, w{}, v{}, a{}, f{};
    x[0] = link[0];
    w[0] = link[1];
    v[0] = base.v0;
    v[1] = base.a0 * h;
    v[2] = base.a1 * h * h / 2;
    a[0] = base.a0;
    a[1] = base.a1 * h;
    for (std::size_t n = 0; n < kOrders; ++n) {
      const double over = h / static_cast<double>(n + 1);
      x[n + 1] = over * w[n];
      w[n + 1] = over * (-eq.p1 * x[n] - eq.q1 * w[n] - a[n]);
      f[n] = force(a[n], v[n], x[n], w[n]);
    }
    double force_v = 0, v_v = 0, w_w = 0;
    for (std::size_t n = kOrders; n-- > 0;) {
      double fv = 0, vv = 0, ww = 0;
      for (std::size_t j = 0; j <= n; ++j) {
        fv += f[j] * v[n - j];
        vv += v[j] * v[n - j];
        ww += w[j] * w[n - j];
      }
      const double over = h / static_cast<double>(n + 1);
      force_v += over * fv;
      v_v += over * vv;
      w_w += over * ww;
    }
    axis_.work.add_motor(force_v);
    axis_.work.dissipated_J += (m.base_friction_Ns_per_m * v_v + m.link_damping_Ns_per_m * w_w) / eq.tau_s;
    link = {0, 0};
    for (std::size_t n = kOrders + 1; n-- > 0;) {
      link[0] += x[n];
      link[1] += w[n];
    }
  }

  AxisMotion& axis_;
  bool energy_;
  Matrix4 whole_tick_;
  double parts_ = 1;
};

}  // namespace

std::unique_ptr<Integrator> make_rigid(AxisMotion& axis, bool energy) {
  return std::make_unique<Rigid>(axis, energy);
}

}  // namespace kadr::plant
