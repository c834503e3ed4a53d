#pragma once
#include <cstdint>
#include <vector>

#include "planner/laws/feed_plan.h"
#include "planner/override/approach.h"
#include "planner/override/feed_terrain.h"
#include "planner/override/feed_way.h"

namespace kadr::planner {

/// Moves along a path under an override that may change at every control tick: follows the lowest cap,
/// limited in acceleration and jerk (paper 003, eq. 6-8 as corrected in docs/papers.md).
///
/// From any state (s, v, a) it decides the shortest way to the cap here, as high as all valleys ahead allow
/// to be braked for:
///   [bring a to 0] [ramp to w] [hold w] [brake to the valley that comes first]
/// and does so again where that ends. A new override does not disturb braking for a valley; everything else
/// is decided again, but only for a way that keeps every hard cap; an override that falls too late for the
/// place ahead is followed as fast as the ramp allows. In proportional mode no limit is guaranteed. Closed
/// forms and bracketed bisections of fixed count, + - * / sqrt only. Storage is kept from decision to
/// decision; it grows only where more than 256 valleys lie within one look ahead.
///
/// feed_tracker.cpp moves along the decided way (FeedWay); feed_decision.cpp decides it.
class FeedTracker {
 public:
  explicit FeedTracker(const FeedTerrain& terrain);

  /// Takes over at a state on a segment's run.
  /// @param jerk_u_s3     with which the present acceleration can be brought to 0 in time; > 0, may be inf
  /// @param ceiling_u_s   no faster than this, in addition to all caps, until it has braked for a valley
  /// @return false: while it moves, this override can't be followed from there without overrunning a hard cap
  bool start(std::size_t segment, const MotionState& state, const Percent& percent, double jerk_u_s3,
             double ceiling_u_s = machine::kInfinity);
  /// The override from now on. It waits while the tracker brakes for a valley or the move is locked, and
  /// while a way that follows it would overrun a hard cap that the decided one keeps.
  void set_percent(const Percent& percent);
  /// Stops as fast as the ramp allows, whatever is under way.
  void stop_now();
  /// Moves on by a time, s.
  void advance(double time_s);
  /// Appends the motion from now on to a law, so that verify() can check it; nullptr: no more.
  void record(MotionLaw* law) { record_ = law; }

  const MotionState& state() const { return state_; }
  std::size_t segment() const { return segment_; }
  /// At rest at the end of its run.
  bool run_ended() const { return ended_; }
  const Percent& percent() const { return percent_; }  ///< in force
  bool braking() const;                                ///< for a valley: an override waits
  bool locked() const { return terrain_.locked(segment_) && state_.speed_u_s > 0.0; }
  Signature limited_by() const;

 private:
  void write_down(double time_s);
  bool decide(bool may_refuse);
  void begin_decision();
  void look_ahead(double fastest_u_s);
  void hold_to_hard_valley(double flared_u_s, double cap_u_s);
  RampLimits limits(std::size_t first, std::size_t last) const {
    return terrain_.scaled(first, last, scale_);
  }
  Approach approach_to(double w_u_s) const {
    return approach({terrain_, state_, segment_, limits_, scale_, slack_u_}, w_u_s);
  }
  const Valley* broken(double w_u_s, const std::vector<Valley>& valleys) const;
  bool overruns(double w_u_s);
  void collect_hard();
  bool passed_too_fast(double w_u_s);
  bool braking_fits(double end_u, double w_u_s, const Valley& valley) const;
  double highest(double low_u_s, double high_u_s);
  void track(double w_u_s, double cap_u_s);
  bool rests_behind(double w_u_s, double cap_u_s, const RampLimits& limits);
  void hold_and_brake(double w_u_s, double now_u, const RampLimits& limits, const Signature& why);
  void drop_to(const Valley& valley);
  double hold_end(std::size_t segment, double w_u_s, double until_u) const;
  void enter(std::size_t place);

  const FeedTerrain& terrain_;
  double slack_u_;    ///< positions that s can't tell apart
  double allowed_u_;  ///< by how much a braking may miss its valley
  Percent percent_, wanted_;
  MotionState state_{};
  std::size_t segment_ = 0;
  RampLimits limits_{0, 0};  ///< under which the present acceleration came about
  MotionLaw* record_ = nullptr;
  double ceiling_u_s_ = machine::kInfinity;
  double scale_ = 1.0;  ///< of accelerations and jerks: proportional mode
  bool ended_ = true, stopping_ = false;

  FeedWay way_;                   ///< under way and decided
  FeedWay kept_;                  ///< while another ramp is looked for
  FeedWay trial_;                 ///< of a ramp that is only looked at
  std::vector<Valley> valleys_;   ///< under the override
  std::vector<Valley> hard_;      ///< whatever the override, and
  std::vector<Valley> all_hard_;  ///< with those that any braking passes below
  double fastest_u_s_ = 0;        ///< that the present decision can come to
  std::size_t run_end_joint_ = 0;
  double seen_u_ = 0;  ///< up to here a hold is safe from valleys that were not checked
};

}  // namespace kadr::planner
