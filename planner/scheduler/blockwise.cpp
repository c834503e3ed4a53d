#include "planner/scheduler/blockwise.h"

#include <algorithm>

#include "machine/machine.h"
#include "planner/path/path.h"

namespace kadr::planner {
BlockScheduler::BlockScheduler(const Path& path, const PathLimitTable& table,
                               const machine::MachineModel& machine)
    : path_(path), table_(table), machine_(machine), brakeable_u_s_(path.size() + 1) {
  for (std::size_t i = path.size(); i-- > 1;) {
    const double cap = table.cap_u_s[2 * i];
    const double end = brakeable_u_s_[i + 1];
    brakeable_u_s_[i] = cap > end ? reach_speed_u_s(end, path.segments[i].length_u, limits(i), cap) : cap;
  }
}

bool BlockScheduler::next(BlockDiagram& block) {
  if (behind_ == path_.size()) return false;
  const std::size_t i = behind_++;
  block = {};
  block.length_u = path_.segments[i].length_u;
  block.limits = limits(i);
  block.entry_u_s = entry_u_s_;
  block.end_u_s = brakeable_u_s_[i + 1];
  if (block.entry_u_s < block.end_u_s)
    block.end_u_s = reach_speed_u_s(block.entry_u_s, block.length_u, block.limits, block.end_u_s);
  const double cap = table_.cap_u_s[2 * i + 1];
  block.main_u_s = peak_speed_u_s(block.entry_u_s, block.end_u_s, block.length_u, block.limits,
                                  std::max(block.entry_u_s, block.end_u_s), cap);
  at_cap_ = block.main_u_s >= cap;
  if (machine_.planner.whole_ticks && block.time_s() < kLongest_s)
    fill_block_ticks(block, machine_.clock.tau_s(), machine_.planner.block_ticks);
  entry_u_s_ = block.end_u_s;
  return true;
}

BlockReasons BlockScheduler::reasons() const {
  const std::size_t i = segment();
  const auto ramp = [&](std::size_t low_joint) {
    const Signature at = table_.signature[2 * low_joint];
    return at.reason == LimitedBy::junction ? at : Signature{LimitedBy::length, -1};
  };
  return {ramp(i), at_cap_ ? table_.signature[2 * i + 1] : Signature{LimitedBy::length, -1}, ramp(i + 1)};
}

}  // namespace kadr::planner
