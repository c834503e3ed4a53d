#include "emulator/log/lcm_messages.h"

#include <algorithm>

#include "emulator/log/log_types.h"
#include "machine/base/hash.h"
#include "machine/base/require.h"
#include "machine/machine.h"

namespace kadr::emulator {
namespace {

/// LCM strings end at the first zero byte: those of a damaged text become U+FFFD.
std::string lcm_text(const std::string& text) {
  if (text.find('\0') == std::string::npos) return text;
  std::string clean;
  for (const char c : text) {
    if (c == '\0')
      clean += "\xEF\xBF\xBD";
    else
      clean += c;
  }
  return clean;
}

double seconds(Ticks ticks, const machine::ClockModel& clock) {
  return static_cast<double>(ticks.value) / static_cast<double>(clock.base_hz);
}

std::int32_t small(std::size_t n) { return static_cast<std::int32_t>(n); }

}  // namespace

std::int64_t fingerprint(MessageKind kind) {
  switch (kind) {
    case MessageKind::run:
      return run_t::getHash();
    case MessageKind::block:
      return block_t::getHash();
    case MessageKind::block_end:
      return block_end_t::getHash();
    case MessageKind::ticks:
      return ticks_t::getHash();
    case MessageKind::steps:
      return steps_t::getHash();
    case MessageKind::feed:
      return feed_t::getHash();
    case MessageKind::axis:
      return axis_t::getHash();
    case MessageKind::event:
      return event_t::getHash();
    case MessageKind::diag:
      return diag_t::getHash();
    case MessageKind::summary:
      return summary_t::getHash();
    case MessageKind::unknown:
      break;
  }
  return 0;
}

run_t run_message(const RunHeader& header) {
  const machine::MachineModel& machine = *header.machine;
  run_t m{};
  m.log_format = kLogFormat;
  m.kadr_version = KADR_VERSION;
  m.base_hz = machine.clock.base_hz;
  m.control_tick_ticks = static_cast<std::int32_t>(machine.clock.control_tick.value);
  m.program_name = lcm_text(header.program_name);
  if (header.program_text.size() <= kEmbeddedTextLimit) m.program_text = lcm_text(header.program_text);
  m.program_bytes = static_cast<std::int64_t>(header.program_text.size());
  Hash64 hash;
  hash.bytes(header.program_text.data(), header.program_text.size());
  m.program_hash = static_cast<std::int64_t>(hash.digest());
  m.machine_toml = lcm_text(header.machine_toml);
  m.scenario_toml = lcm_text(header.scenario_toml);
  m.settings_toml = lcm_text(header.settings_toml);
  m.inputs_hash = static_cast<std::int64_t>(header.inputs_hash);
  m.machine_name = lcm_text(machine.name);
  m.logs_ticks = machine.log.ticks;
  m.logs_steps = machine.log.steps;
  m.block_ticks = machine.log.block_ticks;
  m.viewer_every_ticks = viewer_every_ticks(machine);
  m.n_axes = small(machine.axis.size());
  for (const machine::AxisModel& axis : machine.axis) {
    m.axis_names.emplace_back(1, axis.letter);
    m.axis_units.emplace_back(axis.kind == machine::AxisKind::rotary ? "deg" : "mm");
    m.step_u.push_back(axis.step_u);
    m.home_u.push_back(axis.home_u);
    m.has_plant.push_back(axis.has_plant);
  }
  return m;
}

block_t block_message(const BlockRecord& r, const machine::ClockModel& clock) {
  block_t m{};
  m.tick = r.tick.value;
  m.t_s = seconds(r.tick, clock);
  m.block = static_cast<std::int32_t>(r.block);
  m.source_line = static_cast<std::int32_t>(r.span.line);
  m.source_column = static_cast<std::int32_t>(r.span.column);
  m.source_text = lcm_text(r.text);
  m.motion = lcm_text(r.motion);
  m.length_u = r.length_u;
  m.programmed_u_s = r.programmed_u_s;
  m.planned_peak_u_s = r.planned_peak_u_s;
  m.planned_end_u_s = r.planned_end_u_s;
  m.planned_s = r.planned_s;
  m.limited_by = lcm_text(r.limited_by);
  m.entry_u_s = r.entry_u_s;
  m.planned_entry_u_s = r.planned_entry_u_s;
  m.deferred_ticks = static_cast<std::int32_t>(r.deferred_ticks.value);
  return m;
}

block_end_t block_end_message(const BlockEndRecord& r, const machine::ClockModel& clock) {
  require(r.peak_link_u.size() == r.peak_following_u.size(), "a block's end has every axis in both arrays");
  block_end_t m{};
  m.tick = r.tick.value;
  m.t_s = seconds(r.tick, clock);
  m.block = static_cast<std::int32_t>(r.block);
  m.source_line = static_cast<std::int32_t>(r.line);
  m.n_axes = small(r.peak_link_u.size());
  m.peak_link_u = r.peak_link_u;
  m.peak_following_u = r.peak_following_u;
  require(r.positive_J.size() == r.recuperated_J.size(), "a block's energies have the same axes");
  m.n_energy_axes = small(r.positive_J.size());
  m.positive_J = r.positive_J;
  m.recuperated_J = r.recuperated_J;
  return m;
}

event_t event_message(const EventRecord& r, const machine::ClockModel& clock) {
  event_t m{};
  m.tick = r.tick.value;
  m.t_s = seconds(r.tick, clock);
  m.block = static_cast<std::int32_t>(r.block);
  m.source_line = static_cast<std::int32_t>(r.span.line);
  m.source_column = static_cast<std::int32_t>(r.span.column);
  m.kind = lcm_text(r.kind.text());
  if (r.code != Code{}) m.code = code_name(r.code);
  m.axis = r.axis;
  m.value = r.value;
  m.limit = r.limit;
  m.text = lcm_text(r.text);
  return m;
}

diag_t diag_message(const Diagnostic& d, Ticks tick) {
  diag_t m{};
  m.tick = tick.value;
  m.severity = static_cast<std::int8_t>(static_cast<int>(d.severity) + 1);
  m.code = code_name(d.code);
  m.source_line = static_cast<std::int32_t>(d.span.line);
  m.source_column = static_cast<std::int32_t>(d.span.column);
  m.source_length = static_cast<std::int32_t>(d.span.length);
  m.text = lcm_text(d.message);
  m.label = lcm_text(d.label);
  m.n_notes = small(d.notes.size());
  for (const std::string& note : d.notes) m.notes.push_back(lcm_text(note));
  m.help = lcm_text(d.help);
  return m;
}

summary_t summary_message(const RunSummary& s, const machine::ClockModel& clock, std::uint64_t content_hash) {
  summary_t m{};
  m.tick = s.ticks.value;
  m.t_s = seconds(s.ticks, clock);
  m.outcome = lcm_text(s.outcome.text());
  m.control_ticks = s.control_ticks.value;
  m.blocks = static_cast<std::int32_t>(s.blocks);
  m.path_u = s.path_u;
  m.mean_feed_u_s = s.mean_feed_u_s;
  m.peak_feed_u_s = s.peak_feed_u_s;
  m.motion_s = s.motion_s;
  m.dwell_s = s.dwell_s;
  m.pulses = s.pulses;
  m.steps_hash = static_cast<std::int64_t>(s.steps_hash);
  m.content_hash = static_cast<std::int64_t>(content_hash);
  m.path_error_u = s.path_error_u;
  m.held_error_u = s.held_error_u;
  m.n_axes = small(s.axis.size());
  for (const AxisSummary& a : s.axis) {
    m.axis_pulses.push_back(a.pulses);
    m.net_steps.push_back(a.net_steps.value);
    m.end_steps.push_back(a.end_steps.value);
    m.end_u.push_back(a.end_u);
    m.min_u.push_back(a.min_u);
    m.max_u.push_back(a.max_u);
    m.peak_axis_feed_u_s.push_back(a.peak_feed_u_s);
    m.peak_axis_feed_tick.push_back(a.peak_feed_tick.value);
    m.peak_accel_u_s2.push_back(a.peak_accel_u_s2);
    m.peak_jerk_u_s3.push_back(a.peak_jerk_u_s3);
    m.peak_vibration_u.push_back(a.peak_vibration_u);
    m.peak_vibration_tick.push_back(a.peak_vibration_tick.value);
    m.peak_vibration_line.push_back(static_cast<std::int32_t>(a.peak_vibration_line));
    m.rms_vibration_u.push_back(a.rms_vibration_u);
    m.residual_u.push_back(a.residual_u);
    m.peak_following_u.push_back(a.peak_following_u);
    m.rms_following_u.push_back(a.rms_following_u);
    m.lost_steps.push_back(a.lost_steps.value);
    m.positive_J.push_back(a.positive_J);
    m.recuperated_J.push_back(a.recuperated_J);
  }
  m.n_limits = small(s.limited_by.size());
  for (const LimitShare& share : s.limited_by) {
    m.limited_by.push_back(lcm_text(share.limited_by));
    m.limited_s.push_back(share.time_s);
  }
  m.planned_s = s.planned_s;
  m.n_losses = small(s.lost_by.size());
  for (const LimitShare& share : s.lost_by) {
    m.lost_by.push_back(lcm_text(share.limited_by));
    m.lost_s.push_back(share.time_s);
  }
  m.n_alarms = static_cast<std::int64_t>(s.alarms);
  m.n_warnings = static_cast<std::int64_t>(s.warnings);
  m.exit_code = s.exit_code;
  return m;
}

BlockBuilder::BlockBuilder(const machine::MachineModel& machine)
    : machine_(machine), pulses_(machine.axis.size()), node_(machine.axis.size()) {
  require(machine.log.block_ticks >= 1 && machine.log.block_ticks <= kMaxBlockTicks,
          "log.block_ticks is between 1 and 64");
  require(machine.clock.control_tick.value >= 1 && machine.clock.control_tick.value <= 65536,
          "offsets within a control tick fit 16 bits");
  const auto n = static_cast<std::size_t>(machine.log.block_ticks);
  const std::size_t axes = machine.axis.size();
  for (auto* column : {&ticks_.feed_u_s, &ticks_.accel_u_s2, &ticks_.path_u, &ticks_.override_requested,
                       &ticks_.override_used, &ticks_.limiter})
    column->resize(n);
  ticks_.override_note.resize(n);
  ticks_.limited_by.resize(n);
  ticks_.limiting_axis.resize(n);
  ticks_.block.resize(n);
  ticks_.n_axes = small(axes);
  ticks_.steps_base.resize(axes);
  ticks_.steps.assign(axes, std::vector<std::int32_t>(n));
  for (auto* table : {&ticks_.command_u, &ticks_.base_u, &ticks_.base_u_s, &ticks_.link_u, &ticks_.link_u_s,
                      &ticks_.motor_force})
    table->assign(axes, std::vector<double>(n));
  steps_.n_axes = small(axes);
  steps_.pulses.resize(axes);
  steps_.reversals.resize(axes);
  steps_.bytes.resize(axes);
}

bool BlockBuilder::breaks(const TickRecord& record) const {
  if (empty()) return false;
  return record.tick.value != ticks_.first_control_tick + ticks_.n ||
         (record.axis != nullptr) != (ticks_.n_plant_axes > 0) || record.has_override != has_override_;
}

void BlockBuilder::begin_block(const TickRecord& record) {
  ticks_.first_control_tick = record.tick.value;
  ticks_.tick = record.tick.value * machine_.clock.control_tick.value;
  ticks_.n_plant_axes = record.axis ? ticks_.n_axes : 0;
  has_override_ = record.has_override;
  for (std::size_t a = 0; a < node_.size(); ++a)
    ticks_.steps_base[a] = (*record.position_steps)[a] + lattice_offset_[a];
  for (PulseEncoder& encoder : pulses_) encoder.begin_block();
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
  const auto i = static_cast<std::size_t>(ticks_.n++);
  ticks_.n_override = has_override_ ? ticks_.n : 0;
  const TickMotion& motion = *record.motion;
  ticks_.feed_u_s[i] = motion.speed_end_u_s;
  ticks_.accel_u_s2[i] = motion.accel_end_u_s2;
  ticks_.path_u[i] = motion.s_end_u;
  ticks_.override_requested[i] = motion.override_requested;
  ticks_.override_used[i] = motion.override_used;
  ticks_.limiter[i] = motion.limiter;
  ticks_.override_note[i] = static_cast<std::int8_t>(motion.note);
  ticks_.limited_by[i] = static_cast<std::int8_t>(motion.limited_by);
  ticks_.limiting_axis[i] = motion.limiting_axis;
  ticks_.block[i] = static_cast<std::int32_t>(record.block);
  jerk_u_s3_ = (motion.accel_end_u_s2 - accel_u_s2_) / machine_.clock.tau_s();
  accel_u_s2_ = motion.accel_end_u_s2;

  const auto begin_ticks =
      static_cast<std::int32_t>(static_cast<std::int64_t>(i) * machine_.clock.control_tick.value);
  for (std::size_t a = 0; a < node_.size(); ++a) {
    node_[a] = (*record.position_steps)[a] + lattice_offset_[a];
    ticks_.steps[a][i] = static_cast<std::int32_t>(node_[a] - ticks_.steps_base[a]);
    ticks_.command_u[a][i] = batch.axis[a].command.position_end_u;
    if (record.axis) {
      const AxisState& state = (*record.axis)[a];
      ticks_.base_u[a][i] = state.base_u;
      ticks_.base_u_s[a][i] = state.base_u_s;
      ticks_.link_u[a][i] = state.link_u;
      ticks_.link_u_s[a][i] = state.link_u_s;
      ticks_.motor_force[a][i] = state.motor_force_N;
    }
    if (machine_.log.steps) pulses_[a].add(batch.axis[a], begin_ticks);
  }
}

const steps_t& BlockBuilder::steps_message() {
  steps_.tick = ticks_.tick;
  steps_.first_control_tick = ticks_.first_control_tick;
  steps_.n_ticks = ticks_.n;
  steps_.code.clear();
  for (std::size_t a = 0; a < pulses_.size(); ++a) {
    steps_.pulses[a] = pulses_[a].pulses();
    steps_.reversals[a] = pulses_[a].reversals();
    steps_.bytes[a] = pulses_[a].finish_block(steps_.code);
  }
  steps_.n_bytes = small(steps_.code.size());
  return steps_;
}

Ticks BlockBuilder::tick_end(ControlTicks tick) const {
  return Ticks{(tick.value + 1) * machine_.clock.control_tick.value};
}

Ticks BlockBuilder::end() const { return tick_end({ticks_.first_control_tick + ticks_.n - 1}); }

double BlockBuilder::seconds(Ticks ticks) const { return emulator::seconds(ticks, machine_.clock); }

feed_t BlockBuilder::feed_message(const TickRecord& record) const {
  const TickMotion& motion = *record.motion;
  feed_t m{};
  m.tick = tick_end(record.tick).value;
  m.t_s = seconds(tick_end(record.tick));
  m.block = static_cast<std::int32_t>(record.block);
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

axis_t BlockBuilder::axis_message(const TickRecord& record, const StepBatch& batch, std::size_t a) const {
  const AxisCommand& command = batch.axis[a].command;
  axis_t m{};
  m.tick = tick_end(record.tick).value;
  m.t_s = seconds(tick_end(record.tick));
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
  constexpr double kMicro = 1000;  // um in a mm, millidegrees in a degree
  m.load_minus_ideal_um = kMicro * (m.load - m.ideal);
  return m;
}

}  // namespace kadr::emulator
