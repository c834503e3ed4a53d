#include "planner/verify/verify_context.h"

#include <algorithm>
#include <cmath>

#include "machine/machine.h"

namespace kadr::planner {
namespace {

/// Of a piece's time: until both ends are neighbours.
constexpr int kTimeSteps = 70;
/// Feeds of a thousandth of a millimetre per second take hours for a line: whole ticks and the ulp of such
/// times change them by more than their relative tolerance, and by less than this, a step of 1 um in a day.
constexpr double kSpeedFloor_u_s = 1e-8;
/// The rounding of a length, a speed or a time that a law's pieces add up.
constexpr double kSumUlps = 16.0;
/// Share of the relative tolerance that slow speeds have of the law's highest, and lengths of their own.
constexpr double kSmallShare = 1e-3;

}  // namespace

VerifyContext::VerifyContext(const Joints& the_joints, const FeedPlan& feed_plan,
                             const machine::MachineModel& model, const VerifyOptions& how,
                             std::span<const Pause> held)
    : joints(the_joints),
      path(the_joints.path()),
      plan(feed_plan),
      law(feed_plan.law),
      machine(model),
      options(how),
      pauses(held) {
  slack_u_ = kSumUlps * kUlp * std::max(path.length_u(), 1.0);
  for (const JerkPiece& piece : law.pieces) top_speed_u_s_ = std::max(top_speed_u_s_, piece.speed_u_s);
}

void VerifyContext::report(const char* what, double time_s, std::size_t segment, int axis, double value,
                           double limit) {
  if (!full()) found.push_back({what, time_s, static_cast<std::uint32_t>(segment), axis, value, limit});
}

double VerifyContext::speed_tolerance(double v, double a, double time_s) const {
  return options.relative_tolerance * (std::fabs(v) + kSmallShare * top_speed_u_s_) +
         kSumUlps * kUlp * time_s * std::fabs(a) + kSpeedFloor_u_s;
}

double VerifyContext::way_tolerance_u(const JerkPiece& p) const {
  return way_tolerance_u(p, verified_state(p, p.duration_s));
}

double VerifyContext::way_tolerance_u(const JerkPiece& p, const VerifiedState& end) const {
  return slack_u_ + kSumUlps * kUlp * law.duration_s * std::max(p.speed_u_s, end.v) +
         kSmallShare * options.relative_tolerance * (end.s - p.s_u) +
         // a speed below the floor counts as rest: the distance that it leaves within one control tick
         kSpeedFloor_u_s * std::min(p.duration_s, machine.clock.tau_s());
}

double VerifyContext::time_of(const JerkPiece& p, double s) const {
  double low = 0.0, high = p.duration_s;
  const double way = verified_state(p, high).s - p.s_u;
  double t = way > 0.0 ? std::clamp(high * (s - p.s_u) / way, low, high) : high;
  for (int i = 0; i < kTimeSteps && low < high; ++i) {
    const VerifiedState x = verified_state(p, t);
    (x.s < s ? low : high) = t;
    const double next = x.v > 0.0 ? t - (x.s - s) / x.v : low;
    if (next == t) break;
    t = next > low && next < high ? next : 0.5 * (low + high);
  }
  return t;
}

std::size_t VerifyContext::segment_at(double s) const {
  // most questions are about the segment of the last one, or the next
  for (std::size_t i = hint_; i < std::min(hint_ + 2, path.size() - 1); ++i)
    if (path.start_s_u[i] <= s && s < path.start_s_u[i + 1]) return hint_ = i;
  const auto it = std::upper_bound(path.start_s_u.begin(), path.start_s_u.end(), s);
  const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(it - path.start_s_u.begin() - 1, 0));
  return hint_ = std::min(i, path.size() - 1);
}

bool VerifyContext::axes_enforced(const PathSegment& segment) const {
  return machine.planner.axis_limits == machine::AxisLimitRule::enforce || !segment.path_limits ||
         !(machine.path.max_accel_mm_s2 < machine::kInfinity);
}

bool VerifyContext::jerk_limited(std::size_t i) const {
  if (!machine.planner.keeps_jerk()) return false;
  const PathSegment& segment = path.segments[i];
  if (segment.path_limits && machine.path.max_jerk_mm_s3 < machine::kInfinity) return true;
  if (!axes_enforced(segment)) return false;
  for (std::size_t j = 0; j < machine.axis.size(); ++j)
    if (joints.moves(i, j) && machine.axis[j].max_jerk_u_s3 < machine::kInfinity) return true;
  return false;
}

bool VerifyContext::jerk_limited_around(double s) const {
  const std::size_t here = segment_at(s);
  for (std::size_t i = here > 0 ? here - 1 : 0; i <= std::min(here + 1, path.size() - 1); ++i) {
    const bool near = path.start_s_u[i] <= s + slack_u_ && path.start_s_u[i + 1] >= s - slack_u_;
    if (near && !jerk_limited(i)) return false;
  }
  return true;
}

bool VerifyContext::positions(std::size_t i) const {
  if (machine.planner.rapid_law == machine::RapidShape::scurve || !path.segments[i].rapid) return false;
  for (std::size_t j = 0; j < machine.axis.size(); ++j)
    if (joints.moves(i, j) && machine.axis[j].has_plant) return true;
  return false;
}

}  // namespace kadr::planner
