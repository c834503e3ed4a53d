#include "emulator/cycle/monitor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "machine/base/codes.h"
#include "machine/machine.h"
#include "planner/path/path.h"

namespace kadr::emulator {
namespace {

const char* unit(const machine::AxisModel& axis) {
  return axis.kind == machine::AxisKind::rotary ? "deg" : "mm";
}

/// Rounding of second differences over tau, relative to the limit watched.
constexpr double kRelativeSlack = 1e-6;
/// A motor that has kept up for so long is no longer slipping.
constexpr double kSlipPause_s = 0.1;

/// Radians or metres of the plant's equations do not matter here: omega and zeta are ratios.
void set_link(const machine::AxisModel& axis, double& omega_rad_s, double& damped_rad_s, double& zeta) {
  if (!axis.has_plant) return;
  const machine::TwoMassModel& m = axis.plant;
  omega_rad_s = std::sqrt(m.link_stiffness_N_per_m / m.link_mass_kg);
  zeta = m.link_damping_Ns_per_m / (2 * std::sqrt(m.link_stiffness_N_per_m * m.link_mass_kg));
  damped_rad_s = zeta < 1 ? omega_rad_s * std::sqrt(1 - zeta * zeta) : 0.0;
}

}  // namespace

Monitor::Monitor(const planner::Path& path, const machine::MachineModel& machine)
    : path_(path),
      machine_(machine),
      tau_s_(machine.clock.tau_s()),
      axes_(machine.axis.size()),
      tangent_(machine.axis.size()) {
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    Axis& axis = axes_[a];
    set_link(machine.axis[a], axis.omega_rad_s, axis.damped_rad_s, axis.zeta);
    axis.position_u = path.size() > 0 ? path.node(0)[a] : machine.axis[a].home_u;
    axis.summary.min_u = axis.summary.max_u = axis.summary.end_u = axis.position_u;
  }
}

void Monitor::tick(const TickView& view, std::vector<EventRecord>& events,
                   std::vector<BlockEndRecord>& block_ends) {
  const Ticks end{(view.motion->tick.value + 1) * machine_.clock.control_tick.value};
  if (path_.size() > 0) {
    const std::uint32_t block = path_.segments[view.segment].block;
    if (block_open_ && block != block_) end_block(end, block_ends);
    block_ = block;
    block_open_ = true;
    segment_ = view.segment;
  }
  // the speeds at the ends of this tick belong to different segments: a corner may lie between them
  joint_ticks_ago_ = view.segment != speed_segment_ ? 0 : std::min(joint_ticks_ago_ + 1, 1000);
  speed_segment_ = view.segment;
  if (path_.size() > 0 && view.motion->speed_end_u_s > 0)
    planner::eval_tangent(path_, view.segment,
                          std::clamp(view.motion->s_end_u - path_.start_s_u[view.segment], 0.0,
                                     path_.segments[view.segment].length_u),
                          tangent_);
  else
    std::fill(tangent_.begin(), tangent_.end(), 0.0);

  energy_ = view.energy;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    watch_axis(a, view, events);
    if (view.plant) watch_plant(a, view);
    if (view.energy) {
      const plant::EnergyBalance e = view.energy->energy(static_cast<int>(a));
      axes_[a].summary.positive_J = e.positive_work_J;
      axes_[a].summary.recuperated_J = e.positive_work_J - e.motor_work_J;
    }
  }
  if (view.plant) watch_path_error(view);
  if (path_.size() > 0) {
    const planner::PathSegment& s = path_.segments[view.segment];
    peak_feed_u_s_ = std::max(peak_feed_u_s_, view.motion->speed_end_u_s * s.feed_length_u / s.length_u);
  }
  held_error_u_ = std::max(held_error_u_, view.motion->held_error_u);
  watch_stop(view, events);
  ++ticks_;
}

