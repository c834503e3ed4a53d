#include "planner/override/feed_way.h"

#include <algorithm>
#include <cmath>

#include "machine/infinity.h"
#include "planner/override/motion_step.h"

namespace kadr::planner {
namespace {

/// Of a piece's time: to its last bits.
constexpr int kSpeedHalvings = 60;

}  // namespace

void FeedWay::begin_at(const MotionState& state) {
  pieces_.clear();
  at_ = 0;
  in_piece_s_ = 0.0;
  end_place_ = 0;
  end_ = state;
  end_.jerk_u_s3 = 0.0;
}

MotionState FeedWay::state() const {
  return in_piece_s_ > 0.0 ? moved(now().begin, in_piece_s_) : now().begin;
}

void FeedWay::add(double duration_s, double jerk, const RampLimits& limits, const Signature& why,
                  bool braking) {
  if (!(duration_s > 0.0)) return;
  end_.jerk_u_s3 = jerk;
  pieces_.push_back({duration_s, end_, limits, why, braking});
  if (duration_s < kForever_s) end_ = moved(end_, duration_s);
}

void FeedWay::add(const Approach& way, double w, const RampLimits& held, const Signature& why, bool braking) {
  if (way.flare_s > 0.0) {
    add(way.flare_s, way.flare_jerk, held, {LimitedBy::length, -1}, braking);
    end_.speed_u_s = way.from.speed_u_s;
    end_.s_u = way.from.s_u;
    end_.accel_u_s2 = end_.jerk_u_s3 = 0.0;
  }
  const double dv = std::fabs(w - way.virtual_u_s);
  const double sign = w >= way.virtual_u_s ? 1.0 : -1.0;
  const double A = way.limits.accel_u_s2, J = way.limits.jerk_u_s3;
  if (way.done_s == 0.0 && same_speed(way.virtual_u_s, w)) {
    // only a rounding residue is left
  } else if (!(J < machine::kInfinity)) {
    end_.accel_u_s2 = sign * A;
    add(dv / A, 0.0, way.limits, why, braking);
  } else {
    const bool full = dv * J > A * A;
    const double t = full ? A / J : std::sqrt(dv / J);
    add(t - way.done_s, sign * J, way.limits, why, braking);
    if (full) add(dv / A - A / J, 0.0, way.limits, why, braking);
    add(std::fabs(end_.accel_u_s2) / J, -sign * J, way.limits, why, braking);
  }
  end_.speed_u_s = w;
  end_.accel_u_s2 = end_.jerk_u_s3 = 0.0;
}

double FeedWay::speed_at_u_s(double s_u) const {
  std::size_t k = 0;
  while (k + 1 < pieces_.size() && pieces_[k + 1].begin.s_u <= s_u) ++k;
  double low = 0.0, high = pieces_[k].duration_s;
  for (int i = 0; i < kSpeedHalvings; ++i) {
    const double mid = 0.5 * (low + high);
    (moved(pieces_[k].begin, mid).s_u < s_u ? low : high) = mid;
  }
  return moved(pieces_[k].begin, low).speed_u_s;
}

}  // namespace kadr::planner
