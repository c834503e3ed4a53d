#pragma once
#include <memory>
#include <optional>

#include "planner/laws/feed_plan.h"
#include "planner/laws/motion_source.h"
#include "planner/override/axis_limiter.h"
#include "planner/override/feed_terrain.h"
#include "planner/override/feed_tracker.h"
#include "planner/override/override.h"
#include "planner/path/joints.h"
#include "planner/positioning/positioning.h"

namespace kadr::planner {

/// Plays a plan under the operator's override: the law itself as long as 100 % is requested, a FeedTracker from
/// the first change to the end of that run (rest to rest). A run that the tracker ends rests to the next
/// control tick; then the law continues, pauses included.
///
/// While the law brakes for a place ahead, or a move is locked, a change waits (paper 003: the override is not
/// changed while braking); the log shows it as OverrideNote. An emergency stop does not wait.
///
/// A rapid planned by planner.rapid_law gets its override as it begins: a law of its own with that share
/// of the speed, and as silent. Changes wait for the next one; a feed hold brakes it as any other move.
///
/// If an axis would have to exceed its highest speed, an axis limiter lowers the feed to K_max
/// times the one demanded, in the control tick after it was measured (eq. 12) or in the same one
/// (predictive). Braking begins from the limited feed.
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
  /// Whether the tracker could take over.
  bool leave_law(const LawSource& source, const MotionLaw& law, const Percent& percent);
  /// At rest at the end of a segment: the law continues from there with the next control tick.
  void return_to_law(std::size_t segment);
  /// The row of the plan that the law is in or begins with; nullptr: no rapid of planner.rapid_law.
  const PositionedSegment* rapid_of_law();
  /// Applies an override to such a rapid; false: nothing to do, or the motion has to leave it.
  bool advance_rapid(TickMotion& motion, const OperatorInput& input, const Percent& percent);
  void begin_slow_rapid(std::size_t segment, double ratio);
  void advance_tracker(TickMotion& motion, const Percent& percent, bool emergency);
  /// A tick in which the axis limiter lowers the feed; false: it does not, or the motion has to brake.
  bool advance_limited(TickMotion& motion, const Percent& percent);
  bool brakes_from(double s_u, double speed_u_s, const Percent& percent);
  LimitedFeed limiter_at(double s_u, double feed_u_s);
  void finish_tick(TickMotion& motion);
  void take_back(const Percent& percent);

  const Path& path_;
  std::unique_ptr<const Joints> joints_;
  const FeedPlan& plan_;
  const machine::MachineModel& machine_;
  FeedTerrain terrain_;
  LawSource law_;
  FeedTracker tracker_;
  FeedTracker probe_;     ///< asks whether a limited feed has to brake
  LimitedFeed limit_;     ///< of the last tick: it counts in the next one (eq. 12)
  MotionState demand_{};  ///< feed before the limiter, while limited
  bool limited_ = false;
  std::vector<double> tangent_;  ///< [joints]
  PositioningPlanner rapids_;
  std::size_t next_rapid_ = 0;  ///< of plan.positioned: the first that the law is not past
  MotionLaw slow_rapid_;        ///< the current one under an override
  std::optional<LawSource> slow_source_;
  double slow_ratio_ = 1;
  bool tracking_ = false, stopped_ = false;
  std::size_t segment_ = 0;         ///< of the law
  double s_u_ = 0, speed_u_s_ = 0;  ///< at the end of the last tick
  ControlTicks tick_;
};

}  // namespace kadr::planner