void Monitor::watch_axis(std::size_t a, const TickView& view, std::vector<EventRecord>& events) {
  Axis& axis = axes_[a];
  const machine::AxisModel& model = machine_.axis[a];
  const AxisPulses& pulses = view.batch->axis[a];
  const Ticks end{(view.motion->tick.value + 1) * machine_.clock.control_tick.value};

  axis.summary.pulses += static_cast<std::int64_t>(pulses.count());
  axis.summary.net_steps += pulses.net_steps();
  const double position_u = pulses.command.position_end_u;
  const double speed_u_s = tangent_[a] * view.motion->speed_end_u_s;
  const double accel_u_s2 = (speed_u_s - axis.speed_u_s) / tau_s_;
  const double jerk_u_s3 = (accel_u_s2 - axis.accel_u_s2) / tau_s_;
  if (position_u == axis.position_u && speed_u_s == 0 && accel_u_s2 == 0 && jerk_u_s3 == 0) return;

  axis.summary.min_u = std::min(axis.summary.min_u, position_u);
  axis.summary.max_u = std::max(axis.summary.max_u, position_u);
  if (std::fabs(speed_u_s) > axis.summary.peak_feed_u_s) {
    axis.summary.peak_feed_u_s = std::fabs(speed_u_s);
    axis.summary.peak_feed_tick = end;
  }
  // the junction step is a corner's own; it is not the axis's acceleration
  if (joint_ticks_ago_ > 0)
    axis.summary.peak_accel_u_s2 = std::max(axis.summary.peak_accel_u_s2, std::fabs(accel_u_s2));
  if (joint_ticks_ago_ > 1)
    axis.summary.peak_jerk_u_s3 = std::max(axis.summary.peak_jerk_u_s3, std::fabs(jerk_u_s3));

  watch_limit(a, soft_limit, position_u, position_u > model.soft_max_u ? model.soft_max_u : model.soft_min_u,
              end, events);
  watch_limit(a, speed, std::fabs(speed_u_s), model.max_feed_u_s, end, events);
  const double step_u_s2 = std::min(model.junction_accel_u_s2, model.junction_jerk_u_s3 * tau_s_);
  watch_limit(a, acceleration, std::fabs(accel_u_s2),
              model.max_accel_u_s2 + (joint_ticks_ago_ == 0 ? step_u_s2 : 0.0), end, events);
  if (model.max_jerk_u_s3 < machine::kInfinity)
    watch_limit(a, jerk, std::fabs(jerk_u_s3),
                model.max_jerk_u_s3 + (joint_ticks_ago_ <= 1 ? 2 * step_u_s2 / tau_s_ : 0.0), end, events);

  axis.position_u = position_u;
  axis.speed_u_s = speed_u_s;
  axis.accel_u_s2 = accel_u_s2;
}

const Code Monitor::kOverrunCodes[kOverruns] = {Code::soft_limit_overrun, Code::speed_overrun,
                                                Code::acceleration_overrun, Code::jerk_overrun};

void Monitor::watch_limit(std::size_t a, Overrun kind, double value, double limit, Ticks tick,
                          std::vector<EventRecord>& events) {
  static constexpr const char* kNames[kOverruns] = {"position", "speed", "acceleration", "jerk"};
  static constexpr const char* kPer[kOverruns] = {"", "/s", "/s2", "/s3"};
  const machine::AxisModel& model = machine_.axis[a];
  const bool over = kind == soft_limit
                        ? value > model.soft_max_u + kSamePoint_u || value < model.soft_min_u - kSamePoint_u
                        : value > limit * (1 + kRelativeSlack);
  Excursion& excursion = axes_[a].excursion[kind];
  const auto sentence = [&](const char* verb, double v, double l) {
    return fmt::format("axis {} {} {} {:.6g} {}{}, allowed {:.6g}", model.letter, kNames[kind], verb, v,
                       unit(model), kPer[kind], l);
  };
  if (over && !excursion.open) {
    excursion = {true, value, limit};
    ++alarms_;
    EventRecord e = event_here(tick, EventKind::alarm, a, value, limit);
    e.code = kOverrunCodes[kind];
    e.text = sentence("is", value, limit);
    events.push_back(std::move(e));
  } else if (over) {
    const bool worse = std::fabs(value - limit) > std::fabs(excursion.worst - excursion.limit);
    if (worse) excursion.worst = value, excursion.limit = limit;
  } else if (excursion.open) {
    excursion.open = false;
    EventRecord e = event_here(tick, EventKind::alarm_end, a, excursion.worst, excursion.limit);
    e.code = kOverrunCodes[kind];
    e.text = sentence("was at most", excursion.worst, excursion.limit);
    events.push_back(std::move(e));
  }
}

