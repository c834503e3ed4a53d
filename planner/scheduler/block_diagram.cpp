#include "planner/scheduler/block_diagram.h"

#include <algorithm>
#include <cmath>

#include "machine/infinity.h"

namespace kadr::planner {
namespace {

// a time within this share of a whole number counts as whole
constexpr double kWhole = 1e-12;
// holds shorter than this share of their block are rounding noise noise noise
constexpr double kNoHold = 1e-14;
// ramps by less than this share of their speed are the last bits of a bisection
constexpr double kNoRamp = 1e-13;
// relative error of the sum of a few correctly rounded times
constexpr double kRounding = 4e-15;
constexpr int kHalvings = 60;  // fewer where no number lies between

/// Halves between a value that is good and one that is not; the last good one.
template <class Good>
double bisect(double good, double bad, Good is_good) {
  for (int i = 0; i < kHalvings; ++i) {
    const double mid = 0.5 * (good + bad);
    if (mid == good || mid == bad) break;
    (is_good(mid) ? good : bad) = mid;
  }
  return good;
}

double time_s(const BlockDiagram& b, double main, double end) {
  const double up = ramp_time_s(main - b.entry_u_s, b.limits);
  const double down = ramp_time_s(main - end, b.limits) * b.brake_factor;
  const double hold = b.length_u - 0.5 * (b.entry_u_s + main) * up - 0.5 * (end + main) * down;
  if (!(hold > 0.0)) return up + down;
  return main > 0.0 ? up + down + hold / main : machine::kInfinity;
}

bool lower_main(BlockDiagram& b, double wanted_s) {
  const auto lasts = [&](double main) { return time_s(b, main, b.end_u_s) >= wanted_s; };
  const double lowest = std::max(b.entry_u_s, b.end_u_s);
  if (!lasts(lowest)) return false;
  b.main_u_s = bisect(lowest, b.main_u_s, lasts);
  b.rule = TickRule::lower_main;
  return true;
}

bool stretch_brake(BlockDiagram& b, double wanted_s) {
  const double v0 = b.entry_u_s, v1 = b.end_u_s;
  if (!(v0 > v1) || b.main_u_s > v0 * (1.0 + kWhole)) return false;
  const double brake_s = 2.0 * (v0 * wanted_s - b.length_u) / (v0 - v1);
  if (!(brake_s <= wanted_s)) return false;
  b.main_u_s = v0;
  b.brake_factor = std::max(brake_s / ramp_time_s(v0 - v1, b.limits), 1.0);
  b.rule = TickRule::stretch_brake;
  return true;
}

bool lower_end(BlockDiagram& b, double wanted_s) {
  const auto lasts = [&](double end) { return time_s(b, std::max(b.entry_u_s, end), end) >= wanted_s; };
  const double lowest = lowest_exit_u_s(b.entry_u_s, b.length_u, b.limits);
  if (!(lowest <= b.end_u_s) || !lasts(lowest)) return false;
  b.end_u_s = bisect(lowest, b.end_u_s, lasts);
  b.main_u_s = std::max(b.entry_u_s, b.end_u_s);
  b.rule = TickRule::lower_end;
  return true;
}

}  // namespace

double BlockDiagram::time_s() const { return planner::time_s(*this, main_u_s, end_u_s); }

double lowest_exit_u_s(double v0_u_s, double distance_u, RampLimits limits) {
  const auto fits = [&](double drop) { return ramp_length_u(v0_u_s - drop, v0_u_s, limits) <= distance_u; };
  const bool quintic = limits.law == machine::RampLaw::quintic;
  // drop at which the ramp comes to a
  const double share = quintic ? kQuinticJerk / (kQuinticAccel * kQuinticAccel) : 1.0;
  const double full = share * limits.accel_u_s2 * limits.accel_u_s2 / limits.jerk_u_s3;
  double longest = 2.0 / 3.0 * v0_u_s;
  if (longest > full) longest = quintic ? v0_u_s : std::max(v0_u_s - 0.5 * full, 0.0);
  if (!fits(longest)) return v0_u_s - bisect(0.0, longest, fits);
  // beyond a quintic ramp's drop to a the path grows again, down to rest
  if (quintic && full < v0_u_s && !fits(v0_u_s))
    return v0_u_s - bisect(std::max(full, longest), v0_u_s, fits);
  return 0.0;
}

void fill_block_ticks(BlockDiagram& block, double tau_s, machine::BlockTicks how) {
  const double time = block.time_s();
  const double ticks = std::max(std::ceil(time / tau_s * (1.0 - kWhole)), 1.0);
  const double wanted = ticks * tau_s;
  block.ticks = static_cast<std::int64_t>(ticks);
  if (wanted - time <= kWhole * time) return;
  if (how == machine::BlockTicks::exact &&
      (lower_main(block, wanted) || stretch_brake(block, wanted) || lower_end(block, wanted)))
    return;
  block.kl = block.length_u / (block.length_u + block.end_u_s * (wanted - time));
  block.rule = TickRule::scale;
}

double append_elements(const BlockDiagram& block, double s_u, double tau_s, const BlockReasons& why,
                       std::vector<Element>& out) {
  const std::size_t first = out.size();
  double wanted = static_cast<double>(block.ticks) * tau_s;
  // the rest of the last control tick is spent at the end's speed, or at rest
  const double left = block.rule == TickRule::scale ? wanted - block.time_s() : 0.0;
  if (block.end_u_s == 0.0) wanted -= left;
  const double entry = block.entry_u_s * block.kl;
  const double main = block.main_u_s * block.kl;
  const double end = block.end_u_s * block.kl;
  RampLimits limits = block.limits;
  limits.accel_u_s2 *= block.kl;
  limits.jerk_u_s3 *= block.kl;
  RampLimits brake = limits;
  brake.accel_u_s2 /= block.brake_factor;
  brake.jerk_u_s3 /= block.brake_factor * block.brake_factor;

  const bool rises = main - entry > kNoRamp * main;
  const bool falls = main - end > kNoRamp * main;
  const double up = rises ? ramp_length_u(entry, main, limits) : 0.0;
  const double down = falls ? ramp_length_u(end, main, brake) : 0.0;
  double tail = end * left;
  double hold = block.length_u - up - down - tail;
  if (!(hold > kNoHold * block.length_u)) hold = 0.0;
  // scaled ramps keep their length up to rounding
  if (tail > 0.0) tail = block.length_u - up - down - hold;
  const auto add_hold = [&](double length, double speed) {
    if (length > 0.0) out.push_back({s_u, length, speed, speed, {0, 0}, why.hold});
    s_u += length;
  };
  if (rises) out.push_back({s_u, up, entry, main, limits, why.up});
  s_u += up;
  add_hold(falls ? hold : hold + tail, main);
  if (falls) {
    out.push_back({s_u, down, main, end, brake, why.down});
    s_u += down;
    add_hold(tail, end);
  }
  if (block.ticks == 0) return 1.0;
  double time = 0.0;
  for (std::size_t i = first; i < out.size(); ++i) time += out[i].time_s();
  return std::fabs(wanted - time) > kRounding * time ? wanted / time : 1.0;
}

}  // namespace kadr::planner
