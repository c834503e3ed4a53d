#include "plant/plant.h"

#include <cmath>
#include <optional>

#include "machine/base/require.h"
#include "machine/machine.h"
#include "plant/integrator.h"
#include "plant/taylor.h"

namespace kadr::plant {

using machine::IntegratorKind;

namespace {

// offsets index tables, so the batch's promises are checked and not trusted
void check_pulses(const AxisPulses& pulses, Ticks control_tick) {
  const std::vector<std::uint16_t>& offset = pulses.offset_ticks;
  if (offset.empty()) return;
  std::uint16_t descents = 0;  // as wide as the offsets, so that the loop becomes vector code
  for (std::size_t i = 1; i < offset.size(); ++i) {
    descents = static_cast<std::uint16_t>(descents | (offset[i - 1] > offset[i] ? 1 : 0));
  }
  require(descents == 0, "pulse offsets never decrease");
  require(offset.back() < control_tick.value, "pulse offsets lie within the control tick");
}

bool finite(const AxisState& s) {
  return std::isfinite(s.base_u) && std::isfinite(s.base_u_s) && std::isfinite(s.link_u) &&
         std::isfinite(s.link_u_s) && std::isfinite(s.motor_force_N);
}

bool finite(const AxisCommand& c) {
  return std::isfinite(c.position_begin_u) && std::isfinite(c.position_end_u) &&
         std::isfinite(c.speed_begin_u_s) && std::isfinite(c.speed_end_u_s);
}

}  // namespace

struct Plant::Impl {
  Ticks control_tick;
  PlantOptions options;
  std::vector<std::unique_ptr<AxisMotion>> motion;  // [axes], null without plant
  std::vector<std::optional<TaylorAxis>> meter;     // [axes], motors driven by pulses, if energy is requested
  std::vector<std::unique_ptr<Integrator>> integrator;
  std::vector<AxisState> state;
  std::vector<LostSteps> lost;
  std::optional<Fault> unusable;  // known from the parameters
  std::optional<Fault> broken;    // until the next reset

