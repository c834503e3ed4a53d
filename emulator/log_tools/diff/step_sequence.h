#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "emulator/log_tools/diff/frame_compare.h"
#include "emulator/log_tools/diff/log_frames.h"

namespace kadr::log_tools {

/// A block whose pulses are not the same in both logs.
struct BlockDifference {
  log::BlockRecord a, b;  ///< the block as each log has it
  struct Count {
    std::string axis;
    std::int64_t a = 0, b = 0;  ///< pulses, both directions
  };
  std::vector<Count> counts;  ///< axes whose counts differ
  std::string order;          ///< where order or direction part, one sentence; empty if they do not
  std::string geometry;       ///< the blocks are not the same move, one sentence; empty if they are
};

/// Compares which pulses each block emits, and in which order, whenever they fire.
///
/// In a log the order is that of the time stamps; pulses of several axes at one base tick have no order in
/// it. So two sequences are the same if no pair of pulses is strictly ordered one way in A and the other way
/// in B. With u the counts per axis after each stamp of A, v those of B, that is: every u <= v or v <= u in
/// all axes. A block begins at the base tick of its KADR_BLOCK; a pulse within one base tick of it may belong
/// to either side, and is counted where the logs agree.
class StepSequence {
 public:
  /// Pulses that one log may be ahead of the other before the comparison is given up.
  static constexpr std::size_t kMostAhead = std::size_t{1} << 16;

  StepSequence(const std::vector<AxisPair>& axes, std::int64_t control_tick_ticks_a,
               std::int64_t control_tick_ticks_b);
  /// The next control tick of log A (side 0) or B (side 1).
  void add(int side, const LogFrame& frame);
  /// No more control ticks of both. @param whole  both ran to the same end, so the last block can be counted
  void finish(bool whole);
  /// Blocks that differ, found since the last call, in order.
  std::vector<BlockDifference> take();

  std::int64_t blocks() const { return blocks_; }        ///< compared
  std::int64_t differing() const { return differing_; }  ///< of these
  bool given_up() const { return given_up_; }

 private:
  using Counts = std::vector<std::int64_t>;  // [axes]
  struct Group {
    Ticks stamp;
    Counts after;  // pulses per axis since the beginning of the log
  };
  struct Mark {
    log::BlockRecord block;
    Ticks stamp;
    Counts low, high;  // pulses before the block surely begins, and before it surely has begun
  };
  struct Side {
    std::int64_t control_tick_ticks = 1;
    Counts total;                                // pulses read
    Counts base;                                 // pulses before the block under way
    std::deque<Group> groups;                    // not matched yet
    std::vector<std::deque<std::int8_t>> signs;  // [axes] not matched yet
    Counts matched;                              // signs matched since the base
    std::deque<Mark> marks;                      // beginnings of the blocks to come
    std::size_t reached = 0, known = 0;          // how many of the marks, from the first, have `low`, `high`
    log::BlockRecord block;                      // under way
    bool begun = false;
  };

  void add_marks(Side& side, const LogFrame& frame);
  void add_pulses(Side& side, int number, const LogFrame& frame);
  void settle_marks(Side& side, Ticks until);
  void match();
  void match_order();
  std::string order_text(const Counts& u, const Counts& v) const;
  void match_signs();
  bool end_block();
  void close_block(const Counts* low_a, const Counts* high_a, const Counts* low_b, const Counts* high_b);
  void begin_block();

  const std::vector<AxisPair>& axes_;
  std::array<Side, 2> side_;
  BlockDifference under_way_;  // of the present block, as far as found
  std::vector<BlockDifference> found_;
  bool order_parted_ = false;  // in the present block
  std::int64_t blocks_ = 0, differing_ = 0;
  bool given_up_ = false;
};

}  // namespace kadr::log_tools
