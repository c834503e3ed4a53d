#pragma once
#include <cstddef>
#include <vector>

#include "emulator/cycle/monitor/tick_view.h"
#include "emulator/log/records.h"

namespace kadr::planner {
class Path;
}

namespace kadr::cycle {

/// Effect of each motion block on the machine: one record at the first control tick at whose end another block
/// is under way. Blocks that pass within one tick have none.
class BlockEnds {
 public:
  /// @param path, records  outlive this
  BlockEnds(const planner::Path& path, std::size_t axes, std::vector<log::BlockEndRecord>& records);
  void tick(const TickView& view);
  /// Ends the last block.
  void finish(Ticks end);

 private:
  struct Axis {
    double peak_link_u = 0, peak_following_u = 0;          // in the block
    double positive_J = 0, recuperated_J = 0;              // since the run's beginning
    double begin_positive_J = 0, begin_recuperated_J = 0;  // the same, where the block began
  };
  void end_block(Ticks tick);

  const planner::Path& path_;
  std::vector<log::BlockEndRecord>& records_;
  std::vector<Axis> axes_;
  bool open_ = false;        // a block is under way
  bool has_energy_ = false;  // the last tick had
  std::size_t segment_ = 0;  // of the block under way, at the end of the last tick
};

}  // namespace kadr::cycle
