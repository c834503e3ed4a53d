#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "machine/step_batch.h"
#include "machine/step_hash.h"
#include "planner/laws/motion_source.h"

namespace kadr::planner {
class Path;
}

namespace kadr::machine {
struct MachineModel;
}

/// From path and tick motion to step pulses. Which pulses, and in which order along the path, is geometry
/// alone; the motion law only says when each fires.
namespace kadr::interpolator {

/// One pulse with its position: data that a drawing, a study or the self-check needs beyond the batch.
struct StepEvent {
  std::size_t segment = 0;
  /// on the segment, in [0, length]; a pure function of segment and pulse, whatever the feed
  double s_u = 0;
  std::int32_t axis = 0;
  std::int32_t sign = 1;
  double moment_ticks = 0;  ///< unrounded, since the control tick's beginning
};

/// Half-crossing events on lines, arcs and helices in n axes: an axis steps when its coordinate crosses (k +
/// 1/2) steps. Invariant: |node - x(t_event)| <= 1/2 step on every axis at every event (papers 002 and 004).
class CrossingInterpolator {
 public:
  CrossingInterpolator(const planner::Path& path, const machine::MachineModel& machine);
  ~CrossingInterpolator();
  /// Fills the batch with all pulses of this tick (storage reused, no allocation after the first ticks) and
  /// the axis commands at its ends. Ticks must come in order. A pulse fires in the tick whose (s_begin,
  /// s_end] contains its position; a position at the very beginning of a segment fires when the motion enters it. A
  /// tick that ends at rest within 1e-9 units before a joint is on the joint.
  void advance(const planner::TickMotion& motion, StepBatch& batch);
  /// Lattice node (steps from machine zero) at the end of the last tick, per machine axis; begins at the node
  /// of the path's start.
  const std::vector<std::int64_t>& position_steps() const;
  /// Segment reached at the end of the last tick (on a joint: the one that ends there), and whether a joint
  /// lay strictly inside the tick, so that a corner may lie between the speeds at its two ends.
  std::size_t segment() const;
  bool passed_joint() const;
  /// Largest |node - x(t_event)| in steps seen so far, per axis, less what the rounding of s and x themselves
  /// makes (4 ulp of path length and position); at most 1/2 + 1e-9. Kept for the ticks that are
  /// advanced while the check is on. Slow.
  void set_self_check(bool on);
  const std::vector<double>& worst_node_error_steps() const;
  /// Segment of the largest of them.
  std::size_t worst_node_segment() const;
  /// The last tick's pulses of all axes in path order: by segment, position, axis number. Only kept when trace
  /// is on. Slow.
  void set_trace(bool on);
  const std::vector<StepEvent>& trace() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kadr::interpolator
