#include "planner/override/feed_tracker.h"

#include <algorithm>
#include <cmath>

#include "machine/base/require.h"
#include "planner/override/motion_step.h"

namespace kadr::planner {
namespace {

using machine::kInfinity;

constexpr int kDecisionsPerTick = 100'000;
constexpr double kSamePlace = 2e-15;  ///< of the path's length: rounding of a ramp's end
/// By how much rounding may carry the motion beyond the end of its run: relative to s, and in axis units.
constexpr double kEndRounding = 1e-12;
constexpr double kEndSlack_u = 1e-9;

}  // namespace

FeedTracker::FeedTracker(const FeedTerrain& terrain)
    : terrain_(terrain),
      slack_u_(kSamePlace * std::max(terrain.path().length_u(), 1.0)),
      allowed_u_(slack_u_) {
  valleys_.reserve(256);
  hard_.reserve(256);
  all_hard_.reserve(256);
}

bool FeedTracker::start(std::size_t segment, const MotionState& state, const Percent& percent,
                        double jerk_u_s3, double ceiling_u_s) {
  wanted_ = percent;
  wanted_.frozen = percent.feed;
  percent_ = wanted_;
  state_ = state;
  segment_ = segment;
  way_.clear();
  limits_ = {std::fabs(state.accel_u_s2), jerk_u_s3};
  ceiling_u_s_ = ceiling_u_s;
  ended_ = stopping_ = false;
  run_end_joint_ = terrain_.run_end(segment) + 1;
  return decide(state.speed_u_s > 0.0);
}

bool FeedTracker::braking() const { return !ended_ && !way_.over() && way_.now().braking; }

Signature FeedTracker::limited_by() const {
  if (ended_ || way_.over()) return {LimitedBy::stop, -1};
  return way_.now().why;
}

void FeedTracker::set_percent(const Percent& percent) {
  wanted_ = percent;
  const bool same = wanted_.feed == percent_.feed && wanted_.rapid == percent_.rapid;
  if (ended_ || same || braking() || locked() || stopping_) return;
  // the current decision keeps every hard cap; it is replaced only by another one that does
  kept_ = way_;
  const Percent percent_before = percent_;
  const double scale_before = scale_;
  if (decide(true)) return;
  way_ = kept_;
  percent_ = percent_before;
  scale_ = scale_before;
}

void FeedTracker::stop_now() {
  if (ended_ || stopping_) return;
  stopping_ = true;
  decide(false);
}

void FeedTracker::advance(double time_s) {
  int decisions = 0;
  while (!ended_) {
    const double left_s = way_.left_s();
    if (record_) write_down(std::min(time_s, left_s));
    if (time_s < left_s) {
      way_.go(time_s);
      state_ = moved(way_.now().begin, way_.in_piece_s());
      segment_ = terrain_.segment_at(state_.s_u, segment_);
      const double end_u = terrain_.path().start_s_u[run_end_joint_];
      if (state_.s_u <= end_u * (1.0 + kEndRounding) + kEndSlack_u) return;
      // multiplying the diagram by an override that changes guarantees nothing: the path ends, and with it the motion
      require(terrain_.proportional(), "the feed tracker stops at the end of its run");
      state_ = {end_u, 0.0, 0.0, 0.0};
      enter(2 * run_end_joint_);
      return;
    }
    time_s -= left_s;
    if (way_.next_piece()) {
      state_ = way_.now().begin;
      segment_ = terrain_.segment_at(state_.s_u, segment_);
      continue;
    }
    // a feed that was limited when it began to brake is not limited after that
    if (!way_.empty() && way_.last().braking) ceiling_u_s_ = kInfinity;
    state_ = way_.end();
    enter(way_.end_place());
    if (ended_) return;
    require(++decisions < kDecisionsPerTick, "the feed tracker gets on");
    decide(false);
  }
}

/// Writes down a part of the piece under way.
void FeedTracker::write_down(double time_s) {
  if (!(time_s > 0.0)) return;
  const FeedPiece& p = way_.now();
  const MotionState x = way_.state();
  record_->pieces.push_back(
      {record_->duration_s, time_s, x.s_u, x.speed_u_s, x.accel_u_s2, x.jerk_u_s3, p.why.reason, p.why.axis});
  record_->duration_s += time_s;
}

/// The state lies at a joint exactly (or anywhere: place 0).
void FeedTracker::enter(std::size_t place) {
  if (place == 0) {
    segment_ = terrain_.segment_at(state_.s_u, segment_);
    return;
  }
  const std::size_t joint = place / 2;
  if (terrain_.hard_cap_u_s(place) == 0.0) {
    segment_ = joint - 1;
    ended_ = true;
    way_.clear();
    state_.speed_u_s = state_.accel_u_s2 = state_.jerk_u_s3 = 0.0;
    return;
  }
  segment_ = joint;
}

}  // namespace kadr::planner
