#include "emulator/cycle/block_starts.h"

#include <string>

#include "emulator/cycle/tick_time.h"

namespace kadr::cycle {

static_assert(gcode::kBlockKinds.word(gcode::BlockKind::approach) == log::kApproachMotion,
              "readers of logs know the approach by its word");

void BlockStarts::tick(const TickMotion& motion) {
  list_.clear();
  const planner::Path& path = job_.read.path;
  const bool moved = motion.s_end_u > motion.s_begin_u;
  while (segments_ < path.size() &&
         (motion.s_end_u > path.start_s_u[segments_] || (moved && segments_ == 0))) {
    const std::size_t segment = segments_++;
    if (segment > 0 && path.segments[segment].block == path.segments[segment - 1].block) continue;
    list_.push_back({segment, base_tick_at(motion, path.start_s_u[segment], job_.given.machine.model.clock)});
  }
}

log::BlockRecord BlockStarts::record(const Start& start, const TickMotion& motion,
                                     ControlTicks deferred_ticks) const {
  const planner::PathSegment& s = job_.read.path.segments[start.segment];
  const BlockSummary summary = block_summary(job_.read.path, job_.planned.plan, start.segment);
  log::BlockRecord r;
  r.tick = start.tick;
  r.block = s.block;
  r.span = s.span;
  r.text = std::string(job_.sources[s.span.file].line(s.span.line));
  r.motion = planner::motion_name(s);
  r.length_u = summary.length_u;
  r.programmed_u_s = summary.programmed_u_s;
  r.planned_peak_u_s = summary.peak_u_s;
  r.planned_end_u_s = summary.end_u_s;
  r.planned_s = summary.time_s;
  r.limited_by = limited_by_text(summary.limited_by, summary.limiting_axis, job_.given.machine.model);
  r.entry_u_s = feed_at_u_s(motion, job_.read.path.start_s_u[start.segment]);
  if (start.segment > 0) r.planned_entry_u_s = job_.planned.plan.segments[start.segment - 1].end_u_s;
  r.deferred_ticks = deferred_ticks;
  return r;
}

}  // namespace kadr::cycle
