#include "planner/scheduler/block_writer.h"

#include <utility>

#include "planner/path/path.h"

namespace kadr::planner {

BlockWriter::BlockWriter(const Path& path, double tau_s, FeedPlan& plan)
    : path_(path), tau_s_(tau_s), plan_(plan), pieces_(plan.law) {
  plan.segments.reserve(path.size());
}

void BlockWriter::add(const BlockDiagram& block, const BlockReasons& why) {
  const std::size_t i = plan_.segments.size();
  const double begin_s = pieces_.time_s();
  elements_.clear();
  const double stretch = append_elements(block, path_.start_s_u[i], tau_s_, why, elements_);
  // elements that are too short to move time are the last bits of a bisection
  double time_s = begin_s;
  const auto moves_no_time = [&](const Element& e) {
    const double before_s = std::exchange(time_s, time_s + e.time_s() * stretch);
    return time_s == before_s;
  };
  if (elements_.size() > 1) std::erase_if(elements_, moves_no_time);
  ticks_ += block.ticks;
  const double end_s = static_cast<double>(ticks_) * tau_s_;
  // a block that is scaled to whole ticks, but ends at rest, stands there for the part of a tick
  const bool rests = block.rule == TickRule::scale && block.end_u_s == 0.0;
  pieces_.add(elements_, stretch, block.ticks > 0 && !rests ? end_s : -1.0);
  if (rests) pieces_.rest(path_.start_s_u[i + 1], end_s);
  SegmentPlan now = row(block);
  now.begin_time_s = begin_s;
  now.end_time_s = pieces_.time_s();
  if (i > 0) {
    SegmentPlan& before = plan_.segments.back();
    before.end_jump_u_s = before.kl == now.kl ? 0.0 : block.entry_u_s * now.kl - before.end_u_s;
  }
  plan_.segments.push_back(now);
  plan_.law.duration_s = now.end_time_s;
}

SegmentPlan BlockWriter::row(const BlockDiagram& block) const {
  SegmentPlan row;
  row.peak_u_s = block.main_u_s * block.kl;
  row.end_u_s = block.end_u_s * block.kl;
  row.kl = block.kl;
  row.rule = block.rule;
  // a hold has the peak; without one, the ramp that comes to it
  const Element* peak = &elements_.front();
  for (const Element& e : elements_)
    if (e.is_hold() && e.v0_u_s == row.peak_u_s) peak = &e;
  row.limited_by = peak->signature.reason;
  row.limiting_axis = peak->signature.axis;
  return row;
}

}  // namespace kadr::planner
