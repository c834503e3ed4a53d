#include <algorithm>
#include <cmath>

#include "planner/override/feed_tracker.h"
#include "planner/override/motion_step.h"

namespace kadr::planner {
namespace {

using machine::kInfinity;

constexpr int kWayHalvings = 60;           ///< of a speed range: to its last bits
constexpr std::size_t kHoldSegments = 64;  ///< a hold looks at so many segments, then is decided again
constexpr double kHorizons = 8.0;  ///< longest brakings that a decision looks ahead, so that a hold lasts
constexpr double kSnap = 10.0;     ///< slacks by which a ramp that was braked late may miss its valley
constexpr double kSpeedRounding = 1e-12;  ///< relative, of a speed
constexpr double kLookSlack = 1e-9;       ///< of 1 + s: a look ahead goes so far even at no speed

/// An override that no programmed feed resists: what is left are the hard caps.
constexpr Percent kUnlimited{1e100, 1.0, 1e100};
constexpr Signature kByLength{LimitedBy::length, -1};

bool below(double a, double b) { return a < b && !same_speed(a, b); }

/// The valley itself, or the next that is not tight (the last one never is).
const Valley& following(const Valley& valley) {
  const Valley* q = &valley;
  while (q->tight) ++q;
  return *q;
}

}  // namespace

bool FeedTracker::braking_fits(double end_u, double w, const Valley& q) const {
  RampLimits ignored;
  return end_u + terrain_.braking_u(w, q, scale_, ignored) <= q.s_u + allowed_u_;
}

/// The first valley that can't be braked for after a ramp to w.
const Valley* FeedTracker::broken(double w, const std::vector<Valley>& valleys) const {
  const double end_u = approach_to(w).end_u;
  for (const Valley& q : valleys) {
    if (!below(q.cap_u_s, w)) continue;
    // from a valley that is not tight the motion leads from valley to valley
    if (!q.tight) return braking_fits(end_u, w, q) ? nullptr : &q;
    if (terrain_.passes_above(w, end_u, q, following(q), scale_)) return &q;
  }
  return nullptr;
}

/// A ramp to w passes one of all hard valleys faster than its cap.
bool FeedTracker::passed_too_fast(double w) {
  trial_.begin_at(way_.end());
  trial_.add(approach_to(w), w, limits_, {}, false);
  if (trial_.empty()) return false;
  for (const Valley& q : all_hard_) {
    if (q.s_u >= trial_.end().s_u - slack_u_) return false;
    if (trial_.speed_at_u_s(q.s_u) > q.cap_u_s * (1.0 + kSpeedRounding)) return true;
  }
  return false;
}

/// True if ramping to w would violate a hard valley, either by passing it too fast or by leaving too little
/// distance to brake: a long way down may meet lower limits than braking for the valley does.
bool FeedTracker::overruns(double w) {
  collect_hard();
  return passed_too_fast(w) || broken(w, hard_) != nullptr;
}

void FeedTracker::collect_hard() {
  hard_.clear();
  // multiplied, every cap moves with the override: the one under which the speed came about counts
  const Percent multiplied{scale_, std::max(scale_, percent_.rapid), scale_};
  terrain_.valleys(segment_, fastest_u_s_, seen_u_, terrain_.proportional() ? multiplied : kUnlimited, hard_);
  all_hard_ = hard_;
  terrain_.thin_out(hard_, scale_);
}

/// Highest speed of [low, high] that breaks no valley; low is one. Braking for a lower speed can be shorter,
/// so a way to an override's valley must leave one to the hard ones too.
double FeedTracker::highest(double low, double high) {
  const bool guarded =
      !stopping_ && std::any_of(valleys_.begin(), valleys_.end(), [](const Valley& q) { return !q.hard; });
  if (guarded) collect_hard();
  const auto breaks = [&](double w) { return broken(w, valleys_) || (guarded && broken(w, hard_)); };
  if (!breaks(high)) return high;
  allowed_u_ = 0.0;  // rounding errors are left to later decisions on the same ramp
  for (int i = 0; i < kWayHalvings; ++i) {
    const double w = 0.5 * (low + high);
    if (w <= low || w >= high) break;
    (breaks(w) ? high : low) = w;
  }
  allowed_u_ = slack_u_;
  return low;
}

/// Takes the state, and the override unless something makes it wait.
void FeedTracker::begin_decision() {
  if (!way_.over()) limits_ = way_.now().limits;
  // a locked move that starts from rest begins with the override in force
  const bool moves_freely = !terrain_.locked(segment_) || state_.speed_u_s == 0.0;
  if (moves_freely) {
    percent_ = wanted_;
    percent_.frozen = wanted_.feed;
  }
  scale_ = terrain_.limit_scale(percent_, segment_, state_.speed_u_s);
  if (state_.accel_u_s2 == 0.0 || !(limits_.jerk_u_s3 < kInfinity)) {
    state_.accel_u_s2 = 0.0;
    limits_ = limits(segment_, segment_);
  }
  way_.begin_at(state_);
}

/// Valleys that can matter: none lies farther ahead than the longest braking from the fastest speed.
void FeedTracker::look_ahead(double fastest) {
  fastest_u_s_ = fastest;
  valleys_.clear();
  seen_u_ = kInfinity;
  if (stopping_) return;
  const RampLimits weakest = limits(segment_, terrain_.run_end(segment_));
  const double flare_s =
      limits_.jerk_u_s3 < kInfinity ? std::fabs(state_.accel_u_s2) / limits_.jerk_u_s3 : 0.0;
  const double longest =
      fastest * (flare_s + 2.0 * ramp_time_s(fastest, weakest)) + kLookSlack * (1.0 + state_.s_u);
  if (terrain_.valleys(segment_, fastest, state_.s_u + kHorizons * longest, percent_, valleys_))
    seen_u_ = state_.s_u + (kHorizons - 1.0) * longest;
  terrain_.thin_out(valleys_, scale_);
}

/// @return false: another ramp would overrun a hard valley, nothing was decided
bool FeedTracker::decide(bool may_refuse) {
  begin_decision();
  const double cap = stopping_ ? 0.0 : std::min(terrain_.cap_u_s(2 * segment_ + 1, percent_), ceiling_u_s_);
  const double v = state_.speed_u_s, a = state_.accel_u_s2;
  const double flared = a == 0.0 ? v : v + 0.5 * a * std::fabs(a) / limits_.jerk_u_s3;
  look_ahead(std::max({cap, flared, v}));

  const auto is_late = [&] { return broken(cap, valleys_) && (flared > cap || broken(flared, valleys_)); };
  bool late = is_late();
  if (late && scale_ < 1.0) {  // multiplied by a low override the brakes are weak: they need not be
    scale_ = 1.0;
    late = is_late();
  }
  double w = cap;
  const Valley* towards = nullptr;
  if (late) {  // the override fell too late for a place ahead: towards it at once
    towards = &following(*broken(std::min(flared, cap), valleys_));
    w = towards->cap_u_s;
  } else if (flared <= cap) {
    w = highest(flared, cap);
  }
  if ((late || w < std::max(v, flared)) && !stopping_ && overruns(w)) {
    if (may_refuse) return false;
    hold_to_hard_valley(flared, cap);
  } else if (towards) {
    drop_to(*towards);
  } else {
    track(w, cap);
  }
  return true;
}

/// The requested override is not feasible yet: keep the current feed up to the next hard valley.
void FeedTracker::hold_to_hard_valley(double flared, double cap) {
  scale_ = std::max(scale_, 1.0);
  collect_hard();
  valleys_ = hard_;
  const Valley* q = broken(flared, valleys_);
  q ? drop_to(following(*q)) : track(flared, cap);
}

/// Ramp to w and hold it to the next valley's braking, or to where the cap rises.
void FeedTracker::track(double w, double cap) {
  const Approach ramp = approach_to(w);
  const Signature reason =
      stopping_ ? Signature{LimitedBy::hold, -1} : terrain_.cap_reason(segment_, percent_);
  way_.add(ramp, w, limits_, w < state_.speed_u_s && w == cap ? reason : kByLength, false);
  if (w == 0.0 && rests_behind(w, cap, ramp.limits)) return;
  if (!(w > 0.0) && !valleys_.empty())  // nearer to the next stop than a speed can tell
    return way_.end_at(valleys_.front().s_u, valleys_.front().place);
  hold_and_brake(w, std::max(way_.end().s_u, ramp.end_u), ramp.limits, w == cap ? reason : kByLength);
}

/// A ramp to 0 ends the run, or the override is 0 and it rests there.
bool FeedTracker::rests_behind(double w, double cap, const RampLimits& limits) {
  const double run_end_u = terrain_.path().start_s_u[run_end_joint_];
  if (way_.end().s_u >= run_end_u - slack_u_) {
    way_.end_at(run_end_u, 2 * run_end_joint_);
    return true;
  }
  if (cap == w) way_.add(FeedWay::kForever_s, 0.0, limits, {LimitedBy::hold, -1}, false);
  return cap == w;
}

/// Holds w from the way's end to the first braking, and brakes; or to where the cap rises.
/// @param now_u  where braking can begin at the earliest
void FeedTracker::hold_and_brake(double w, double now_u, const RampLimits& limits, const Signature& why) {
  const auto next = std::find_if(valleys_.begin(), valleys_.end(),
                                 [&](const Valley& q) { return below(q.cap_u_s, w) && !q.tight; });
  const bool brakes = next != valleys_.end();
  RampLimits brake_limits{0, 0};
  const double brake_u = brakes ? next->s_u - terrain_.braking_u(w, *next, scale_, brake_limits) : kInfinity;
  const double end_u = way_.end().s_u;
  const std::size_t here = terrain_.segment_at(end_u, segment_);
  const double rise_u = std::max(hold_end(here, w, std::min(brake_u, seen_u_)), end_u);
  const double until_u = std::min(std::max(brake_u, now_u), rise_u);
  if (until_u > end_u && w > 0.0) way_.add((until_u - end_u) / w, 0.0, limits, why, false);
  way_.end_at(std::max(until_u, end_u), 0);
  if (rise_u < brake_u || !brakes) {
    // a joint: identified by its position
    const double s = way_.end().s_u;
    const std::size_t after = terrain_.segment_at(s, here);
    return way_.end_at(s, terrain_.path().start_s_u[after] == s && after > here ? 2 * after : 0);
  }
  const Signature held_by = terrain_.signature(next->place);
  Approach brake;
  brake.from = way_.end();
  brake.limits = brake_limits;
  brake.virtual_u_s = w;
  way_.add(brake, next->cap_u_s, limits_, held_by.reason == LimitedBy::junction ? held_by : kByLength, true);
  way_.end_at(next->s_u, next->place);
}

void FeedTracker::drop_to(const Valley& q) {
  way_.add(approach_to(q.cap_u_s), q.cap_u_s, limits_, kByLength, q.hard);
  if (std::fabs(way_.end().s_u - q.s_u) <= kSnap * slack_u_) way_.end_at(q.s_u, q.place);
}

/// Where a hold at w ends because more is allowed, or because a lock begins or ends.
double FeedTracker::hold_end(std::size_t segment, double w, double until_u) const {
  const std::size_t most = terrain_.run_end(segment);
  const std::size_t last = std::min(segment + kHoldSegments, most);
  // the ramp has left the segment that it was decided on
  if (segment > segment_ && terrain_.cap_u_s(2 * segment + 1, percent_) > w * (1.0 + kSpeedRounding))
    return way_.end().s_u;
  for (std::size_t i = segment + 1; i <= last; ++i) {
    const double s = terrain_.path().start_s_u[i];
    if (s >= until_u) return until_u;
    if (terrain_.locked(i) != terrain_.locked(segment)) return s;
    if (terrain_.cap_u_s(2 * i + 1, percent_) > w * (1.0 + kSpeedRounding)) return s;
  }
  return last < most ? std::min(terrain_.path().start_s_u[last + 1], until_u) : until_u;
}

}  // namespace kadr::planner
