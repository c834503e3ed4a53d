#pragma once
#include <cstdint>
#include <vector>

#include "planner/laws/feed_plan.h"
#include "planner/override/feed_terrain.h"

namespace kadr::planner {

/// Moves along a path under a percent that may change at every control tick: one tracker of the lowest cap,
/// limited in acceleration and jerk (paper 003, eq. 6-8 as corrected in docs/papers.md).
///
/// From any state (s, v, a) it decides the shortest way to the cap here, as high as all valleys ahead allow
/// to be braked for:
///   [bring a to 0] [ramp to w] [hold w] [brake to the valley that comes first]
/// and does so again where that ends. Braking for a valley is not disturbed by a percent; everything else
/// is decided anew as the percent changes, but only for a way that keeps every hard cap; a percent that falls
/// too late for the place ahead is followed as fast as the ramp goes. Multiplied (proportional mode) nothing
/// is promised. Closed forms and bracketed bisections of fixed count, + - * / sqrt only. Storage is kept from
/// decision to decision; it grows only where more than 256 valleys lie within one look ahead.
class FeedTracker {
 public:
  explicit FeedTracker(const FeedTerrain& terrain);

  /// Takes over at a state on a segment's run.
  /// @param jerk_u_s3     with which the present acceleration can be brought to 0 in time; > 0, may be inf
  /// @param ceiling_u_s   no faster than this, besides all caps, until it has braked for a valley
  /// @return false: while it moves, this percent can't be followed from there without overrunning a hard cap
  bool start(std::size_t segment, const MotionState& state, const Percent& percent, double jerk_u_s3,
             double ceiling_u_s = machine::kInfinity);
  /// The percent from now on. It waits while the tracker brakes for a valley or the move is locked, and while
  /// a way that follows it would overrun a hard cap that the one decided keeps.
  void set_percent(const Percent& percent);
  /// Stops as fast as the ramp goes, whatever is under way.
  void stop_now();
  /// Moves on by a time, s.
  void advance(double time_s);
  /// Appends what is run from now on to a law, so that verify() can look at it; nullptr: no more.
  void record(MotionLaw* law) { record_ = law; }

  const MotionState& state() const { return state_; }
  std::size_t segment() const { return segment_; }
  /// At rest at the end of its run.
  bool run_ended() const { return ended_; }
  const Percent& percent() const { return percent_; }  ///< in force
  bool braking() const;                                ///< for a valley: a percent waits
  bool locked() const { return terrain_.locked(segment_) && state_.speed_u_s > 0.0; }
  Signature limited_by() const;

 private:
  struct Piece {
    double duration_s = 0;
    MotionState begin{};
    RampLimits limits{0, 0};  ///< under which its acceleration can be brought to 0 in time
    Signature why;
    bool braking = false;
  };
  /// A ramp from a state to (w, a = 0); where acceleration points away from w it is brought to 0 first.
  struct Approach {
    MotionState from{};     ///< where the ramp begins
    double flare_s = 0;     ///< time until then
    double flare_jerk = 0;  ///< during it
    RampLimits limits{0, 0};
    double virtual_u_s = 0;  ///< speed at which the ramp would have begun with a = 0
    double done_s = 0;       ///< time of it that lies behind
    double end_u = 0;        ///< s at its end
  };

  /// What set_percent() puts back if no other way is found.
  struct Decision {
    Percent percent;
    double scale;
    std::size_t at;
    double in_piece_s;
    MotionState end;
    std::size_t end_place;
  };

  void write_down(double time_s);
  bool decide(bool may_refuse);
  void begin_decision();
  void look_ahead(double fastest_u_s);
  void hold_to_hard_valley(double flared_u_s, double cap_u_s);
  RampLimits limits(std::size_t first, std::size_t last) const;
  Approach approach(double w_u_s) const;
  bool ramp_on(Approach& way, double w_u_s, RampLimits limits) const;
  double reach_u(const Approach& way, double w_u_s) const;
  const Valley* broken(double w_u_s, const std::vector<Valley>& valleys) const;
  bool overruns(double w_u_s);
  void collect_hard();
  bool passed_too_fast(double w_u_s);
  bool braking_fits(double end_u, double w_u_s, const Valley& valley) const;
  static const Valley& following(const Valley& valley);
  double speed_at(double s_u) const;
  double highest(double low_u_s, double high_u_s);
  void track(double w_u_s, double cap_u_s);
  void drop_to(const Valley& valley);
  double hold_end(std::size_t segment, double w_u_s, double until_u) const;

  void emit(const Approach& way, double w_u_s, const Signature& why, bool braking);
  void piece(double duration_s, double jerk, const RampLimits& limits, const Signature& why, bool braking);
  void enter(std::size_t place);

  const FeedTerrain& terrain_;
  double slack_u_;    ///< places that s can't tell apart
  double allowed_u_;  ///< by how much a braking may miss its valley
  Percent percent_, wanted_;
  MotionState state_{};
  std::size_t segment_ = 0;
  RampLimits limits_{0, 0};  ///< under which the present acceleration came about
  MotionLaw* record_ = nullptr;
  double ceiling_u_s_ = machine::kInfinity;
  double scale_ = 1.0;  ///< of accelerations and jerks: proportional mode
  bool ended_ = true, stopping_ = false;

  std::vector<Piece> pieces_;  ///< under way and decided
  std::size_t at_ = 0;
  double in_piece_s_ = 0;
  MotionState end_{};             ///< at the end of the last piece, exact
  std::size_t end_place_ = 0;     ///< place that it lies at, or 0
  std::vector<Piece> kept_;       ///< while another way is looked for
  std::vector<Valley> valleys_;   ///< under the percent
  std::vector<Valley> hard_;      ///< whatever the percent, and
  std::vector<Valley> all_hard_;  ///< with those that any braking passes below
  double fastest_u_s_ = 0;        ///< that the present decision can come to
  std::size_t run_end_joint_ = 0;
  double seen_u_ = 0;  ///< up to here a hold is safe from valleys that were not looked at
};

}  // namespace kadr::planner
