#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "emulator/interpolator/lattice/lattice.h"
#include "machine/base/count.h"
#include "planner/path/path.h"

namespace kadr::interpolator {

/// The steps of a segment by one of the other methods of paper 002 (machine key interpolator.method), one
/// clock slot after the other, the slots evenly over the segment's length. For study: it shows how such
/// controllers modulate the feed, by up to sqrt 2 along the path and 2 : 1 on an axis.
///
/// Lines in any axes and arcs in a plane of equal steps, whose centre is a node, with at most one turn. A
/// method that does not know lines, or arcs, is replaced by its closest equivalent (MethodEntry::on_machine).
class SlotTrack {
 public:
  /// Takes up a segment; false: no method here follows it, or none is configured.
  /// @param node_begin, node_end  [axes] lattice nodes of the segment's ends
  bool start(const planner::Path& path, std::size_t segment, const machine::MachineModel& machine,
             const std::vector<Steps>& node_begin, const std::vector<Steps>& node_end);

  /// The next slot, until there are none: its position on the segment, and the axes that step.
  bool at_end() const { return !has_next_; }
  double s_u() const { return s_u_; }
  int step(std::size_t axis) const {
    return lane_[axis] < 0 ? 0 : slot_.step[static_cast<std::size_t>(lane_[axis])];
  }
  void advance();

 private:
  lattice::Made make() const;

  lattice::Curve curve_;
  lattice::Method method_ = lattice::Method::crossing;
  std::unique_ptr<lattice::Stepper> stepper_;
  lattice::Slot slot_;
  std::vector<int> lane_;  // [axes] the curve's axis of a machine axis, or -1
  std::int64_t slots_ = 0, passed_ = 0;
  double length_u_ = 0, s_u_ = 0;
  bool has_next_ = false;
};

}  // namespace kadr::interpolator
