#pragma once
#include <cstdint>
#include <vector>

#include "planner/scheduler/block_diagram.h"
#include "planner/scheduler/pieces.h"

namespace kadr::planner {

/// Writes the blocks of a path, one after the other, into a plan: pieces of the law and rows of the table.
class BlockWriter {
 public:
  /// @param plan  empty; kept by reference
  BlockWriter(const Path& path, double tau_s, FeedPlan& plan);
  void add(const BlockDiagram& block, const BlockReasons& why);
  double time_s() const { return pieces_.time_s(); }

 private:
  SegmentPlan row(const BlockDiagram& block) const;

  const Path& path_;
  double tau_s_;
  FeedPlan& plan_;
  PieceWriter pieces_;
  std::int64_t ticks_ = 0;
  std::vector<Element> elements_;  // of one block
};

}  // namespace kadr::planner
