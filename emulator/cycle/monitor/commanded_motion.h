#pragma once
#include <cstddef>
#include <vector>

#include "emulator/cycle/monitor/tick_view.h"

namespace kadr::planner {
class Path;
}

namespace kadr::machine {
struct MachineModel;
}

namespace kadr::cycle {

/// One axis as commanded, at the end of a control tick; mm or deg.
struct CommandedAxis {
  double position_u = 0, speed_u_s = 0, accel_u_s2 = 0, jerk_u_s3 = 0;
  bool at_rest = true;  ///< in this tick as in the one before: nothing about it has changed
};

/// Derives the command of each axis from path and tick motion: speed is dx/ds * ds/dt at the tick's
/// end, acceleration and jerk are its first and second differences over tau.
class CommandedMotion {
 public:
  /// @param path  outlives this
  CommandedMotion(const planner::Path& path, const machine::MachineModel& machine);
  void tick(const TickView& view);

  const CommandedAxis& operator[](std::size_t axis) const { return axes_[axis]; }
  std::size_t size() const { return axes_.size(); }
  const std::vector<double>& tangent() const { return tangent_; }  ///< [axes] dx/ds; 0 at rest
  /// The acceleration of this tick spans a joint between segments: a corner's step of speed is part of it.
  bool accel_spans_joint() const { return ticks_since_joint_ == 0; }
  /// The jerk of this tick spans one.
  bool jerk_spans_joint() const { return ticks_since_joint_ <= 1; }

 private:
  const planner::Path& path_;
  double tau_s_;
  std::vector<CommandedAxis> axes_;
  std::vector<double> tangent_;
  std::size_t segment_ = 0;
  static constexpr int kLongAgo = 2;  // a joint further back is in no difference
  int ticks_since_joint_ = kLongAgo;
};

}  // namespace kadr::cycle
