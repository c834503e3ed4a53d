#include "planner/override/override_source.h"

#include <algorithm>
#include <cmath>

#include "machine/base/require.h"
#include "planner/laws/tick_shape.h"

namespace kadr::planner {
namespace {

PathLimitTable caps_of(const Path& path, const FeedPlan& plan, const machine::MachineModel& machine,
                       double most_percent) {
  using machine::OverrideMode;
  const OverrideMode mode = machine.feed_override.mode;
  auto table = limit_table(path, machine, mode == OverrideMode::corrected_plus ? most_percent : 1.0);
  require(table.has_value(), "a path that was planned has limits");
  // eq. 7 and 8 by the letter: with F_HK and F_KK of blocks that end without acceleration. Ramps that run
  // over many blocks have no such numbers; there F itself is what is never exceeded
  if (mode != OverrideMode::corrected || machine.planner.scheduler == machine::SchedulerKind::chained)
    return std::move(*table);
  for (std::size_t i = 0; i < path.size(); ++i) {
    double& peak = table->cap_u_s[2 * i + 1];
    peak = std::min(peak, plan.segments[i].peak_u_s);
    double& end = table->cap_u_s[2 * i + 2];
    end = std::min(end, plan.segments[i].end_u_s);
  }
  return std::move(*table);
}

}  // namespace

OverrideSource::OverrideSource(const Path& path, const FeedPlan& plan, const machine::MachineModel& machine,
                               double most_percent)
    : path_(path),
      plan_(plan),
      machine_(machine),
      terrain_(path, machine, caps_of(path, plan, machine, most_percent)),
      law_(plan.law, machine),
      tracker_(terrain_) {}

bool OverrideSource::finished() const { return tracking_ ? false : law_.finished(); }

/// A pause, or the end: nothing that a percent would change.
bool OverrideSource::law_rests() const {
  const JerkPiece& piece = plan_.law.pieces[law_.piece()];
  return piece.speed_u_s == 0.0 && piece.accel_u_s2 == 0.0 && piece.jerk_u_s3 == 0.0;
}

bool OverrideSource::law_brakes() const {
  const MotionState& x = law_.state();
  return x.accel_u_s2 < 0.0 || (x.accel_u_s2 == 0.0 && x.jerk_u_s3 < 0.0);
}

bool OverrideSource::leave_law(const Percent& percent) {
  const MotionState x = law_.state();
  // the ramp under way ends with the jerk of its last piece
  double jerk = terrain_.limits(segment_, segment_).jerk_u_s3;
  for (std::size_t k = law_.piece(); x.accel_u_s2 != 0.0 && k < plan_.law.pieces.size(); ++k) {
    const double j = plan_.law.pieces[k].jerk_u_s3;
    if (j * x.accel_u_s2 < 0.0) {
      jerk = std::fabs(j);
      break;
    }
  }
  return tracking_ = tracker_.start(segment_, x, percent, jerk);
}

/// The tracker stands at the end of its run: the law goes on from there with the next control tick.
void OverrideSource::return_to_law() {
  law_.seek(plan_.segments[tracker_.segment()].end_time_s, s_u_, tick_);
  segment_ = terrain_.segment_at(s_u_, tracker_.segment());
  tracking_ = false;
}

TickMotion OverrideSource::advance(const OperatorInput& input) {
  Percent percent{input.hold ? 0.0 : input.feed_override, input.hold ? 0.0 : input.rapid_override, 1.0};
  percent.frozen = percent.feed;
  const bool plain = percent.feed == 1.0 && percent.rapid == 1.0;
  OverrideNote note = OverrideNote::none;
  if (!tracking_ && !law_.finished() && (!plain || input.emergency_stop)) {
    if (!law_rests()) {
      const bool moving = law_.state().speed_u_s > 0.0;
      if (input.emergency_stop)
        leave_law(Percent{}), tracking_ = true;
      else if (moving && terrain_.locked(segment_))
        note = OverrideNote::locked;
      else if (moving && law_brakes())
        note = OverrideNote::deferred;
      else if (!leave_law(percent))
        note = OverrideNote::deferred;
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
  const double tau = machine_.clock.tau_s();
  const double ticks = static_cast<double>(machine_.clock.control_tick.value);
  m.s_begin_u = s_u_;
  m.speed_begin_u_s = tracker_.state().speed_u_s;
  if (emergency) tracker_.stop_now();
  tracker_.set_percent(percent);
  const bool waits = !(tracker_.percent().feed == percent.feed && tracker_.percent().rapid == percent.rapid);
  if (waits) m.note = tracker_.locked() ? OverrideNote::locked : OverrideNote::deferred;
  tracker_.advance(tau);
  const MotionState& x = tracker_.state();
  // the last bits of the polynomials do not turn the path back
  m.s_end_u = s_u_ = std::max(x.s_u, s_u_);
  m.speed_end_u_s = x.speed_u_s;
  m.accel_end_u_s2 = x.accel_u_s2;
  m.override_requested = percent.feed;
  m.override_used = tracker_.percent().feed;
  const Signature why = tracker_.limited_by();
  m.limited_by = why.reason;
  m.limiting_axis = why.axis;
  if (machine_.planner.tick_feed == machine::TickFeed::constant) {
    m.ramp_begin_u_s = m.ramp_end_u_s = (m.s_end_u - m.s_begin_u) / tau;
    m.move_end_ticks = ticks;
    m.held_error_u = std::fabs(m.speed_end_u_s - m.speed_begin_u_s) * tau / 8.0;
  } else {
    shape_linear_feed(m, tau, ticks);
  }
  if (emergency && x.speed_u_s == 0.0) stopped_ = true;
  if (tracker_.run_ended()) return_to_law();
}

std::unique_ptr<MotionSource> override_source(const Path& path, const FeedPlan& plan,
                                              const machine::MachineModel& machine, double most_percent) {
  return std::make_unique<OverrideSource>(path, plan, machine, most_percent);
}

}  // namespace kadr::planner