  void make_integrators(const machine::MachineModel& machine);
  Outcome meter_energy(const StepBatch& batch);
  void find_lost_steps(ControlTicks tick);
  Outcome check_input(const AxisPulses& input, std::size_t a) const;
  Outcome finish(const StepBatch& batch);
  Outcome advance(const StepBatch& batch);
};

void Plant::Impl::make_integrators(const machine::MachineModel& machine) {
  const IntegratorKind kind = machine.plant.integrator;
  const double tolerance_um = machine.plant.tolerance_um;
  std::vector<AxisMotion*> smooth;
  for (auto& axis : motion) {
    if (!axis) continue;
    const machine::Motor& motor = axis->equations.motor;
    if (!axis->equations.usable() || !(tolerance_um > 0)) {
      unusable = Fault{"BAD_PARAMETERS", "masses, stiffnesses or the tolerance are not positive", axis->axis};
    } else if (axis->reads() == Reads::command) {
      integrator.push_back(make_rigid(*axis, options.energy));
    } else if (kind == IntegratorKind::reference) {
      integrator.push_back(make_reference(*axis, tolerance_um));
    } else if (kind == IntegratorKind::oracle && !motor.linear()) {
      unusable =
          Fault{"ORACLE_NEEDS_LINEAR_MOTOR", "the closed form exists for linear motors only", axis->axis};
    } else if (kind == IntegratorKind::oracle) {
      integrator.push_back(make_oracle(*axis));
    } else if (motor.linear()) {
      smooth.push_back(axis.get());
    } else {
      integrator.push_back(make_taylor(*axis));
    }
  }
  if (!unusable && !smooth.empty()) integrator.push_back(make_smooth(smooth, tolerance_um));
}

// work and losses come from the series, begun at each tick in the integrator's own state
Outcome Plant::Impl::meter_energy(const StepBatch& batch) {
  for (std::size_t a = 0; a < motion.size(); ++a) {
    if (!meter[a]) continue;
    Vector4 z = motion[a]->z;
    if (auto outcome = meter[a]->advance_tick(z, batch.axis[a], &motion[a]->work); !outcome) return outcome;
  }
  return {};
}

// a lag of more than half a tooth settles on the next one
void Plant::Impl::find_lost_steps(ControlTicks tick) {
  for (auto& axis : motion) {
    if (!axis || axis->equations.pitch_m == 0) continue;
    const double teeth = std::floor(axis->z[kLag] / axis->equations.pitch_m + 0.5);
    if (teeth == 0 || !(std::fabs(teeth) < 1e9)) continue;
    axis->z[kLag] -= teeth * axis->equations.pitch_m;
    const Teeth whole{static_cast<std::int64_t>(teeth)};
    axis->slipped += whole;
    axis->move_node({});
    lost.push_back({axis->axis, tick, Steps{whole.value * axis->equations.pitch_steps.value}});
  }
}

Outcome Plant::Impl::finish(const StepBatch& batch) {
  for (std::size_t a = 0; a < motion.size(); ++a) {
    if (const AxisMotion* axis = motion[a].get()) {
      state[a] = axis_state(axis->equations, axis->z, axis->equilibrium_u);
      state[a].motor_force_N = axis->motor_force_N;
    } else {
      const AxisCommand& command = batch.axis[a].command;
      state[a] = {.base_u = command.position_end_u, .base_u_s = command.speed_end_u_s};
    }
    if (!finite(state[a])) {
      return tl::unexpected(
          Fault{"NOT_FINITE", "the state of the axis is not a finite number", static_cast<int>(a)});
    }
  }
  return {};
}

// whether the description that the axis reads (Reads) can be followed
Outcome Plant::Impl::check_input(const AxisPulses& input, std::size_t a) const {
  check_pulses(input, control_tick);
  const AxisMotion* axis = motion[a].get();
  if (axis && axis->reads() == Reads::pulses) return {};
  if (!finite(input.command))
    return tl::unexpected(Fault{"NOT_FINITE", "the command is not a finite number", static_cast<int>(a)});
  if (axis && std::fabs(input.command.position_begin_u - axis->equilibrium_u) > axis->step_u)
    return tl::unexpected(
        Fault{"COMMAND_JUMP", "a rigid axis can't follow a command that jumps", static_cast<int>(a)});
  return {};
}

Outcome Plant::Impl::advance(const StepBatch& batch) {
  require(batch.axis.size() == motion.size(), "a step batch has the machine's axes");
  for (std::size_t a = 0; a < motion.size(); ++a) {
    if (auto outcome = check_input(batch.axis[a], a); !outcome) return outcome;
  }
  if (auto outcome = meter_energy(batch); !outcome) return outcome;
  for (auto& one : integrator) {
    if (auto outcome = one->advance(batch); !outcome) return outcome;
  }
  find_lost_steps(batch.tick);
  return finish(batch);
}

Plant::Plant(const machine::MachineModel& machine, PlantOptions options) : impl_(std::make_unique<Impl>()) {
  Impl& m = *impl_;
  m.control_tick = machine.clock.control_tick;
  m.options = options;
  const std::size_t axes = machine.axis.size();
  m.motion.resize(axes);
  m.meter.resize(axes);
  m.state.resize(axes);
  m.lost.reserve(axes);
  std::vector<double> home;
  for (std::size_t a = 0; a < axes; ++a) {
    const machine::AxisModel& axis = machine.axis[a];
    home.push_back(axis.home_u);
    if (!axis.has_plant) continue;
    m.motion[a] = std::make_unique<AxisMotion>();
    m.motion[a]->equations = axis_equations(axis, machine.clock);
    m.motion[a]->axis = static_cast<int>(a);
    m.motion[a]->step_u = axis.step_u;
    m.motion[a]->pitch_u = m.motion[a]->equations.motor.tooth_u();
    if (options.energy && m.motion[a]->reads() == Reads::pulses) m.meter[a].emplace(m.motion[a]->equations);
  }
  if (m.control_tick < Ticks{1} || m.control_tick > Ticks{65536} || machine.clock.base_hz < 1) {
    m.unusable = Fault{"BAD_PARAMETERS", "a control tick has 1 to 65536 base ticks", -1};
  } else {
    m.make_integrators(machine);
  }
  reset(home);
}

Plant::Plant(Plant&&) noexcept = default;
Plant::~Plant() = default;

tl::expected<void, PlantError> Plant::advance(const StepBatch& batch) {
  Impl& m = *impl_;
  m.lost.clear();
  if (m.unusable) m.broken = m.unusable;
  if (!m.broken) {
    Outcome outcome = m.advance(batch);
    if (outcome) return {};
    m.broken = std::move(outcome.error());
  }
  return tl::unexpected(PlantError{m.broken->flag, batch.tick, m.broken->axis, m.broken->detail});
}

const std::vector<AxisState>& Plant::state() const { return impl_->state; }

const std::vector<LostSteps>& Plant::lost_steps() const { return impl_->lost; }

EnergyBalance Plant::energy(int axis) const {
  require(impl_->options.energy, "energy is asked for when the plant is made");
  const auto index = static_cast<std::size_t>(axis);
  require(axis >= 0 && index < impl_->motion.size(), "energy of an axis of the machine");
  const AxisMotion* motion = impl_->motion[index].get();
  if (!motion) return {};
  return {motion->work.motor_J, motion->work.positive_J, motion->equations.kinetic_J(motion->z),
          motion->equations.spring_J(motion->z), motion->work.dissipated_J};
}

void Plant::reset(const std::vector<double>& position_u) {
  Impl& m = *impl_;
  require(position_u.size() == m.motion.size(), "a reset has a position for every axis");
  for (std::size_t a = 0; a < m.motion.size(); ++a) {
    m.state[a] = {.base_u = position_u[a]};
    if (AxisMotion* axis = m.motion[a].get()) {
      axis->origin_u = position_u[a];
      axis->z = {};
      axis->node = {};
      axis->slipped = {};
      axis->motor_force_N = 0;
      axis->work = {};
      axis->move_node({});
    }
  }
  m.lost.clear();
  m.broken.reset();
  for (auto& one : m.integrator) one->reset();
}

}  // namespace kadr::plant
