#include "planner/override/override_source.h"

#include <algorithm>
#include <cmath>

#include "machine/base/require.h"
#include "machine/machine.h"
#include "planner/laws/tick_shape.h"

namespace kadr::planner {
namespace {

constexpr double kSameTime_s = 1e-9;  ///< the law is at a position of its own up to rounding

PathLimitTable caps_of(const Joints& joints, const FeedPlan& plan, const machine::MachineModel& machine,
                       double most_percent) {
  using machine::OverrideMode;
  const OverrideMode mode = machine.feed_override.mode;
  auto table = limit_table(joints, machine, mode == OverrideMode::corrected_plus ? most_percent : 1.0);
  require(table.has_value(), "a path that was planned has limits");
  // a time law's own speeds are never exceeded. Eq. 7 and 8 by the letter: with F_HK and F_KK of blocks that
  // end without acceleration; ramps that run over many blocks have no such numbers, there F
  // itself is what is never exceeded
  const bool time_law = machine::facts(machine.planner.method).is_law;
  const bool by_block =
      mode == OverrideMode::corrected && machine.planner.scheduler == machine::SchedulerKind::blockwise;
  if (!time_law && !by_block) return std::move(*table);
  // nor do the ramps that follow them keep a jerk that they do not
  if (!machine.planner.keeps_jerk())
    std::fill(table->jerk_u_s3.begin(), table->jerk_u_s3.end(), machine::kInfinity);
  for (std::size_t i = 0; i < joints.path().size(); ++i) {
    double& peak = table->cap_u_s[2 * i + 1];
    peak = std::min(peak, plan.segments[i].peak_u_s);
    double& end = table->cap_u_s[2 * i + 2];
    end = std::min(end, plan.segments[i].end_u_s);
  }
  return std::move(*table);
}

bool brakes(const MotionState& x) { return x.accel_u_s2 < 0.0 || (x.accel_u_s2 == 0.0 && x.jerk_u_s3 < 0.0); }

/// A speed and its acceleration after a time on the shortest way to another speed.
MotionState towards(MotionState x, double wanted_u_s, RampLimits l, double time_s) {
  constexpr int kParts = 16;  // of a tick, each of constant jerk
  const double dt = time_s / kParts;
  for (int i = 0; i < kParts; ++i) {
    const double left = wanted_u_s - x.speed_u_s;
    if (!(l.jerk_u_s3 < machine::kInfinity)) {
      const double step = std::clamp(left, -l.accel_u_s2 * dt, l.accel_u_s2 * dt);
      x.speed_u_s += step;
      continue;
    }
    // the highest acceleration from which the jerk still brings it to 0 in time
    const double best = std::sqrt(2.0 * l.jerk_u_s3 * std::fabs(left));
    const double a = std::copysign(std::min({best, l.accel_u_s2, std::fabs(left) / dt}), left);
    const double change = std::clamp(a - x.accel_u_s2, -l.jerk_u_s3 * dt, l.jerk_u_s3 * dt);
    x.speed_u_s += dt * (x.accel_u_s2 + 0.5 * change);
    x.accel_u_s2 += change;
    // towards rest the parts may overshoot: there it stays
    if (x.speed_u_s < 0.0) x.speed_u_s = x.accel_u_s2 = 0.0;
  }
  return x;
}

}  // namespace

OverrideSource::OverrideSource(const Path& path, const FeedPlan& plan, const machine::MachineModel& machine,
                               double most_percent)
    : path_(path),
      joints_(machine_joints(path, machine)),
      plan_(plan),
      machine_(machine),
      terrain_(path, machine, caps_of(*joints_, plan, machine, most_percent)),
      law_(plan.law, machine),
      tracker_(terrain_),
      probe_(terrain_),
      tangent_(machine.axis.size()),
      rapids_(machine) {
  if (!plan.positioned.empty()) slow_rapid_.pieces.reserve(PointLaw::kMostEdges);
}

bool OverrideSource::finished() const { return !tracking_ && !slow_source_ && law_.finished(); }

/// A pause, or the end: nothing that an override would change.
bool OverrideSource::law_rests() const {
  const JerkPiece& piece = plan_.law.pieces[law_.piece()];
  return piece.speed_u_s == 0.0 && piece.accel_u_s2 == 0.0 && piece.jerk_u_s3 == 0.0;
}

bool OverrideSource::leave_law(const LawSource& source, const MotionLaw& law, const Percent& percent) {
  const MotionState x = source.state();
  double jerk = terrain_.limits(segment_, segment_).jerk_u_s3;
  // the ramp under way ends with the jerk of its last piece; a time law has no ramps
  const bool ramps = x.accel_u_s2 != 0.0 && !machine::facts(machine_.planner.method).is_law;
  for (std::size_t k = source.piece(); ramps && k < law.pieces.size(); ++k) {
    const double j = law.pieces[k].jerk_u_s3;
    if (j * x.accel_u_s2 < 0.0) {
      jerk = std::fabs(j);
      break;
    }
  }
  return tracker_.start(segment_, x, percent, jerk);
}

void OverrideSource::return_to_law(std::size_t segment) {
  law_.seek(plan_.segments[segment].end_time_s, s_u_, tick_);
  segment_ = terrain_.segment_at(s_u_, segment);
  tracking_ = false;
}

const PositionedSegment* OverrideSource::rapid_of_law() {
  const double now_s = law_.time_s() + kSameTime_s;
  const std::vector<PositionedSegment>& all = plan_.positioned;
  while (next_rapid_ < all.size() && plan_.segments[all[next_rapid_].segment].end_time_s <= now_s)
    ++next_rapid_;
  if (next_rapid_ == all.size() || plan_.segments[all[next_rapid_].segment].begin_time_s > now_s)
    return nullptr;
  return &all[next_rapid_];
}

void OverrideSource::begin_slow_rapid(std::size_t segment, double ratio) {
  const RampLimits limits = terrain_.limits(segment, segment);
  const double speed = terrain_.hard_cap_u_s(2 * segment + 1) * ratio;
  const Positioning rapid = rapids_.plan(path_, segment, speed, limits.accel_u_s2, limits.jerk_u_s3);
  slow_rapid_.pieces.clear();
  append_pieces(rapid.law, path_.start_s_u[segment], {LimitedBy::override_percent, -1}, slow_rapid_.pieces);
  slow_rapid_.duration_s = rapid.law.duration_s();
  slow_rapid_.length_u = path_.start_s_u[segment + 1];
  slow_source_.emplace(slow_rapid_, machine_);
  slow_ratio_ = ratio;
  segment_ = segment;
}

bool OverrideSource::advance_rapid(TickMotion& m, const OperatorInput& input, const Percent& percent) {
  bool waits = false;
  if (!slow_source_) {
    const PositionedSegment* rapid = law_.finished() ? nullptr : rapid_of_law();
    if (!rapid || input.emergency_stop) return false;
    const double begin_s = plan_.segments[rapid->segment].begin_time_s;
    const bool begins = std::fabs(law_.time_s() - begin_s) <= kSameTime_s;
    if (begins && percent.rapid == 0.0) {  // it stays where it is
      m.s_begin_u = m.s_end_u = s_u_;
      m.limited_by = LimitedBy::hold;
      m.override_used = percent.feed;
      finish_tick(m);
      law_.seek(begin_s, s_u_, tick_);
      return true;
    }
    if (!begins && input.hold) return false;
    if (begins && percent.rapid < 1.0) begin_slow_rapid(rapid->segment, percent.rapid);
    waits = !begins && percent.rapid != 1.0;
  } else if (input.emergency_stop || (input.hold && !brakes(slow_source_->state()))) {
    tracking_ = leave_law(*slow_source_, slow_rapid_, input.emergency_stop ? Percent{} : percent) ||
                input.emergency_stop;
    if (tracking_) {
      slow_source_.reset();
      return false;
    }
    waits = true;
  } else {
    waits = percent.rapid != slow_ratio_;
  }
  const ControlTicks tick = m.tick;
  m = slow_source_ ? slow_source_->advance(input) : law_.advance(input);
  m.tick = tick;
  m.override_requested = m.override_used = percent.feed;
  if (waits) m.note = OverrideNote::deferred;
  s_u_ = m.s_end_u;
  speed_u_s_ = m.speed_end_u_s;
  if (slow_source_ && slow_source_->finished()) {
    slow_source_.reset();
    return_to_law(segment_);
  } else {
    segment_ = terrain_.segment_at(s_u_, segment_);
  }
  return true;
}

TickMotion OverrideSource::advance(const OperatorInput& input) {
  Percent percent{input.hold ? 0.0 : input.feed_override, input.hold ? 0.0 : input.rapid_override, 1.0};
  percent.frozen = percent.feed;
  const bool plain = percent.feed == 1.0 && percent.rapid == 1.0;
  OverrideNote note = OverrideNote::none;
  if (!tracking_ && !plan_.positioned.empty()) {
    TickMotion m;
    m.tick = tick_;
    m.override_requested = percent.feed;
    ++tick_;
    if (advance_rapid(m, input, percent)) return m;
    tick_ = m.tick;
  }
  if (!tracking_ && !law_.finished() && (!plain || input.emergency_stop)) {
    if (!law_rests()) {
      const bool moving = law_.state().speed_u_s > 0.0;
      if (input.emergency_stop) {
        leave_law(law_, plan_.law, Percent{});  // whatever it was doing: it stops at once
        tracking_ = true;
      } else if (moving && terrain_.locked(segment_)) {
        note = OverrideNote::locked;
      } else {
        tracking_ = !(moving && brakes(law_.state())) && leave_law(law_, plan_.law, percent);
        if (!tracking_) note = OverrideNote::deferred;
      }
    } else if (input.emergency_stop) {
      stopped_ = true;
    }
  }
  TickMotion m;
  if (!tracking_) {
    m = law_.advance(input);
    m.override_requested = percent.feed;
    m.note = note;
    s_u_ = m.s_end_u;
    speed_u_s_ = m.speed_end_u_s;
    segment_ = terrain_.segment_at(s_u_, segment_);
    ++tick_;
    return m;
  }
  m.tick = tick_;
  ++tick_;
  advance_tracker(m, percent, input.emergency_stop);
  return m;
}

void OverrideSource::advance_tracker(TickMotion& m, const Percent& percent, bool emergency) {
  m.s_begin_u = s_u_;
  m.speed_begin_u_s = speed_u_s_;
  m.override_requested = percent.feed;
  if (emergency) {
    if (limited_) take_back(percent);
    tracker_.stop_now();
  }
  const bool limits = machine_.feed_override.limiter != machine::LimiterKind::off && !emergency;
  if (limits && advance_limited(m, percent)) return;
  tracker_.set_percent(percent);
  const bool waits = !(tracker_.percent().feed == percent.feed && tracker_.percent().rapid == percent.rapid);
  if (waits) m.note = tracker_.locked() ? OverrideNote::locked : OverrideNote::deferred;
  tracker_.advance(machine_.clock.tau_s());
  const MotionState& x = tracker_.state();
  // the last bits of the polynomials do not turn the path back
  m.s_end_u = std::max(x.s_u, s_u_);
  m.speed_end_u_s = x.speed_u_s;
  m.accel_end_u_s2 = x.accel_u_s2;
  m.override_used = tracker_.percent().feed;
  const Signature why = tracker_.limited_by();
  m.limited_by = why.reason;
  m.limiting_axis = why.axis;
  finish_tick(m);
  if (emergency && x.speed_u_s == 0.0) stopped_ = true;
  if (limits) limit_ = tracker_.braking() ? LimitedFeed{} : limiter_at(m.s_end_u, m.speed_end_u_s);
  if (tracker_.run_ended()) return_to_law(tracker_.segment());
}

/// The tracker continues from the current motion.
void OverrideSource::take_back(const Percent& percent) {
  limited_ = false;
  limit_ = {};
  const std::size_t segment = terrain_.segment_at(s_u_, segment_);
  tracker_.start(segment, {s_u_, speed_u_s_, 0.0, 0.0}, percent, machine::kInfinity, speed_u_s_);
}

bool OverrideSource::advance_limited(TickMotion& m, const Percent& percent) {
  const double tau = machine_.clock.tau_s();
  const bool predictive = machine_.feed_override.predictive;
  if (!limited_) {
    if (tracker_.run_ended() || tracker_.braking()) return false;
    const MotionState& x = tracker_.state();
    if (predictive) {
      // a feed that this tick can come to
      const RampLimits l = terrain_.limits(tracker_.segment(), tracker_.segment());
      limit_ = limiter_at(x.s_u + x.speed_u_s * tau, x.speed_u_s + l.accel_u_s2 * percent.feed * tau);
    }
    if (!(limit_.factor < 1.0)) return false;
    demand_ = x;
    segment_ = tracker_.segment();
    limited_ = true;
  }
  segment_ = terrain_.segment_at(s_u_, segment_);
  // has the limited feed to brake for a place ahead?
  const bool started = probe_.start(segment_, {s_u_, speed_u_s_, 0.0, 0.0}, percent, machine::kInfinity,
                                    std::max(speed_u_s_, 1e-6));
  probe_.advance(tau);
  if (!started || probe_.braking() || probe_.run_ended()) {
    take_back(percent);
    return false;
  }
  const double wanted = terrain_.cap_u_s(2 * segment_ + 1, percent);
  RampLimits l = terrain_.limits(segment_, segment_);
  const double scale = terrain_.limit_scale(percent, segment_, demand_.speed_u_s);
  l = {l.accel_u_s2 * scale, l.jerk_u_s3 * scale};
  const double before = demand_.speed_u_s;
  demand_ = towards(demand_, wanted, l, tau);
  const double mean = 0.5 * (before + demand_.speed_u_s);
  if (predictive) limit_ = limiter_at(s_u_ + limit_.factor * mean * tau, demand_.speed_u_s);
  const double end_u = s_u_ + limit_.factor * mean * tau;
  const double end_speed_u_s = limit_.factor * demand_.speed_u_s;
  if (!brakes_from(end_u, end_speed_u_s, percent)) {
    take_back(percent);
    return false;
  }
  m.s_end_u = end_u;
  m.speed_end_u_s = end_speed_u_s;
  m.accel_end_u_s2 = (m.speed_end_u_s - m.speed_begin_u_s) / tau;
  m.override_used = percent.feed;
  m.limiter = limit_.factor;
  m.note = OverrideNote::limited;
  m.limited_by = LimitedBy::limiter;
  m.limiting_axis = static_cast<std::int8_t>(limit_.axis);
  finish_tick(m);
  if (!predictive) limit_ = limiter_at(m.s_end_u, demand_.speed_u_s);
  if (!(limit_.factor < 1.0)) {
    limited_ = false;
    segment_ = terrain_.segment_at(s_u_, segment_);
    if (!tracker_.start(segment_, {s_u_, demand_.speed_u_s, demand_.accel_u_s2, 0.0}, percent, l.jerk_u_s3))
      take_back(percent);
  }
  return true;
}

/// Whether a feed that still rises while it is limited can be braked from where it leads. Multiplying the diagram
/// guarantees nothing.
bool OverrideSource::brakes_from(double s_u, double speed_u_s, const Percent& percent) {
  if (terrain_.proportional()) return true;
  if (s_u >= path_.start_s_u[terrain_.run_end(segment_) + 1]) return false;
  return probe_.start(terrain_.segment_at(s_u, segment_), {s_u, speed_u_s, 0.0, 0.0}, percent,
                      machine::kInfinity, std::max(speed_u_s, 1e-6));
}

LimitedFeed OverrideSource::limiter_at(double s_u, double feed_u_s) {
  const std::size_t i = terrain_.segment_at(std::min(s_u, path_.length_u()), segment_);
  joints_->at(i, std::clamp(s_u - path_.start_s_u[i], 0.0, path_.segments[i].length_u), {.d1 = tangent_});
  return limited_feed(machine_, tangent_, feed_u_s);
}

/// Shape of the tick, and the state for the next one.
void OverrideSource::finish_tick(TickMotion& m) {
  const double tau = machine_.clock.tau_s();
  s_u_ = m.s_end_u;
  speed_u_s_ = m.speed_end_u_s;
  const double ticks = static_cast<double>(machine_.clock.control_tick.value);
  if (machine_.planner.tick_feed == machine::TickFeed::constant) {
    m.ramp_begin_u_s = m.ramp_end_u_s = (m.s_end_u - m.s_begin_u) / tau;
    m.move_end_ticks = ticks;
    m.held_error_u = std::fabs(m.speed_end_u_s - m.speed_begin_u_s) * tau / 8.0;
  } else {
    shape_linear_feed(m, tau, ticks);
  }
}

std::unique_ptr<MotionSource> override_source(const Path& path, const FeedPlan& plan,
                                              const machine::MachineModel& machine, double most_percent) {
  return std::make_unique<OverrideSource>(path, plan, machine, most_percent);
}

}  // namespace kadr::planner