void Monitor::watch_plant(std::size_t a, const TickView& view) {
  Axis& axis = axes_[a];
  const plant::AxisState& state = (*view.plant)[a];
  const double link_u = std::fabs(state.link_u);
  const double following_u =
      std::fabs(state.base_u + state.link_u - view.batch->axis[a].command.position_end_u);
  axis.vibration_squares_u2 += link_u * link_u;
  axis.following_squares_u2 += following_u * following_u;
  axis.summary.peak_following_u = std::max(axis.summary.peak_following_u, following_u);
  axis.block_link_u = std::max(axis.block_link_u, link_u);
  axis.block_following_u = std::max(axis.block_following_u, following_u);
  if (link_u > axis.summary.peak_vibration_u) {
    axis.summary.peak_vibration_u = link_u;
    axis.summary.peak_vibration_tick =
        Ticks{(view.motion->tick.value + 1) * machine_.clock.control_tick.value};
    axis.summary.peak_vibration_line = path_.size() > 0 ? path_.segments[view.segment].span.line : 0;
  }
}

void Monitor::watch_path_error(const TickView& view) {
  // the part of the tool's error that is across the path: the part along it is delay, not a wrong contour
  double error_u2 = 0, along_u = 0, tangent2 = 0;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    if (axis_index(machine_.axis[a].letter) > 2) continue;
    const plant::AxisState& state = (*view.plant)[a];
    const double e = state.base_u + state.link_u - view.batch->axis[a].command.position_end_u;
    error_u2 += e * e;
    along_u += e * tangent_[a];
    tangent2 += tangent_[a] * tangent_[a];
  }
  if (tangent2 > 0) error_u2 = std::max(0.0, error_u2 - along_u * along_u / tangent2);
  path_error_u_ = std::max(path_error_u_, std::sqrt(error_u2));
}

void Monitor::watch_stop(const TickView& view, std::vector<EventRecord>& events) {
  const bool moved = view.motion->s_end_u > view.motion->s_begin_u;
  const bool at_rest = view.motion->speed_end_u_s == 0;
  const Ticks begin{view.motion->tick.value * machine_.clock.control_tick.value};
  if (moved && stopped_) end_stop(begin, events);
  if (moved)
    for (std::size_t a = 0; a < axes_.size(); ++a)
      if (view.batch->axis[a].command.position_begin_u != view.batch->axis[a].command.position_end_u)
        axes_[a].moved_since_stop = true;
  moving_ = moving_ || moved;
  if (!view.plant) return;
  if (at_rest && moving_) {
    moving_ = false;
    stopped_ = true;
    stop_segment_ = segment_;
    for (std::size_t a = 0; a < axes_.size(); ++a) {
      Axis& axis = axes_[a];
      const plant::AxisState& s = (*view.plant)[a];
      const double velocity_part_u =
          axis.damped_rad_s > 0 ? (s.link_u_s + axis.zeta * axis.omega_rad_s * s.link_u) / axis.damped_rad_s
                                : 0.0;
      axis.stop_residual_u = std::sqrt(s.link_u * s.link_u + velocity_part_u * velocity_part_u);
    }
  } else if (stopped_ && !moved) {
    for (std::size_t a = 0; a < axes_.size(); ++a)
      axes_[a].stop_residual_u = std::max(axes_[a].stop_residual_u, std::fabs((*view.plant)[a].link_u));
  }
}

void Monitor::end_stop(Ticks now, std::vector<EventRecord>& events) {
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    Axis& axis = axes_[a];
    if (axis.moved_since_stop && axis.omega_rad_s > 0) {
      EventRecord e = event_here(now, EventKind::residual, a, axis.stop_residual_u, 0.0);
      e.block = path_.segments[stop_segment_].block;
      e.span = path_.segments[stop_segment_].span;
      const machine::AxisModel& model = machine_.axis[a];
      const bool rotary = model.kind == machine::AxisKind::rotary;
      e.text = fmt::format("residual vibration of axis {} after the stop {:.3f} {}", model.letter,
                           axis.stop_residual_u * 1000, rotary ? "mdeg" : "um");
      events.push_back(std::move(e));
      axis.summary.residual_u = std::max(axis.summary.residual_u, axis.stop_residual_u);
    }
    axis.moved_since_stop = false;
  }
  stopped_ = false;
}

