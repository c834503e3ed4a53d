#include <algorithm>
#include <cmath>

#include "plant/integrator.h"

namespace kadr::plant {

namespace {

/// CVODE as the textbook uses it at discontinuities: stopped at every pulse and restarted behind it. Slow (5
/// to 10 us per pulse) and plain; the states are relative to the current node, so no
/// precision is lost with the position.
class Reference final : public Integrator {
 public:
  Reference(AxisMotion& axis, double tolerance_um)
      : axis_(axis), cvode_(tolerances(axis.equations, tolerance_um), equations, &axis.equations) {}

  Outcome advance(const StepBatch& batch) override {
    const AxisPulses& pulses = batch.axis[static_cast<std::size_t>(axis_.axis)];
    const double tick_per_base = 1 / axis_.equations.control_ticks;
    Outcome outcome;
    std::int64_t now = 0;
    pulses.for_each([&](std::uint16_t offset, int sign) {
      if (!outcome) return;
      outcome = integrate(static_cast<double>(offset - now) * tick_per_base);
      now = offset;
      axis_.z[kLag] -= sign * axis_.equations.step_m;
    });
    if (outcome)
      outcome = integrate((axis_.equations.control_ticks - static_cast<double>(now)) * tick_per_base);
    if (!outcome) return outcome;
    axis_.move_node(pulses.net_steps());
    axis_.motor_force_N = axis_.equations.motor_force_N(axis_.z);
    return {};
  }
  void reset() override {}

 private:
  static std::vector<double> tolerances(const AxisEquations& eq, double tolerance_um) {
    const Vector4 tolerance = local_tolerance(eq, tolerance_um);
    return {tolerance.begin(), tolerance.end()};
  }
  static void equations(const void* self, double, const double* y, double* dydt) {
    const Vector4 slope = static_cast<const AxisEquations*>(self)->derivative({y[0], y[1], y[2], y[3]});
    for (std::size_t i = 0; i < 4; ++i) dydt[i] = slope[i];
  }
  Outcome integrate(double ticks) {
    if (ticks == 0) return {};
    // many short intervals share the error that one tick may make
    cvode_.scale_tolerance(ticks);
    Outcome outcome = cvode_.start(0, axis_.z.data());
    if (outcome) outcome = cvode_.advance_and_stop(ticks, axis_.z.data());
    return outcome;
  }

  AxisMotion& axis_;
  Cvode cvode_;
};

}  // namespace

Vector4 local_tolerance(const AxisEquations& eq, double tolerance_um) {
  const double tolerance_m = tolerance_um * 1e-3 * eq.metre_per_unit;
  // an error of speed becomes one of position divided by the slowest frequency [rad per tick]
  double slowest = std::sqrt(eq.p1);
  // (of a motor that bends no frequency is the slowest: its stiffness may vanish)
  if (eq.motor.linear() && eq.a > 0) slowest = std::min(slowest, std::sqrt(eq.a / (1 + eq.p / eq.p1)));
  // and stays for as long as the weakest damping lets it
  const double decay = std::min(eq.q1, eq.B / (1 + eq.p / eq.p1)) / 2;
  const double position_m = tolerance_m * std::min(1.0, std::max(0.01, 10 * decay));
  const double speed_m = position_m * std::min(1.0, slowest);
  return {position_m, speed_m, position_m, speed_m};
}

std::unique_ptr<Integrator> make_reference(AxisMotion& axis, double tolerance_um) {
  return std::make_unique<Reference>(axis, tolerance_um);
}

}  // namespace kadr::plant
