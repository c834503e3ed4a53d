#include "planner/override/feed_tracker.h"

#include <algorithm>
#include <cmath>

#include "machine/base/require.h"
#include "planner/override/motion_step.h"

namespace kadr::planner {
namespace {

using machine::kInfinity;

constexpr int kBisections = 60;
constexpr int kTrackRounds = 12;
constexpr int kDecisionsPerTick = 100'000;
constexpr std::size_t kHoldSegments = 64;  ///< a hold looks at so many segments, then is decided anew
constexpr double kHorizons = 8.0;     ///< longest brakings that a decision looks ahead, so that a hold lasts
constexpr double kSamePlace = 2e-15;  ///< of the path's length: rounding of a ramp's end
constexpr double kSnap = 10.0;        ///< slacks by which a ramp that was braked late may miss its valley
constexpr double kSpeedRounding = 1e-12;  ///< relative, of a speed
constexpr double kForever_s = 1e300;

/// A percent that no programmed feed resists: what is left are the hard caps.
constexpr Percent kUnlimited{1e100, 1.0, 1e100};

bool below(double a, double b) { return a < b && !same_speed(a, b); }

}  // namespace

FeedTracker::FeedTracker(const FeedTerrain& terrain)
    : terrain_(terrain),
      slack_u_(kSamePlace * std::max(terrain.path().length_u(), 1.0)),
      allowed_u_(slack_u_) {
  pieces_.reserve(16);
  valleys_.reserve(256);
  hard_.reserve(256);
  all_hard_.reserve(256);
  kept_.reserve(16);
}

bool FeedTracker::start(std::size_t segment, const MotionState& state, const Percent& percent,
                        double jerk_u_s3, double ceiling_u_s) {
  wanted_ = percent;
  wanted_.frozen = percent.feed;
  percent_ = wanted_;
  state_ = state;
  segment_ = segment;
  pieces_.clear();
  limits_ = {std::fabs(state.accel_u_s2), jerk_u_s3};
  ceiling_u_s_ = ceiling_u_s;
  ended_ = stopping_ = false;
  run_end_joint_ = terrain_.run_end(segment) + 1;
  return decide(state.speed_u_s > 0.0);
}

RampLimits FeedTracker::limits(std::size_t first, std::size_t last) const {
  const RampLimits l = terrain_.limits(first, last);
  return {l.accel_u_s2 * scale_, l.jerk_u_s3 * scale_};
}

bool FeedTracker::braking() const { return !ended_ && at_ < pieces_.size() && pieces_[at_].braking; }

Signature FeedTracker::limited_by() const {
  if (ended_ || at_ >= pieces_.size()) return {LimitedBy::stop, -1};
  return pieces_[at_].why;
}

void FeedTracker::set_percent(const Percent& percent) {
  wanted_ = percent;
  const bool same = wanted_.feed == percent_.feed && wanted_.rapid == percent_.rapid;
  if (ended_ || same || braking() || locked() || stopping_) return;
  // the way that was decided keeps every hard cap; it is left only for another one that does
  kept_.assign(pieces_.begin(), pieces_.end());
  const Decision before = {percent_, scale_, at_, in_piece_s_, end_, end_place_};
  if (decide(true)) return;
  pieces_.assign(kept_.begin(), kept_.end());
  percent_ = before.percent;
  scale_ = before.scale;
  at_ = before.at;
  in_piece_s_ = before.in_piece_s;
  end_ = before.end;
  end_place_ = before.end_place;
}

void FeedTracker::stop_now() {
  if (ended_ || stopping_) return;
  stopping_ = true;
  decide(false);
}

void FeedTracker::advance(double time_s) {
  int decisions = 0;
  while (!ended_) {
    const double left_s = pieces_[at_].duration_s - in_piece_s_;
    if (record_) write_down(std::min(time_s, left_s));
    if (time_s < left_s) {
      in_piece_s_ += time_s;
      state_ = moved(pieces_[at_].begin, in_piece_s_);
      segment_ = terrain_.segment_at(state_.s_u, segment_);
      const double end_u = terrain_.path().start_s_u[run_end_joint_];
      if (state_.s_u <= end_u * (1.0 + 1e-12) + 1e-9) return;
      // multiplying the diagram by a percent that moves gives no promise: the path ends, and with it the
      // motion
      require(terrain_.proportional(), "the feed tracker stops at the end of its run");
      state_ = {end_u, 0.0, 0.0, 0.0};
      enter(2 * run_end_joint_);
      return;
    }
    time_s -= left_s;
    in_piece_s_ = 0;
    if (++at_ < pieces_.size()) {
      state_ = pieces_[at_].begin;
      segment_ = terrain_.segment_at(state_.s_u, segment_);
      continue;
    }
    // a feed that was limited when it began to brake is not limited behind that
    if (!pieces_.empty() && pieces_.back().braking) ceiling_u_s_ = kInfinity;
    state_ = end_;
    enter(end_place_);
    if (ended_) return;
    require(++decisions < kDecisionsPerTick, "the feed tracker gets on");
    decide(false);
  }
}

/// Writes down a part of the piece under way.
void FeedTracker::write_down(double time_s) {
  if (!(time_s > 0.0)) return;
  const Piece& p = pieces_[at_];
  const MotionState x = in_piece_s_ > 0.0 ? moved(p.begin, in_piece_s_) : p.begin;
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
    pieces_.clear();
    at_ = 0;
    state_.speed_u_s = state_.accel_u_s2 = state_.jerk_u_s3 = 0.0;
    return;
  }
  segment_ = joint;
}

