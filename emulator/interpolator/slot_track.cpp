#include "emulator/interpolator/slot_track.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "machine/base/numbers.h"
#include "machine/base/require.h"
#include "machine/machine.h"

namespace kadr::interpolator {
namespace {

using lattice::Method;

constexpr double kOnNode = 1e-6;  // steps: a centre that is a node up to rounding
constexpr double kOneTurn_rad = 2 * kPi * (1 + 1e-9);

const lattice::MethodEntry::Followers& followers_of(Method asked) {
  const auto& followers = lattice::entry_of(asked).on_machine;
  require(followers.has_value(), "a machine runs none of the laboratory's methods");
  return *followers;
}

/// A coordinate that is a node up to rounding.
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
  if (machine.interpolator == Method::crossing) return false;
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
    method_ = followers_of(machine.interpolator).line;
    // the two extra points lie in a plane
    if (!lattice::knows(method_, curve_)) method_ = Method::diagonal;
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
    method_ = followers_of(machine.interpolator).arc;
  } else {
    return false;
  }
  lattice::Made counted = make();
  if (!counted.stepper) return false;
  // dry run: the slot count fixes the spacing
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
  // a slot's pulses are in its middle
  s_u_ = length_u_ * (static_cast<double>(passed_++) + 0.5) / static_cast<double>(slots_);
}

}  // namespace kadr::interpolator
