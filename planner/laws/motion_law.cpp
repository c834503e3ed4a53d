#include <algorithm>

#include "planner/laws/feed_plan.h"

namespace kadr::planner {

double JerkPiece::way_u(double t) const {
  if (!is_quintic()) return t * (speed_u_s + t * (0.5 * accel_u_s2 + t * jerk_u_s3 / 6.0));
  const double x = t / duration_s;
  return t * speed_u_s + quintic_rise_u_s * duration_s * (x * x * x * x * (2.5 + x * (x - 3.0)));
}

double JerkPiece::speed_after_u_s(double t) const {
  if (!is_quintic()) return speed_u_s + t * (accel_u_s2 + 0.5 * t * jerk_u_s3);
  const double x = t / duration_s;
  return speed_u_s + quintic_rise_u_s * (x * x * x * (10.0 + x * (6.0 * x - 15.0)));
}

MotionState JerkPiece::state_after(double t) const {
  MotionState state{s_u + way_u(t), speed_after_u_s(t), accel_u_s2 + t * jerk_u_s3, jerk_u_s3};
  if (!is_quintic()) return state;
  const double x = t / duration_s;
  const double rate = quintic_rise_u_s / duration_s;
  state.accel_u_s2 = 30.0 * rate * (x * x * (1.0 - x) * (1.0 - x));
  state.jerk_u_s3 = 60.0 * rate / duration_s * (x * (1.0 - x) * (1.0 - 2.0 * x));
  return state;
}

MotionState MotionLaw::eval(double time_s, std::size_t& hint) const {
  if (pieces.empty() || time_s >= duration_s) {
    hint = pieces.empty() ? 0 : pieces.size() - 1;
    return {length_u, 0.0, 0.0, 0.0};
  }
  if (!(time_s > 0.0)) time_s = 0.0;
  // mostly this piece or one of the next few; a jump is found by halving
  if (hint >= pieces.size() || pieces[hint].begin_s > time_s) hint = 0;
  for (int i = 0; i < 8 && hint + 1 < pieces.size() && pieces[hint + 1].begin_s <= time_s; ++i) ++hint;
  if (hint + 1 < pieces.size() && pieces[hint + 1].begin_s <= time_s) {
    const auto it = std::upper_bound(pieces.begin() + static_cast<std::ptrdiff_t>(hint), pieces.end(), time_s,
                                     [](double t, const JerkPiece& p) { return t < p.begin_s; });
    hint = static_cast<std::size_t>(it - pieces.begin()) - 1;
  }
  const JerkPiece& p = pieces[hint];
  const double t = std::min(time_s - p.begin_s, p.duration_s);
  MotionState state = p.state_after(t);
  state.speed_u_s = std::max(state.speed_u_s, 0.0);
  return state;
}

std::string_view tick_rule_name(TickRule rule) {
  static constexpr std::string_view kNames[] = {"", "a", "b", "c", "d"};
  return kNames[static_cast<std::size_t>(rule)];
}

std::string_view rapid_law_name(machine::RapidShape shape) {
  constexpr std::string_view kNames[] = {"scurve", "t-zero", "zv", "zvd", "auto"};
  return kNames[static_cast<std::size_t>(shape)];
}

}  // namespace kadr::planner
