#include "planner/scheduler/pieces.h"

#include <algorithm>
#include <cmath>

#include "machine/infinity.h"
#include "planner/path/path.h"

namespace kadr::planner {
namespace {

/// A guard: halving alone would need 54 steps to the last bit, and Newton helps.
constexpr int kBracketSteps = 80;

/// Time within a piece at which it has covered `way`: closed form at constant speed, else Newton in a bracket.
double time_of_way(const JerkPiece& p, double way) {
  if (!(way > 0.0)) return 0.0;
  if (p.is_hold()) return std::min(way / p.speed_u_s, p.duration_s);
  double low = 0.0, high = p.duration_s;
  if (way >= p.way_u(high)) return high;
  const double mean = 0.5 * (p.speed_u_s + p.speed_after_u_s(high));
  double t = std::clamp(way / mean, low, high);
  for (int i = 0; i < kBracketSteps; ++i) {
    const double excess = p.way_u(t) - way;
    (excess > 0.0 ? high : low) = t;
    if (high - low <= 1e-16 * high) break;
    const double v = p.speed_after_u_s(t);
    const double next = t - excess / v;
    if (next == t) break;
    t = v > 0.0 && next > low && next < high ? next : 0.5 * (low + high);
  }
  return t;
}

}  // namespace

void PieceWriter::piece(double duration, double s, double v, double a, double j, Signature why, double rise) {
  if (!(duration > 0.0)) return;
  if (stretch_ != 1.0) {
    const double k = stretch_;
    duration *= k;
    v /= k;
    a /= k * k;
    j /= k * k * k;
    rise /= k;
  }
  law_.pieces.push_back({time_s_, duration, s, v, a, j, why.reason, why.axis, rise});
  const double y = duration - lost_s_;
  const double next = time_s_ + y;
  lost_s_ = (next - time_s_) - y;
  time_s_ = next;
}

void PieceWriter::ramp(const Element& e) {
  const double dv = std::fabs(e.v1_u_s - e.v0_u_s);
  const double sign = e.v1_u_s > e.v0_u_s ? 1.0 : -1.0;
  const RampLimits l = e.limits;
  const double total = ramp_time_s(dv, l);
  if (l.law == machine::RampLaw::quintic) {
    const double rise = e.v1_u_s - e.v0_u_s;
    return piece(total, e.s_u, e.v0_u_s, 0.0, kQuinticJerk * rise / (total * total), e.signature, rise);
  }
  if (!(l.jerk_u_s3 < machine::kInfinity))
    return piece(total, e.s_u, e.v0_u_s, sign * l.accel_u_s2, 0.0, e.signature);
  const bool full = dv * l.jerk_u_s3 > l.accel_u_s2 * l.accel_u_s2;
  const double t = full ? l.accel_u_s2 / l.jerk_u_s3 : 0.5 * total;
  const double a = sign * (full ? l.accel_u_s2 : l.jerk_u_s3 * t);
  const double j = sign * l.jerk_u_s3;
  piece(t, e.s_u, e.v0_u_s, 0.0, j, e.signature);
  double s = e.s_u + t * (e.v0_u_s + j * t * t / 6.0);
  double v = e.v0_u_s + 0.5 * j * t * t;
  if (full) {
    const double hold = total - 2.0 * t;
    piece(hold, s, v, a, 0.0, e.signature);
    if (hold > 0.0) {
      s += hold * (v + 0.5 * a * hold);
      v = e.v1_u_s - 0.5 * j * t * t;
    }
  }
  piece(t, s, v, a, -j, e.signature);
}

void PieceWriter::add(const std::vector<Element>& run, double stretch, double end_time_s) {
  stretch_ = stretch;
  // at most three pieces per ramp; growing by half keeps many short runs cheap
  std::size_t more = 0;
  for (const Element& e : run) more += e.is_hold() ? 1 : 3;
  if (law_.pieces.size() + more > law_.pieces.capacity())
    law_.pieces.reserve(std::max(law_.pieces.size() + more, law_.pieces.capacity() * 3 / 2));
  for (const Element& e : run) {
    if (e.is_hold())
      piece(e.time_s(), e.s_u, e.v0_u_s, 0.0, 0.0, e.signature);
    else
      ramp(e);
  }
  end_at(end_time_s);
}

void PieceWriter::add(const std::vector<JerkPiece>& run, double stretch, double end_time_s) {
  stretch_ = stretch;
  for (const JerkPiece& p : run)
    piece(p.duration_s, p.s_u, p.speed_u_s, p.accel_u_s2, p.jerk_u_s3, {p.limited_by, p.limiting_axis});
  end_at(end_time_s);
}

void PieceWriter::end_at(double end_time_s) {
  if (end_time_s < 0.0) return;
  // the run lasts as long as prescribed, except for the last bits of the sum
  if (!law_.pieces.empty()) {
    JerkPiece& last = law_.pieces.back();
    if (end_time_s > last.begin_s) last.duration_s = end_time_s - last.begin_s;
  }
  time_s_ = end_time_s;
  lost_s_ = 0.0;
}

void PieceWriter::rest(double s_u, double end_time_s) {
  if (!(end_time_s > time_s_)) return;
  law_.pieces.push_back({time_s_, end_time_s - time_s_, s_u, 0.0, 0.0, 0.0, LimitedBy::stop, -1, 0.0});
  time_s_ = end_time_s;
  lost_s_ = 0.0;
}

void fill_segment_table(const Path& path, const PathLimitTable& table, FeedPlan& plan) {
  const std::vector<JerkPiece>& pieces = plan.law.pieces;
  plan.segments.resize(path.size());
  std::size_t p = 0;
  double time = 0.0, speed = 0.0;  // at the joint passed last
  for (std::size_t i = 0; i < path.size(); ++i) {
    SegmentPlan& seg = plan.segments[i];
    seg.begin_time_s = time;
    seg.peak_u_s = speed;
    Signature why{pieces[p].limited_by, pieces[p].limiting_axis};
    // pieces that end inside the segment: a ramp's highest speed is at one of its ends
    const double end = path.start_s_u[i + 1];
    while (p + 1 < pieces.size() && pieces[p + 1].s_u < end) {
      ++p;
      const JerkPiece& next = pieces[p];
      const bool holds = next.is_hold();
      if (next.speed_u_s > seg.peak_u_s || (next.speed_u_s == seg.peak_u_s && holds)) {
        seg.peak_u_s = pieces[p].speed_u_s;
        why = {pieces[p].limited_by, pieces[p].limiting_axis};
      }
    }
    const bool last = i + 1 == path.size();
    const bool stops = table.cap_u_s[2 * (i + 1)] == 0.0;
    if (last) {
      time = plan.law.duration_s;
      speed = 0.0;
    } else if (stops) {
      // a run's end: its last piece ends here whatever the last bit of s says
      while (p + 1 < pieces.size() && pieces[p].speed_u_s > 0.0 && pieces[p + 1].speed_u_s > 0.0) ++p;
      if (p + 1 < pieces.size() && pieces[p + 1].speed_u_s == 0.0) ++p;
      time = pieces[p].begin_s;
      speed = 0.0;
    } else {
      const double t = time_of_way(pieces[p], end - pieces[p].s_u);
      time = pieces[p].begin_s + t;
      speed = pieces[p].speed_after_u_s(t);
      if (speed > seg.peak_u_s) seg.peak_u_s = speed, why = {pieces[p].limited_by, pieces[p].limiting_axis};
    }
    seg.end_u_s = speed;
    seg.end_time_s = time;
    seg.limited_by = why.reason;
    seg.limiting_axis = why.axis;
  }
}

}  // namespace kadr::planner
