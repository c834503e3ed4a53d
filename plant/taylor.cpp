#include "plant/taylor.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kadr::plant {

namespace {

constexpr std::size_t kMaxOrder = 40;
constexpr std::size_t kSize = kMaxOrder + 1;
constexpr double kTermFloor_m = 1e-20;
constexpr double kMaxParts = 1e5;

using Series = std::array<double, kSize>;

constexpr Series reciprocals() {
  Series r{};
  for (std::size_t n = 1; n < r.size(); ++n) r[n] = 1.0 / static_cast<double>(n);
  return r;
}
constexpr Series kOver = reciprocals();

}  // namespace

struct TaylorAxis::Products {
  std::size_t orders;
  double h;  ///< length of the part, ticks
  const Series &force, &speed, &link_speed;
};

TaylorAxis::TaylorAxis(const AxisEquations& equations) : eq_(equations), rate_(equations.rate()) {}

// All coefficients carry h^n, so that a series' value at the end is the plain sum of its terms.
template <class Law>
bool TaylorAxis::advance_part(const Law& law, Vector4& z, double h, AxisWork* work) const {
  Series e, v, x, w, force;
  e[0] = z[kLag];
  v[0] = z[kBaseSpeed];
  x[0] = z[kLink];
  w[0] = z[kLinkSpeed];
  typename Law::template Series<kSize> pull(law, {e, v});
  std::size_t order = 0;
  for (int small = 0; small < 2;) {
    if (order == kMaxOrder) return false;
    const std::size_t n = order++;
    const double over = h * kOver[order];
    force[n] = pull.force(n);
    const double accel = force[n] - eq_.B * v[n] + eq_.p * x[n] + eq_.q * w[n];
    e[order] = over * v[n];
    v[order] = over * accel;
    x[order] = over * w[n];
    w[order] = over * (-accel - eq_.p1 * x[n] - eq_.q1 * w[n]);
    pull.advance(n, over);
    const double term = std::max(std::max(std::fabs(e[order]), std::fabs(v[order])),
                                 std::max(std::fabs(x[order]), std::fabs(w[order])));
    small = term < kTermFloor_m ? small + 1 : 0;
  }

  // smallest terms first
  Vector4 sum{};
  for (std::size_t n = order + 1; n-- > 0;) {
    sum[kLag] += e[n];
    sum[kBaseSpeed] += v[n];
    sum[kLink] += x[n];
    sum[kLinkSpeed] += w[n];
  }
  if (work) add_work(*work, {order, h, force, v, w});
  z = sum;
  return true;
}

// integrals over the part of (force - bm v0) v0 and b0 v0^2 + c v1^2, by the products of the series
void TaylorAxis::add_work(AxisWork& work, const Products& of) const {
  double force_v = 0, v_v = 0, w_w = 0;
  for (std::size_t n = of.orders; n-- > 0;) {
    double fv = 0, vv = 0, ww = 0;
    for (std::size_t j = 0; j <= n; ++j) {
      fv += of.force[j] * of.speed[n - j];
      vv += of.speed[j] * of.speed[n - j];
      ww += of.link_speed[j] * of.link_speed[n - j];
    }
    const double over = of.h * kOver[n + 1];
    force_v += over * fv;
    v_v += over * vv;
    w_w += over * ww;
  }
  const machine::TwoMassModel& m = eq_.model;
  // force is an acceleration in m per tick^2; v is in m per tick
  work.add_motor(m.base_mass_kg * force_v / (eq_.tau_s * eq_.tau_s) -
                 eq_.motor.damping_Ns_per_m() * v_v / eq_.tau_s);
  work.dissipated_J += (m.base_friction_Ns_per_m * v_v + m.link_damping_Ns_per_m * w_w) / eq_.tau_s;
}

Outcome TaylorAxis::advance(Vector4& z, double ticks, AxisWork* work) const {
  if (ticks == 0) return {};
  // a motor that slips runs through its law at this rate; the speed it can gain on the way is covered by rate_
  const double rate = rate_ + eq_.pull.bend_per_m() * std::fabs(z[kBaseSpeed]);
  const double parts = std::floor(ticks * rate) + 1;
  if (!(parts <= kMaxParts)) {
    return tl::unexpected(
        Fault{"MOTION_TOO_FAST", "the base moves too fast for its series to be cut up", -1});
  }
  const double h = ticks / parts;
  const bool converged = eq_.pull.with_law([&](const auto& law) {
    for (double part = 0; part < parts; ++part) {
      if (!advance_part(law, z, h, work)) return false;
    }
    return true;
  });
  if (converged) return {};
  return tl::unexpected(Fault{"SERIES_NOT_CONVERGED", "Taylor series of the axis after 40 orders", -1});
}

Outcome TaylorAxis::advance_tick(Vector4& z, const AxisPulses& pulses, AxisWork* work) const {
  Outcome outcome;
  std::int64_t now = 0;
  const double tick_per_base = 1 / eq_.control_ticks;
  pulses.for_each([&](std::uint16_t offset, int sign) {
    if (!outcome) return;
    outcome = advance(z, static_cast<double>(offset - now) * tick_per_base, work);
    now = offset;
    // the equilibrium moves by a step, the base does not
    z[kLag] -= sign * eq_.step_m;
  });
  if (!outcome) return outcome;
  return advance(z, (eq_.control_ticks - static_cast<double>(now)) * tick_per_base, work);
}

namespace {

class TaylorIntegrator final : public Integrator {
 public:
  explicit TaylorIntegrator(AxisMotion& axis) : axis_(axis), series_(axis.equations) {}
  Outcome advance(const StepBatch& batch) override {
    const AxisPulses& pulses = batch.axis[static_cast<std::size_t>(axis_.axis)];
    Outcome outcome = series_.advance_tick(axis_.z, pulses, nullptr);
    if (!outcome) return outcome;
    axis_.move_node(pulses.net_steps());
    axis_.motor_force_N = axis_.equations.motor_force_N(axis_.z);
    return {};
  }
  void reset() override {}

 private:
  AxisMotion& axis_;
  TaylorAxis series_;
};

}  // namespace

std::unique_ptr<Integrator> make_taylor(AxisMotion& axis) { return std::make_unique<TaylorIntegrator>(axis); }

}  // namespace kadr::plant