// --- the decision

/// The ramp under given limits, if the present acceleration fits into it.
bool FeedTracker::ramp_on(Approach& way, double w, RampLimits limits) const {
  const double a = way.from.accel_u_s2;
  const double v = way.from.speed_u_s;
  way.limits = limits;
  way.virtual_u_s = v;
  way.done_s = 0.0;
  if (a == 0.0) return true;
  const double turn = a * a / (2.0 * limits.jerk_u_s3);
  way.virtual_u_s = a > 0.0 ? v - turn : v + turn;
  way.done_s = std::fabs(a) / limits.jerk_u_s3;
  return std::fabs(a) <= limits.accel_u_s2 && (a > 0.0 ? v + turn <= w : v - turn >= w);
}

double FeedTracker::reach_u(const Approach& way, double w) const {
  const double low = std::min(way.virtual_u_s, w), high = std::max(way.virtual_u_s, w);
  const double t = way.done_s;
  const double jerk = way.from.accel_u_s2 > 0.0 ? way.limits.jerk_u_s3 : -way.limits.jerk_u_s3;
  const double behind = t > 0.0 ? t * (way.virtual_u_s + t * t * jerk / 6.0) : 0.0;
  return way.from.s_u + ramp_length_u(low, high, way.limits) - behind;
}

FeedTracker::Approach FeedTracker::approach(double w) const {
  Approach way;
  way.from = state_;
  way.from.jerk_u_s3 = 0.0;
  if (!(limits_.jerk_u_s3 < kInfinity)) way.from.accel_u_s2 = 0.0;
  for (bool flared = false;; flared = true) {
    std::size_t covered = terrain_.segment_at(way.from.s_u, segment_);
    const std::size_t first = covered;
    const std::size_t most = terrain_.run_end(segment_);
    bool fits = ramp_on(way, w, limits(first, covered));
    for (int i = 0; fits && i < kTrackRounds; ++i) {
      way.end_u = reach_u(way, w);
      if (way.done_s == 0.0 && same_speed(way.from.speed_u_s, w)) way.end_u = way.from.s_u;
      // an end that rounding takes over a joint is on it
      const double inside_u = way.end_u - slack_u_;
      const std::size_t end = std::min(terrain_.segment_at(inside_u, covered), most);
      if (end == covered) return way;
      covered = i + 2 == kTrackRounds ? most : end;
      fits = ramp_on(way, w, limits(first, covered));
    }
    if (fits) return way;
    require(!flared, "a ramp from acceleration 0 fits");
    // the acceleration leads away from w, or is more than the way ahead allows: to 0 under the limits it has
    const double a = way.from.accel_u_s2;
    way.flare_jerk = a > 0.0 ? -limits_.jerk_u_s3 : limits_.jerk_u_s3;
    way.flare_s = std::fabs(a) / limits_.jerk_u_s3;
    way.from.jerk_u_s3 = way.flare_jerk;
    way.from = moved(way.from, way.flare_s);
    way.from.accel_u_s2 = way.from.jerk_u_s3 = 0.0;
  }
}

