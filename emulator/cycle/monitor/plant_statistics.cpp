#include "emulator/cycle/monitor/plant_statistics.h"

#include <algorithm>
#include <cmath>

#include "machine/machine.h"

namespace kadr::cycle {

PlantStatistics::PlantStatistics(const machine::MachineModel& machine, const CommandedMotion& commanded)
    : machine_(machine), commanded_(commanded), axes_(machine.axis.size()) {}

void PlantStatistics::tick(const TickView& view, std::uint32_t line) {
  ++ticks_;
  if (!view.plant) return;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    Axis& axis = axes_[a];
    const AxisState& state = (*view.plant)[a];
    const double link_u = std::fabs(state.link_u);
    const double following_u = std::fabs(tool_error_u(state, view.batch.axis[a]));
    axis.vibration_squares_u2 += link_u * link_u;
    axis.following_squares_u2 += following_u * following_u;
    axis.peak_following_u = std::max(axis.peak_following_u, following_u);
    if (link_u > axis.peak_vibration_u) {
      axis.peak_vibration_u = link_u;
      axis.peak_vibration_tick = view.end;
      axis.peak_vibration_line = line;
    }
    if (!view.energy) continue;
    axis.positive_J = (*view.energy)[a].positive_work_J;
    axis.recuperated_J = recuperated_J((*view.energy)[a]);
  }
  path_error_u_ = std::max(path_error_u_, path_error_u(view));
}

/// The tool's error across the path; the part along it is delay, not a wrong contour.
double PlantStatistics::path_error_u(const TickView& view) const {
  const std::vector<double>& tangent = commanded_.tangent();
  double error_u2 = 0, along_u = 0, tangent2 = 0;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    if (axis_index(machine_.axis[a].letter) > 2) continue;
    const double e = tool_error_u((*view.plant)[a], view.batch.axis[a]);
    error_u2 += e * e;
    along_u += e * tangent[a];
    tangent2 += tangent[a] * tangent[a];
  }
  if (tangent2 > 0) error_u2 = std::max(0.0, error_u2 - along_u * along_u / tangent2);
  return std::sqrt(error_u2);
}

void PlantStatistics::summarize(log::RunSummary& summary) const {
  const double n = ticks_ > ControlTicks{} ? static_cast<double>(ticks_.value) : 1.0;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const Axis& axis = axes_[a];
    log::AxisSummary& s = summary.axis[a];
    s.peak_vibration_u = axis.peak_vibration_u;
    s.peak_vibration_tick = axis.peak_vibration_tick;
    s.peak_vibration_line = axis.peak_vibration_line;
    s.rms_vibration_u = std::sqrt(axis.vibration_squares_u2 / n);
    s.peak_following_u = axis.peak_following_u;
    s.rms_following_u = std::sqrt(axis.following_squares_u2 / n);
    s.positive_J = axis.positive_J;
    s.recuperated_J = axis.recuperated_J;
  }
  summary.path_error_u = path_error_u_;
}

}  // namespace kadr::cycle
