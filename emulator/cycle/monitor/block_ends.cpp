#include "emulator/cycle/monitor/block_ends.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "planner/path/path.h"

namespace kadr::cycle {

BlockEnds::BlockEnds(const planner::Path& path, std::size_t axes, std::vector<log::BlockEndRecord>& records)
    : path_(path), records_(records), axes_(axes) {}

void BlockEnds::tick(const TickView& view) {
  if (path_.size() > 0) {
    if (open_ && path_.segments[view.segment].block != path_.segments[segment_].block) end_block(view.end);
    segment_ = view.segment;
    // a stand before the block is none of its motion
    open_ = open_ || view.motion.s_end_u > path_.start_s_u[segment_];
  }
  has_energy_ = view.energy != nullptr;
  if (!view.plant) return;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    Axis& axis = axes_[a];
    const AxisState& state = (*view.plant)[a];
    axis.peak_link_u = std::max(axis.peak_link_u, std::fabs(state.link_u));
    axis.peak_following_u =
        std::max(axis.peak_following_u, std::fabs(tool_error_u(state, view.batch.axis[a])));
    if (!view.energy) continue;
    axis.positive_J = (*view.energy)[a].positive_work_J;
    axis.recuperated_J = recuperated_J((*view.energy)[a]);
  }
}

void BlockEnds::end_block(Ticks tick) {
  const planner::PathSegment& segment = path_.segments[segment_];
  log::BlockEndRecord record{tick, segment.block, segment.span.line, {}, {}, {}, {}};
  for (Axis& axis : axes_) {
    record.peak_link_u.push_back(std::exchange(axis.peak_link_u, 0.0));
    record.peak_following_u.push_back(std::exchange(axis.peak_following_u, 0.0));
    if (!has_energy_) continue;
    record.positive_J.push_back(axis.positive_J - axis.begin_positive_J);
    record.recuperated_J.push_back(axis.recuperated_J - axis.begin_recuperated_J);
    axis.begin_positive_J = axis.positive_J;
    axis.begin_recuperated_J = axis.recuperated_J;
  }
  records_.push_back(std::move(record));
  open_ = false;
}

void BlockEnds::finish(Ticks end) {
  if (open_) end_block(end);
}

}  // namespace kadr::cycle
