#include "emulator/interpolator/slot_track.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "machine/base/numbers.h"

namespace kadr::emulator {
namespace {

using lattice::Method;
using machine::StepMethod;

constexpr double kOnNode = 1e-6;  // steps: a centre that is a node but for rounding
constexpr double kOneTurn_rad = 2 * kPi * (1 + 1e-9);

Method line_method(StepMethod method, int axes) {
  switch (method) {
    case StepMethod::classic:
      return Method::classic;
    case StepMethod::half_step:
      return Method::half_step;
    case StepMethod::extra_points:
      return axes == 2 ? Method::extra_points : Method::diagonal;
    case StepMethod::dda:
      return Method::dda;
    case StepMethod::dda_preloaded:
    case StepMethod::dda_sequential:
    case StepMethod::dda_simultaneous:
      return Method::dda_preloaded;
    case StepMethod::progression:
      return Method::progression;
    case StepMethod::ptp:
      return Method::ptp;
    default:
      return Method::diagonal;
  }
}

Method arc_method(StepMethod method) {
  switch (method) {
    case StepMethod::classic:
      return Method::classic;
    case StepMethod::half_step:
      return Method::half_step;
    case StepMethod::extra_points:
      return Method::extra_points;
    case StepMethod::dda:
    case StepMethod::dda_preloaded:
    case StepMethod::dda_sequential:
      return Method::dda_sequential;
    case StepMethod::dda_simultaneous:
      return Method::dda_simultaneous;
    case StepMethod::progression:
      return Method::progression;
    case StepMethod::chords:
      return Method::chords;
    case StepMethod::ptp:
      return Method::ptp;
    default:
      return Method::octant_midpoint;
  }
}

/// A coordinate that is a node but for rounding.
std::optional<std::int64_t> node_of(double position_u, double step_u) {
  const double steps = position_u / step_u, node = std::floor(steps + 0.5);
  if (std::fabs(steps - node) > kOnNode) return {};
  return static_cast<std::int64_t>(node);
}

}  // namespace

bool SlotTrack::start(const planner::Path& path, std::size_t segment, const machine::MachineModel& machine,
                      const std::vector<std::int64_t>& node_begin,
                      const std::vector<std::int64_t>& node_end) {
  has_next_ = false;
  if (machine.interpolator == StepMethod::crossing) return false;
  const std::size_t axes = node_begin.size();
  const planner::PathSegment& piece = path.segments[segment];
  lane_.assign(axes, -1);
  int lanes = 0;
  const auto moves = [&](std::size_t k) { return node_end[k] != node_begin[k]; };
  if (piece.kind == planner::SegmentKind::line) {
    lattice::LineCurve line;
    for (std::size_t k = 0; k < axes; ++k) {
      if (!moves(k)) continue;
      line.delta[static_cast<std::size_t>(lanes)] = node_end[k] - node_begin[k];
      lane_[k] = lanes++;
    }
    if (lanes == 0) return false;
    line.axes = std::max(lanes, 2);
    curve_ = line;
    method_ = line_method(machine.interpolator, line.axes);
  } else if (piece.kind == planner::SegmentKind::arc) {
    const planner::ArcShape& shape = path.arc_of(segment);
    const auto first = static_cast<std::size_t>(shape.first_axis);
    const auto second = static_cast<std::size_t>(shape.second_axis);
    for (std::size_t k = 0; k < axes; ++k)
      if (k != first && k != second && moves(k)) return false;
    const double step_u = machine.axis[first].step_u;
    if (machine.axis[second].step_u != step_u || std::fabs(shape.sweep_rad) > kOneTurn_rad) return false;
    const auto x = node_of(shape.center_first_u, step_u), y = node_of(shape.center_second_u, step_u);
    if (!x || !y) return false;
    curve_ = lattice::ArcCurve{{node_begin[first] - *x, node_begin[second] - *y},
                               {node_end[first] - *x, node_end[second] - *y},
                               shape.sweep_rad > 0 ? lattice::Turn::ccw : lattice::Turn::cw};
    lane_[first] = 0;
    lane_[second] = 1;
    method_ = arc_method(machine.interpolator);
  } else {
    return false;
  }
  lattice::Made counted = make();
  if (!counted.stepper) return false;
  // how many slots there are says how far they lie apart
  slots_ = passed_ = 0;
  while (counted.stepper->next(slot_)) ++slots_;
  stepper_ = make().stepper;
  length_u_ = piece.length_u;
  advance();
  return has_next_;
}

lattice::Made SlotTrack::make() const { return lattice::make_stepper(curve_, method_); }

void SlotTrack::advance() {
  has_next_ = stepper_->next(slot_);
  // a slot's pulses stand in its middle
  s_u_ = length_u_ * (static_cast<double>(passed_++) + 0.5) / static_cast<double>(slots_);
}

}  // namespace kadr::emulator