bool FeedTracker::braking_fits(double end_u, double w, const Valley& q) const {
  RampLimits ignored;
  return end_u + terrain_.braking_u(w, q, scale_, ignored) <= q.s_u + allowed_u_;
}

/// The valley itself, or the next that is not tight (the last one never is).
const Valley& FeedTracker::following(const Valley& valley) {
  const Valley* q = &valley;
  while (q->tight) ++q;
  return *q;
}

/// Speed of the emitted pieces at a place that they pass.
double FeedTracker::speed_at(double s_u) const {
  std::size_t k = 0;
  while (k + 1 < pieces_.size() && pieces_[k + 1].begin.s_u <= s_u) ++k;
  double low = 0.0, high = pieces_[k].duration_s;
  for (int i = 0; i < kBisections; ++i) {
    const double mid = 0.5 * (low + high);
    (moved(pieces_[k].begin, mid).s_u < s_u ? low : high) = mid;
  }
  return moved(pieces_[k].begin, low).speed_u_s;
}

/// The first valley that can't be braked for after a ramp to w.
const Valley* FeedTracker::broken(double w, const std::vector<Valley>& valleys) const {
  const double end_u = approach(w).end_u;
  for (const Valley& q : valleys) {
    if (!below(q.cap_u_s, w)) continue;
    // from a valley that is not tight the way leads from valley to valley
    if (!q.tight) return braking_fits(end_u, w, q) ? nullptr : &q;
    if (terrain_.passes_above(w, end_u, q, following(q), scale_)) return &q;
  }
  return nullptr;
}

/// A ramp to w passes one of the hard valleys faster than its cap.
bool FeedTracker::passed_too_fast(double w) {
  const MotionState end = end_;
  emit(approach(w), w, {}, false);
  bool found = false;
  for (const Valley& q : hard_) {
    if (found || pieces_.empty() || q.s_u >= end_.s_u - slack_u_) break;
    found = speed_at(q.s_u) > q.cap_u_s * (1.0 + kSpeedRounding);
  }
  pieces_.clear();
  end_ = end;
  return found;
}

/// A ramp to w passes a hard valley too fast, or leaves no room for one: a long way down may meet lower
/// limits than braking for the valley does.
bool FeedTracker::overruns(double w) {
  collect_hard();
  hard_.swap(all_hard_);
  const bool passes = passed_too_fast(w);
  hard_.swap(all_hard_);
  return passes || broken(w, hard_) != nullptr;
}

void FeedTracker::collect_hard() {
  hard_.clear();
  // multiplied, every cap moves with the percent: the one under which the speed came about is what counts
  const Percent multiplied{scale_, std::max(scale_, percent_.rapid), scale_};
  terrain_.valleys(segment_, fastest_u_s_, seen_u_, terrain_.proportional() ? multiplied : kUnlimited, hard_);
  all_hard_ = hard_;
  terrain_.thin_out(hard_, scale_);
}

/// Highest speed of [low, high] that breaks no valley; low is one. Braking for a lower speed can be shorter,
/// so a way to a percent's valley must leave one to the hard ones too.
double FeedTracker::highest(double low, double high) {
  const bool guarded =
      !stopping_ && std::any_of(valleys_.begin(), valleys_.end(), [](const Valley& q) { return !q.hard; });
  if (guarded) collect_hard();
  const auto breaks = [&](double w) { return broken(w, valleys_) || (guarded && broken(w, hard_)); };
  if (!breaks(high)) return high;
  allowed_u_ = 0.0;  // what rounding takes is left to later decisions on the same way
  for (int i = 0; i < kBisections; ++i) {
    const double w = 0.5 * (low + high);
    if (w <= low || w >= high) break;
    (breaks(w) ? high : low) = w;
  }
  allowed_u_ = slack_u_;
  return low;
}

