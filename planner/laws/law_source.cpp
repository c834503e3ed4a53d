#include <algorithm>
#include <cmath>

#include "machine/machine.h"
#include "planner/laws/motion_source.h"
#include "planner/laws/tick_shape.h"

namespace kadr::planner {
namespace {

/// A law that ends on a control tick may miss it by the rounding of its summed durations; far below a base tick.
constexpr double kEndSlack_s = 1e-9;

/// Halves a piece of up to a day to below a tenth of a nanosecond.
constexpr int kTimeHalvings = 50;

/// Time within a quintic piece at which it has a speed, or the end of [from, to] that is nearest to it: its
/// speed only rises, or only falls.
double time_of_speed(const JerkPiece& p, double speed, double from_s, double to_s) {
  const bool rises = p.quintic_rise_u_s > 0.0;
  for (int i = 0; i < kTimeHalvings; ++i) {
    const double mid = 0.5 * (from_s + to_s);
    ((p.speed_after_u_s(mid) < speed) == rises ? from_s : to_s) = mid;
  }
  return from_s;
}

/// Largest distance between the law and a path that moves from s_begin at a constant speed, over [begin,
/// end]. Extremes lie where the law has that speed, and at the ends of its pieces.
double largest_gap_u(const MotionLaw& law, std::size_t hint, double begin_s, double end_s, double s_begin,
                     double speed) {
  double largest = 0.0;
  const auto look = [&](const JerkPiece& p, double t) {
    const double held = s_begin + speed * (p.begin_s + t - begin_s);
    largest = std::max(largest, std::fabs(held - (p.s_u + p.way_u(t))));
  };
  for (; hint < law.pieces.size() && law.pieces[hint].begin_s < end_s; ++hint) {
    const JerkPiece& p = law.pieces[hint];
    const double from = std::max(begin_s - p.begin_s, 0.0);
    const double to = std::min(end_s - p.begin_s, p.duration_s);
    if (!(to >= from)) continue;
    look(p, from);
    look(p, to);
    if (p.is_quintic()) {
      look(p, time_of_speed(p, speed, from, to));
      continue;
    }
    // speed + a t + j t^2/2 = held speed
    const double c = p.speed_u_s - speed;
    const double a = p.accel_u_s2;
    const double j = p.jerk_u_s3;
    const double root = a * a - 2.0 * j * c;
    if (root < 0.0) continue;
    const double q = -(a + (a >= 0.0 ? 1.0 : -1.0) * std::sqrt(root));
    for (const double t : {j != 0.0 ? q / j : -1.0, q != 0.0 ? 2.0 * c / q : -1.0})
      if (t > from && t < to) look(p, t);
  }
  return largest;
}

}  // namespace

LawSource::LawSource(const MotionLaw& law, const machine::MachineModel& machine)
    : law_(law), machine_(machine) {
  if (!law_.pieces.empty()) state_ = law_.eval(0.0, hint_);
}

double LawSource::time_s() const {
  return from_s_ + static_cast<double>((tick_ - from_tick_).value) * machine_.clock.tau_s();
}

bool LawSource::finished() const { return time_s() >= law_.duration_s - kEndSlack_s; }

void LawSource::seek(double time_s, double s_u, ControlTicks tick) {
  tick_ = from_tick_ = tick;
  from_s_ = time_s;
  hint_ = 0;
  law_.eval(time_s, hint_);
  state_ = {s_u, 0.0, 0.0, 0.0};
}

TickMotion LawSource::advance(const OperatorInput&) {
  const double tau = machine_.clock.tau_s();
  const double ticks = static_cast<double>(machine_.clock.control_tick.value);
  TickMotion m;
  m.tick = tick_;
  m.s_begin_u = state_.s_u;
  m.speed_begin_u_s = state_.speed_u_s;
  if (finished()) {
    m.s_end_u = m.s_begin_u;
    m.move_end_ticks = ticks;
    m.limited_by = LimitedBy::stop;
    ++tick_;
    return m;
  }
  const double begin = time_s();
  const std::size_t hint_begin = hint_;
  ++tick_;
  const double end = finished() ? law_.duration_s : time_s();
  const MotionState next = law_.eval(end, hint_);
  // the last bits of the polynomials neither turn the path back nor take it past its end
  m.s_end_u = std::min(std::max(next.s_u, m.s_begin_u), law_.length_u);
  m.speed_end_u_s = next.speed_u_s;
  m.accel_end_u_s2 = next.accel_u_s2;
  const JerkPiece& piece = law_.pieces[hint_];
  m.limited_by = piece.limited_by;
  m.limiting_axis = piece.limiting_axis;
  if (machine_.planner.tick_feed == machine::TickFeed::constant) {
    const double held = (m.s_end_u - m.s_begin_u) / tau;
    m.ramp_begin_u_s = m.ramp_end_u_s = held;
    m.move_end_ticks = ticks;
    m.held_error_u = largest_gap_u(law_, hint_begin, begin, end, m.s_begin_u, held);
  } else {
    shape_linear_feed(m, tau, ticks);
  }
  state_ = next;
  state_.s_u = m.s_end_u;
  return m;
}

}  // namespace kadr::planner
