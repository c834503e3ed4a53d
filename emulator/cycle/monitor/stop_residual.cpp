#include "emulator/cycle/monitor/stop_residual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "machine/machine.h"

namespace kadr::cycle {

StopResidual::StopResidual(const machine::MachineModel& machine, EventList& events)
    : machine_(machine), events_(events), axes_(machine.axis.size()) {
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    if (!machine.axis[a].has_plant) continue;
    // omega and zeta are ratios: mm or deg, N or N m do not matter
    const machine::TwoMassModel& m = machine.axis[a].plant;
    Axis& axis = axes_[a];
    axis.omega_rad_s = std::sqrt(m.link_stiffness_N_per_m / m.link_mass_kg);
    axis.zeta = m.link_damping_Ns_per_m / (2 * std::sqrt(m.link_stiffness_N_per_m * m.link_mass_kg));
    axis.damped_rad_s = axis.zeta < 1 ? axis.omega_rad_s * std::sqrt(1 - axis.zeta * axis.zeta) : 0.0;
  }
}

void StopResidual::tick(const TickView& view) {
  if (view.moved()) {
    if (stopped_) report(view.begin);
    for (std::size_t a = 0; a < axes_.size(); ++a) {
      const AxisCommand& command = view.batch.axis[a].command;
      if (command.position_begin_u != command.position_end_u) axes_[a].moved = true;
    }
    moving_ = true;
  }
  if (!view.plant) return;
  if (moving_ && view.motion.speed_end_u_s == 0) {
    moving_ = false;
    stopped_ = true;
    stop_segment_ = view.segment;
    for (std::size_t a = 0; a < axes_.size(); ++a)
      axes_[a].residual_u = envelope_u(axes_[a], (*view.plant)[a]);
  } else if (stopped_ && !view.moved()) {
    for (std::size_t a = 0; a < axes_.size(); ++a)
      axes_[a].residual_u = std::max(axes_[a].residual_u, std::fabs((*view.plant)[a].link_u));
  }
}

double StopResidual::envelope_u(const Axis& axis, const AxisState& s) const {
  const double velocity_part_u =
      axis.damped_rad_s > 0 ? (s.link_u_s + axis.zeta * axis.omega_rad_s * s.link_u) / axis.damped_rad_s
                            : 0.0;
  return std::sqrt(s.link_u * s.link_u + velocity_part_u * velocity_part_u);
}

void StopResidual::report(Ticks now) {
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    Axis& axis = axes_[a];
    if (axis.moved && axis.omega_rad_s > 0) {
      const machine::AxisModel& model = machine_.axis[a];
      log::EventRecord& e = events_.add_at(stop_segment_, now, log::EventKind::residual);
      e.axis = static_cast<int>(a);
      e.value = axis.residual_u;
      e.text = fmt::format("residual vibration of axis {} after the stop {:.3f} {}", model.letter,
                           axis.residual_u * 1000, model.kind == machine::AxisKind::rotary ? "mdeg" : "um");
      axis.worst_u = std::max(axis.worst_u, axis.residual_u);
    }
    axis.moved = false;
  }
  stopped_ = false;
}

void StopResidual::finish(Ticks end) {
  if (stopped_) report(end);
}

void StopResidual::summarize(log::RunSummary& summary) const {
  for (std::size_t a = 0; a < axes_.size(); ++a) summary.axis[a].residual_u = axes_[a].worst_u;
}

}  // namespace kadr::cycle
