#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "machine/machine.h"
#include "machine/step_batch.h"
#include "planner/motion_source.h"
#include "planner/path.h"

/// From path and tick motion to step pulses. Which pulses, and in which order along the path, is geometry alone; the
/// motion law only says when each fires.
namespace kadr::emulator {

/// Lattice node of a position: floor(x/step + 1/2), so that every axis counts consistently from block to block.
std::int64_t lattice_node(double position_u, double step_u);

/// Half-crossing events on lines, arcs and helices in n axes: an axis steps when its coordinate crosses (k + 1/2) steps.
/// Invariant: |node - x(t_event)| <= 1/2 step on every axis at every event (papers 002 and 004).
class CrossingInterpolator {
 public:
  CrossingInterpolator(const planner::Path& path, const machine::MachineModel& machine);
  ~CrossingInterpolator();
  /// Fills the batch with all pulses of this tick (storage reused, no allocation after the first ticks) and the axis
  /// commands at its ends. Ticks must come in order.
  void advance(const planner::TickMotion& motion, StepBatch& batch);
  /// Steps from program zero at the end of the last tick, per machine axis.
  const std::vector<std::int64_t>& position_steps() const;
  /// Segment reached at the end of the last tick, and whether a joint was passed in it.
  std::size_t segment() const;
  bool passed_joint() const;
  /// Largest |node - x(t_event)| in steps seen so far, per axis; only kept when check is on.
  void set_self_check(bool on);
  const std::vector<double>& worst_node_error_steps() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Running hash over the step stream: per tick and axis the offsets and signs (integers only).
class StepHash {
 public:
  StepHash();
  ~StepHash();
  void add(const StepBatch& batch);
  std::uint64_t digest() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kadr::emulator
