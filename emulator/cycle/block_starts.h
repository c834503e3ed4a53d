#pragma once
#include <cstddef>
#include <vector>

#include "emulator/emulator.h"
#include "machine/tick_motion.h"

namespace kadr::cycle {

/// Finds the motion blocks that begin in a control tick.
class BlockStarts {
 public:
  struct Start {
    std::size_t segment = 0;  ///< first one of the block
    Ticks tick;               ///< at which its motion begins
  };
  /// @param job  outlives this
  explicit BlockStarts(const Job& job) : job_(job) {}
  void tick(const TickMotion& motion);
  const std::vector<Start>& list() const { return list_; }  ///< of the last tick
  void clear() { list_.clear(); }
  /// Segments from the path's beginning whose motion has begun.
  std::size_t segments() const { return segments_; }
  /// The log's record of a block that began in this tick.
  /// @param deferred_ticks  that a change of the override has been waiting
  log::BlockRecord record(const Start& start, const TickMotion& motion, ControlTicks deferred_ticks) const;

 private:
  const Job& job_;
  std::vector<Start> list_;
  std::size_t segments_ = 0;
};

}  // namespace kadr::cycle