void Monitor::lost_steps(const std::vector<plant::LostSteps>& lost, Ticks tick,
                         std::vector<EventRecord>& events) {
  for (Axis& axis : axes_)
    if (axis.slip_ticks_ago >= 0) ++axis.slip_ticks_ago;
  for (const plant::LostSteps& l : lost) {
    const auto a = static_cast<std::size_t>(l.axis);
    Axis& axis = axes_[a];
    axis.summary.lost_steps += l.steps;
    axis.slip_steps += l.steps;
    if (axis.slip_ticks_ago < 0) {
      ++alarms_;
      EventRecord e = event_here(tick, EventKind::alarm, a, static_cast<double>(l.steps.value), 0.0);
      e.code = Code::lost_steps;
      e.text = fmt::format("axis {} lost {} steps", machine_.axis[a].letter, l.steps.value);
      events.push_back(std::move(e));
    }
    axis.slip_ticks_ago = 0;
  }
  end_slips(static_cast<std::int64_t>(kSlipPause_s / tau_s_), tick, events);
}

void Monitor::end_slips(std::int64_t after_ticks, Ticks now, std::vector<EventRecord>& events) {
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    Axis& axis = axes_[a];
    if (axis.slip_ticks_ago < after_ticks || axis.slip_ticks_ago < 0) continue;
    EventRecord e = event_here(now, EventKind::alarm_end, a, static_cast<double>(axis.slip_steps.value), 0.0);
    e.code = Code::lost_steps;
    e.text = fmt::format("axis {} lost {} steps in all", machine_.axis[a].letter, axis.slip_steps.value);
    events.push_back(std::move(e));
    axis.slip_steps = Steps{};
    axis.slip_ticks_ago = -1;
  }
}

void Monitor::end_block(Ticks tick, std::vector<BlockEndRecord>& block_ends) {
  BlockEndRecord record{tick, block_, path_.segments[segment_].span.line, {}, {}, {}, {}};
  for (Axis& axis : axes_) {
    record.peak_link_u.push_back(axis.block_link_u);
    record.peak_following_u.push_back(axis.block_following_u);
    axis.block_link_u = axis.block_following_u = 0;
    if (!energy_) continue;
    record.positive_J.push_back(axis.summary.positive_J - axis.block_positive_J);
    record.recuperated_J.push_back(axis.summary.recuperated_J - axis.block_recuperated_J);
    axis.block_positive_J = axis.summary.positive_J;
    axis.block_recuperated_J = axis.summary.recuperated_J;
  }
  block_ends.push_back(std::move(record));
}

EventRecord Monitor::event_here(Ticks tick, EventKind kind, std::size_t axis, double value,
                                double limit) const {
  EventRecord e;
  e.tick = tick;
  if (path_.size() > 0) {
    e.block = path_.segments[segment_].block;
    e.span = path_.segments[segment_].span;
  }
  e.kind = kind;
  e.axis = static_cast<int>(axis);
  e.value = value;
  e.limit = limit;
  return e;
}

void Monitor::finish(Ticks end, std::vector<EventRecord>& events, std::vector<BlockEndRecord>& block_ends) {
  for (std::size_t a = 0; a < axes_.size(); ++a)
    for (int kind = 0; kind < kOverruns; ++kind)
      if (axes_[a].excursion[kind].open) {
        const Excursion excursion = axes_[a].excursion[kind];
        EventRecord e = event_here(end, EventKind::alarm_end, a, excursion.worst, excursion.limit);
        e.code = kOverrunCodes[kind];
        e.text = fmt::format("axis {} was still over its limit at the end, at most {:.6g}, allowed {:.6g}",
                             machine_.axis[a].letter, excursion.worst, excursion.limit);
        events.push_back(std::move(e));
      }
  end_slips(0, end, events);
  if (stopped_) end_stop(end, events);
  if (block_open_) end_block(end, block_ends);
}

void Monitor::summarize(RunSummary& summary) const {
  summary.axis.clear();
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const Axis& axis = axes_[a];
    AxisSummary s = axis.summary;
    s.end_u = axis.position_u;
    const double n = ticks_ > 0 ? static_cast<double>(ticks_) : 1.0;
    s.rms_vibration_u = std::sqrt(axis.vibration_squares_u2 / n);
    s.rms_following_u = std::sqrt(axis.following_squares_u2 / n);
    summary.pulses += s.pulses;
    summary.axis.push_back(s);
  }
  summary.path_error_u = path_error_u_;
  summary.peak_feed_u_s = peak_feed_u_s_;
  summary.held_error_u = held_error_u_;
  summary.alarms = alarms_;
}

}  // namespace kadr::emulator
