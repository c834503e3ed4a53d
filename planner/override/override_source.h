#pragma once
#include "planner/feed_plan.h"
#include "planner/motion_source.h"
#include "planner/override/feed_terrain.h"
#include "planner/override/feed_tracker.h"

namespace kadr::planner {

/// Plays a plan under an operator's percent: the law itself as long as 100 % is asked for, a FeedTracker from
/// the first change to the end of that run (rest to rest). A run that the tracker ends rests to the next
/// control tick; then the law goes on, pauses included.
///
/// While the law brakes for a place ahead, or a move is locked, a change waits (paper 003: the percent is not
/// changed while braking); the log tells it by OverrideNote. An emergency stop does not wait.
class OverrideSource final : public MotionSource {
 public:
  /// @param most_percent  highest ratio that advance() will be given, >= 1
  OverrideSource(const Path& path, const FeedPlan& plan, const machine::MachineModel& machine,
                 double most_percent);
  TickMotion advance(const OperatorInput& input) override;
  bool finished() const override;
  bool stopped() const override { return stopped_; }

 private:
  bool law_rests() const;
  bool law_brakes() const;
  bool leave_law(const Percent& percent);
  void return_to_law();
  void advance_tracker(TickMotion& motion, const Percent& percent, bool emergency);

  const Path& path_;
  const FeedPlan& plan_;
  const machine::MachineModel& machine_;
  FeedTerrain terrain_;
  LawSource law_;
  FeedTracker tracker_;
  bool tracking_ = false, stopped_ = false;
  std::size_t segment_ = 0;  ///< of the law
  double s_u_ = 0;           ///< at the end of the last tick
  ControlTicks tick_;
};

}  // namespace kadr::planner
