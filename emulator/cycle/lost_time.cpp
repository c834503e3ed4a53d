#include "emulator/cycle/lost_time.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace kadr::cycle {
namespace {

constexpr int kBisections = 60;
constexpr double kLeast_s = 1e-6;

bool rests(const planner::JerkPiece& p) { return p.speed_u_s == 0 && p.accel_u_s2 == 0 && p.jerk_u_s3 == 0; }

}  // namespace

/// Planned time of motion from the path's beginning to s; s must not decrease.
double LostTime::planned_s(double s_u) {
  const std::vector<planner::JerkPiece>& pieces = law_.pieces;
  while (piece_ + 1 < pieces.size() && pieces[piece_ + 1].s_u <= s_u) {
    if (!rests(pieces[piece_])) moving_s_ += pieces[piece_].duration_s;
    ++piece_;
  }
  if (pieces.empty() || rests(pieces[piece_])) return moving_s_;
  double low = 0, high = pieces[piece_].duration_s;
  const auto at_s = [&](double t) {
    std::size_t hint = piece_;
    return law_.eval(pieces[piece_].begin_s + t, hint).s_u;
  };
  if (at_s(high) <= s_u) return moving_s_ + high;
  for (int i = 0; i < kBisections; ++i) {
    const double mid = 0.5 * (low + high);
    (at_s(mid) < s_u ? low : high) = mid;
  }
  return moving_s_ + high;
}

void LostTime::add(const planner::TickMotion& motion, log::LostReason reason) {
  const double reached_s = motion.s_end_u > motion.s_begin_u ? planned_s(motion.s_end_u) : reached_s_;
  const double lost_s = tau_s_ - (reached_s - reached_s_);
  reached_s_ = reached_s;
  auto it = std::find_if(shares_.begin(), shares_.end(), [&](const Share& s) { return s.reason == reason; });
  if (it == shares_.end()) it = shares_.insert(shares_.end(), Share{reason, 0.0});
  it->time_s += lost_s;
}

std::vector<log::LimitShare> LostTime::shares() const {
  std::vector<log::LimitShare> out;
  for (const Share& share : shares_)
    if (std::fabs(share.time_s) >= kLeast_s)
      out.push_back({std::string(log::kLostReasons.word(share.reason)), share.time_s});
  std::stable_sort(out.begin(), out.end(),
                   [](const log::LimitShare& a, const log::LimitShare& b) { return a.time_s > b.time_s; });
  return out;
}

}  // namespace kadr::cycle
