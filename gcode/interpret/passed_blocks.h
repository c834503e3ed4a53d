#pragma once
#include <vector>

#include "gcode/block.h"

namespace kadr::gcode {

/// The blocks before the line where a program is entered (Reading::from_line): where they have led the machine, and what
/// they have set that still holds.
class PassedBlocks {
 public:
  /// @param home  where the machine stands before the first block, machine coordinates
  explicit PassedBlocks(const AxisValues& home) : place_(home) {}
  void add(const Block& block);
  /// Where the last move ended: a probing move at its contact, a tap where it began.
  const AxisValues& place() const { return place_; }
  /// The last move followed the spindle's angle: another thread goes on without a stop.
  bool in_thread() const { return moved_in_step_; }
  /// Tool, feed, spindle, coolant, overrides and outputs, in the order in which they were set; those that are as before
  /// the first block left out.
  std::vector<Block> settings() const;
  /// What waits for the next move: outputs that change with it, the highest speed where it begins.
  const std::vector<Block>& waiting() const { return waiting_; }

 private:
  void set(const Block& block);
  void move(const Move& move, const AxisValues& end);

  AxisValues place_;
  std::vector<Block> settings_, waiting_;
  bool in_step_ = false;  ///< between SyncStart and SyncStop
  bool moved_in_step_ = false;
};

}  // namespace kadr::gcode
