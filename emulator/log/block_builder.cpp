#include "emulator/log/block_builder.h"

#include "machine/base/require.h"

namespace kadr::log {

BlockBuilder::BlockBuilder(const machine::MachineModel& machine)
    : machine_(machine), pulses_(machine.axis.size()), node_(machine.axis.size()) {
  require(machine.log.block_ticks >= 1 && machine.log.block_ticks <= kMaxBlockTicks,
          "log.block_ticks is between 1 and 64");
  require(machine.clock.control_tick.value >= 1 && machine.clock.control_tick.value <= 65536,
          "offsets within a control tick fit 16 bits");
  const std::size_t axes = machine.axis.size();
  pulse_block_.pulses.resize(axes);
  pulse_block_.reversals.resize(axes);
  pulse_block_.bytes.resize(axes);
}

bool BlockBuilder::breaks(const TickRecord& record) const {
  if (empty()) return false;
  return record.tick.value != first_.value + ticks_ || (record.axis != nullptr) != has_plant_ ||
         record.has_override != has_override_;
}

void BlockBuilder::begin_block(const TickRecord& record) {
  first_ = record.tick;
  has_plant_ = record.axis != nullptr;
  has_override_ = record.has_override;
  const Ticks begin{first_.value * machine_.clock.control_tick.value};
  for_each_channel(TickChannels{}, [&]<class R>() {
    std::get<R>(blocks_).begin = begin;
    std::get<R>(blocks_).first = first_;
  });
  pulse_block_.begin = begin;
  pulse_block_.first = first_;
  for (PulseEncoder& encoder : pulses_) encoder.begin_block();
}

void BlockBuilder::clear() {
  ticks_ = 0;
  for_each_channel(TickChannels{}, [&]<class R>() {
    for (const Field<R>& field : Channel<R>::fields)
      if (field.clear != nullptr) field.clear(std::get<R>(blocks_));
  });
}

/// position_steps may count from anywhere; in the log a step count is the lattice node from machine zero.
void BlockBuilder::begin_lattice(const TickRecord& record, const StepBatch& batch) {
  for (std::size_t a = 0; a < node_.size(); ++a) {
    const std::int64_t before = (*record.position_steps)[a] - batch.axis[a].net_steps().value;
    const double start_u = batch.axis[a].command.position_begin_u;
    lattice_offset_.push_back(lattice_node(start_u, machine_.axis[a].step_u) - before);
  }
}

void BlockBuilder::add(const TickRecord& record, const StepBatch& batch) {
  require(record.motion && record.position_steps, "a tick record has motion and positions");
  require(batch.tick == record.tick, "batch and record are of one control tick");
  require(batch.axis.size() == node_.size() && record.position_steps->size() == node_.size() &&
              (!record.axis || record.axis->size() == node_.size()),
          "a tick record has the machine's axes");
  if (lattice_offset_.empty()) begin_lattice(record, batch);
  if (empty()) begin_block(record);
  const auto begin_ticks = static_cast<std::int32_t>(ticks_ * machine_.clock.control_tick.value);
  ++ticks_;
  for (std::size_t a = 0; a < node_.size(); ++a) {
    node_[a] = (*record.position_steps)[a] + lattice_offset_[a];
    if (machine_.log.steps) pulses_[a].add(batch.axis[a], begin_ticks);
  }
  const TickSource source{record, batch, node_};
  for_each_channel(TickChannels{}, [&]<class R>() { append_tick(std::get<R>(blocks_), source); });
  jerk_u_s3_ = (record.motion->accel_end_u_s2 - accel_u_s2_) / machine_.clock.tau_s();
  accel_u_s2_ = record.motion->accel_end_u_s2;
}

const PulseBlock& BlockBuilder::pulse_block() {
  pulse_block_.ticks = ticks_;
  pulse_block_.code.clear();
  for (std::size_t a = 0; a < pulses_.size(); ++a) {
    pulse_block_.pulses[a] = pulses_[a].pulses();
    pulse_block_.reversals[a] = pulses_[a].reversals();
    pulse_block_.bytes[a] = pulses_[a].finish_block(pulse_block_.code);
  }
  return pulse_block_;
}

Ticks BlockBuilder::tick_end(ControlTicks tick) const {
  return Ticks{(tick.value + 1) * machine_.clock.control_tick.value};
}

Ticks BlockBuilder::end() const { return tick_end({first_.value + ticks_ - 1}); }

double BlockBuilder::seconds(Ticks ticks) const {
  return static_cast<double>(ticks.value) / static_cast<double>(machine_.clock.base_hz);
}

FeedSample BlockBuilder::feed_sample(const TickRecord& record) const {
  const TickMotion& motion = *record.motion;
  FeedSample m;
  m.tick = tick_end(record.tick);
  m.t_s = seconds(m.tick);
  m.block = record.block;
  m.path_u = motion.s_end_u;
  m.commanded_u_s = motion.speed_end_u_s;
  m.acceleration_u_s2 = motion.accel_end_u_s2;
  m.jerk_u_s3 = jerk_u_s3_;
  constexpr double kPercent = 100;
  m.override_used_pct = kPercent * motion.override_used;
  const double before = motion.speed_begin_u_s, after = motion.speed_end_u_s;
  m.phase = before == 0 && after == 0 ? 0 : after > before ? 1 : after < before ? 3 : 2;
  m.limited_by = static_cast<std::int8_t>(motion.limited_by);
  return m;
}

AxisSample BlockBuilder::axis_sample(const TickRecord& record, const StepBatch& batch, std::size_t a) const {
  const AxisCommand& command = batch.axis[a].command;
  AxisSample m;
  m.axis = static_cast<int>(a);
  m.tick = tick_end(record.tick);
  m.t_s = seconds(m.tick);
  m.steps = node_[a];
  m.ideal = command.position_end_u;
  m.commanded = static_cast<double>(node_[a]) * machine_.axis[a].step_u;
  m.motor = command.position_end_u;
  m.load = command.position_end_u;
  m.load_rate = command.speed_end_u_s;
  if (record.axis) {
    const AxisState& state = (*record.axis)[a];
    m.motor = state.base_u;
    m.load = state.base_u + state.link_u;
    m.load_rate = state.base_u_s + state.link_u_s;
    m.motor_force_N = state.motor_force_N;
  }
  constexpr double kMicro = 1000;  // um per mm, millidegrees per degree
  m.load_minus_ideal_um = kMicro * (m.load - m.ideal);
  return m;
}

}  // namespace kadr::log
