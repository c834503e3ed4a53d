#include "plant/integrator.h"
#include "plant/propagator.h"

namespace kadr::plant {

namespace {

/// The closed form of a linear motor: between pulses z(t) = e^{A t} z(0) in coordinates relative to the
/// current node, and a pulse moves the node under the base. Exact except for rounding.
class Oracle final : public Integrator {
 public:
  explicit Oracle(AxisMotion& axis)
      : axis_(axis),
        control_tick_{static_cast<std::int64_t>(axis.equations.control_ticks)},
        propagator_(axis.equations.system(), control_tick_) {}

  Outcome advance(const StepBatch& batch) override {
    const AxisPulses& pulses = batch.axis[static_cast<std::size_t>(axis_.axis)];
    Ticks now;
    pulses.for_each([&](std::uint16_t offset, int sign) {
      const Ticks at{offset};
      if (at != now) axis_.z = propagator_.apply(at - now, axis_.z);
      now = at;
      axis_.z[kLag] -= sign * axis_.equations.step_m;
    });
    axis_.z = propagator_.apply(control_tick_ - now, axis_.z);
    axis_.move_node(pulses.net_steps());
    axis_.motor_force_N = axis_.equations.motor_force_N(axis_.z);
    return {};
  }
  void reset() override {}

 private:
  AxisMotion& axis_;
  Ticks control_tick_;
  Propagator propagator_;
};

}  // namespace

std::unique_ptr<Integrator> make_oracle(AxisMotion& axis) { return std::make_unique<Oracle>(axis); }

}  // namespace kadr::plant