/// Takes the state, and the percent where nothing makes it wait.
void FeedTracker::begin_decision() {
  if (at_ < pieces_.size()) limits_ = pieces_[at_].limits;
  pieces_.clear();
  at_ = 0;
  in_piece_s_ = 0.0;
  end_place_ = 0;
  // a locked move that stands begins with the percent that it finds
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
  end_ = state_;
  end_.jerk_u_s3 = 0.0;
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
      fastest * (flare_s + 2.0 * ramp_time_s(fastest, weakest)) + 1e-9 * (1.0 + state_.s_u);
  if (terrain_.valleys(segment_, fastest, state_.s_u + kHorizons * longest, percent_, valleys_))
    seen_u_ = state_.s_u + (kHorizons - 1.0) * longest;
  terrain_.thin_out(valleys_, scale_);
}

/// @return false: another way would overrun a hard valley, nothing was decided
bool FeedTracker::decide(bool may_refuse) {
  begin_decision();
  const double cap = stopping_ ? 0.0 : std::min(terrain_.cap_u_s(2 * segment_ + 1, percent_), ceiling_u_s_);
  const double v = state_.speed_u_s, a = state_.accel_u_s2;
  const double flared = a == 0.0 ? v : v + 0.5 * a * std::fabs(a) / limits_.jerk_u_s3;
  look_ahead(std::max({cap, flared, v}));

  const auto is_late = [&] { return broken(cap, valleys_) && (flared > cap || broken(flared, valleys_)); };
  bool late = is_late();
  if (late && scale_ < 1.0) {  // multiplied by a low percent the brakes are weak: they need not be
    scale_ = 1.0;
    late = is_late();
  }
  double w = cap;
  const Valley* towards = nullptr;
  if (late) {  // a percent fell too late for a place ahead: towards it at once
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

/// The percent can't be followed yet: what there is, to the hard valley ahead.
void FeedTracker::hold_to_hard_valley(double flared, double cap) {
  scale_ = std::max(scale_, 1.0);
  collect_hard();
  valleys_ = hard_;
  const Valley* q = broken(flared, valleys_);
  q ? drop_to(following(*q)) : track(flared, cap);
}

/// Ramp to w and hold it to the next valley's braking, or to where the cap rises.
void FeedTracker::track(double w, double cap) {
  const Approach way = approach(w);
  const Signature reason =
      stopping_ ? Signature{LimitedBy::hold, -1} : terrain_.cap_reason(segment_, percent_);
  emit(way, w, w < state_.speed_u_s && w == cap ? reason : Signature{LimitedBy::length, -1}, false);
  const double run_end_u = terrain_.path().start_s_u[run_end_joint_];
  if (w == 0.0 && end_.s_u >= run_end_u - slack_u_) {
    end_.s_u = run_end_u;
    end_place_ = 2 * run_end_joint_;
    return;
  }
  if (w == 0.0 && cap == 0.0) {  // the percent is 0: rest in place
    piece(kForever_s, 0.0, way.limits, {LimitedBy::hold, -1}, false);
    return;
  }
  if (!(w > 0.0) && !valleys_.empty()) {  // nearer to the next stop than a speed can tell
    end_.s_u = valleys_.front().s_u;
    end_place_ = valleys_.front().place;
    return;
  }
  const Valley* next = nullptr;
  double brake_u = kInfinity;
  RampLimits limits{0, 0};
  for (const Valley& q : valleys_) {
    if (!below(q.cap_u_s, w) || q.tight) continue;
    next = &q;
    brake_u = q.s_u - terrain_.braking_u(w, q, scale_, limits);
    break;
  }
  const double now = std::max(end_.s_u, way.end_u);
  const std::size_t here = terrain_.segment_at(end_.s_u, segment_);
  const double rise_u = std::max(hold_end(here, w, std::min(brake_u, seen_u_)), end_.s_u);
  const double until = std::min(std::max(brake_u, now), rise_u);
  if (until > end_.s_u && w > 0.0)
    piece((until - end_.s_u) / w, 0.0, way.limits, w == cap ? reason : Signature{LimitedBy::length, -1},
          false);
  end_.s_u = std::max(until, end_.s_u);
  if (rise_u < brake_u || !next) {
    // a joint: which one is found by its place
    const std::size_t after = terrain_.segment_at(end_.s_u, here);
    end_place_ = terrain_.path().start_s_u[after] == end_.s_u && after > here ? 2 * after : 0;
    return;
  }
  Signature why = terrain_.signature(next->place);
  if (why.reason != LimitedBy::junction) why = {LimitedBy::length, -1};
  Approach brake;
  brake.from = end_;
  brake.limits = limits;
  brake.virtual_u_s = w;
  emit(brake, next->cap_u_s, why, true);
  end_.s_u = next->s_u;
  end_place_ = next->place;
}

void FeedTracker::drop_to(const Valley& q) {
  emit(approach(q.cap_u_s), q.cap_u_s, {LimitedBy::length, -1}, q.hard);
  if (std::fabs(end_.s_u - q.s_u) > kSnap * slack_u_) return;
  end_.s_u = q.s_u;
  end_place_ = q.place;
}

/// Where a hold at w ends because more is allowed, or because a lock begins or ends.
double FeedTracker::hold_end(std::size_t segment, double w, double until_u) const {
  const std::size_t most = terrain_.run_end(segment);
  const std::size_t last = std::min(segment + kHoldSegments, most);
  // the ramp has left the segment that it was decided on
  if (segment > segment_ && terrain_.cap_u_s(2 * segment + 1, percent_) > w * (1.0 + 1e-12)) return end_.s_u;
  for (std::size_t i = segment + 1; i <= last; ++i) {
    const double s = terrain_.path().start_s_u[i];
    if (s >= until_u) return until_u;
    if (terrain_.locked(i) != terrain_.locked(segment)) return s;
    if (terrain_.cap_u_s(2 * i + 1, percent_) > w * (1.0 + 1e-12)) return s;
  }
  return last < most ? std::min(terrain_.path().start_s_u[last + 1], until_u) : until_u;
}

// --- pieces

void FeedTracker::piece(double duration_s, double jerk, const RampLimits& limits, const Signature& why,
                        bool braking) {
  if (!(duration_s > 0.0)) return;
  end_.jerk_u_s3 = jerk;
  pieces_.push_back({duration_s, end_, limits, why, braking});
  if (duration_s < kForever_s) end_ = moved(end_, duration_s);
}

void FeedTracker::emit(const Approach& way, double w, const Signature& why, bool braking) {
  if (way.flare_s > 0.0) {
    piece(way.flare_s, way.flare_jerk, limits_, {LimitedBy::length, -1}, braking);
    end_.speed_u_s = way.from.speed_u_s;
    end_.s_u = way.from.s_u;
    end_.accel_u_s2 = end_.jerk_u_s3 = 0.0;
  }
  const double dv = std::fabs(w - way.virtual_u_s);
  const double sign = w >= way.virtual_u_s ? 1.0 : -1.0;
  const double A = way.limits.accel_u_s2, J = way.limits.jerk_u_s3;
  if (way.done_s == 0.0 && same_speed(way.virtual_u_s, w)) {
    // nothing to do but what rounding leaves
  } else if (!(J < kInfinity)) {
    end_.accel_u_s2 = sign * A;
    piece(dv / A, 0.0, way.limits, why, braking);
  } else {
    const bool full = dv * J > A * A;
    const double t = full ? A / J : std::sqrt(dv / J);
    piece(t - way.done_s, sign * J, way.limits, why, braking);
    if (full) piece(dv / A - A / J, 0.0, way.limits, why, braking);
    piece(std::fabs(end_.accel_u_s2) / J, -sign * J, way.limits, why, braking);
  }
  end_.speed_u_s = w;
  end_.accel_u_s2 = end_.jerk_u_s3 = 0.0;
}

}  // namespace kadr::planner
