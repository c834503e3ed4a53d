#include <algorithm>
#include <cmath>

#include "machine/machine.h"
#include "planner/verify/verify_context.h"
#include "planner/verify/verify_pauses.h"

namespace kadr::planner {
namespace {

/// A law's pieces add up their rounding: at most this many ulp of the time.
constexpr double kTickUlps = 32.0;
/// The table's times are rounded sums: a place there may miss the joint by so many tolerances of a piece.
constexpr double kTablePlaces = 1e2;
/// Of the law's highest speed: the table's speeds.
constexpr double kTableSpeed = 1e-6;

/// Finds the piece that ends at rest at s, then passes those that stand there.
/// @param k  the first piece that may; afterwards the last one that was looked at
/// @param time_s  when the path goes on
bool rests_at(const VerifyContext& c, double s, std::size_t& k, double& time_s) {
  const std::vector<JerkPiece>& pieces = c.law.pieces;
  bool rests = false;
  for (; k < pieces.size() && pieces[k].s_u <= s + c.slack_u(); ++k) {
    const JerkPiece& p = pieces[k];
    const VerifiedState x = verified_state(p, p.duration_s);
    time_s = p.begin_s + p.duration_s;
    const double steep = std::fabs(x.a) + std::fabs(x.j) * p.duration_s;
    rests =
        std::fabs(x.s - s) <= c.way_tolerance_u(p) && std::fabs(x.v) <= c.speed_tolerance(0.0, steep, time_s);
    if (rests) break;
  }
  for (; rests && k + 1 < pieces.size() && stands(pieces[k + 1]); ++k)
    time_s = pieces[k + 1].begin_s + pieces[k + 1].duration_s;
  return rests;
}

/// Times and speeds of one row against the row before.
void verify_row(VerifyContext& c, std::size_t i, double time, double speed, double held) {
  const SegmentPlan& row = c.plan.segments[i];
  const double late = std::fabs(row.begin_time_s - (time + held));
  const double ulps = held > 0.0 ? kHeldUlps + static_cast<double>(c.pauses.size()) : 0.0;
  if (!(late <= ulps * kUlp * row.begin_time_s) || !(row.end_time_s >= row.begin_time_s))
    c.report("table times", time, i, -1, row.begin_time_s, time + held);
  if (!(row.peak_u_s >= std::max(speed, row.end_u_s) * (1.0 - c.options.relative_tolerance)))
    c.report("table peak", time, i, -1, row.peak_u_s, speed);
}

/// What a row says of its end against the piece of the law there.
void verify_row_end(VerifyContext& c, std::size_t i, const JerkPiece& p) {
  const SegmentPlan& row = c.plan.segments[i];
  const VerifiedState x = verified_state(p, std::clamp(row.end_time_s - p.begin_s, 0.0, p.duration_s));
  const double s = c.path.start_s_u[i + 1];
  if (!(std::fabs(x.s - s) <= kTablePlaces * c.way_tolerance_u(p)))
    c.report("table place", row.end_time_s, i, -1, x.s, s);
  // after hours the ulp of the time times the acceleration is more than a millionth of a crawling feed
  const double steep = std::fabs(p.accel_u_s2) + std::fabs(p.jerk_u_s3) * p.duration_s;
  if (!(std::fabs(x.v - row.end_u_s) <=
        kTableSpeed * c.top_speed_u_s() + c.speed_tolerance(0.0, steep, row.end_time_s)))
    c.report("table speed", row.end_time_s, i, -1, row.end_u_s, x.v);
}

}  // namespace

void verify_stops(VerifyContext& c) {
  std::size_t k = 0;
  const double tau = c.machine.clock.tau_s();
  const double ulps = kTickUlps + static_cast<double>(c.pauses.size());  // every pause adds its rounding
  for (std::size_t i = 0; i < c.path.size() && !c.full(); ++i) {
    const bool end = i + 1 == c.path.size();
    const bool rapid = c.positions(i) || (!end && c.positions(i + 1));
    if (!c.path.segments[i].stop_at_end && !end && !rapid) continue;
    const double s = c.path.start_s_u[i + 1];
    double time = 0.0;
    if (!rests_at(c, s, k, time)) {
      c.report("rest at a stop", time, i, -1, s, s);
    } else if (c.machine.planner.whole_ticks) {
      const double off = std::fabs(time - std::floor(time / tau + 0.5) * tau);
      if (!(off <= kTickSlack_s + ulps * kUlp * time))
        c.report("whole ticks", time, i, -1, off, kTickSlack_s);
    }
  }
}

void verify_table(VerifyContext& c) {
  const std::vector<SegmentPlan>& rows = c.plan.segments;
  const std::vector<JerkPiece>& pieces = c.law.pieces;
  if (rows.size() != c.path.size())
    return c.report("table size", 0.0, 0, -1, static_cast<double>(rows.size()),
                    static_cast<double>(c.path.size()));
  StatedJumps jumps(c.plan, c.machine);
  HeldTimes held(c.pauses);
  double time = 0.0, speed = 0.0;
  std::size_t piece = 0;
  for (std::size_t i = 0; i < c.path.size() && !c.full(); ++i) {
    verify_row(c, i, time, speed, held.held_s(i));
    // where the speed jumps, the row tells the one before
    time = rows[i].end_time_s;
    const double jump = jumps.stated_jump_u_s(time);
    while (piece + 1 < pieces.size() &&
           (jump == 0.0 ? pieces[piece + 1].begin_s <= time : pieces[piece + 1].begin_s < time))
      ++piece;
    speed = rows[i].end_u_s + jump;
    const std::size_t size = c.path.size();
    const bool sampled = size <= c.options.whole_up_to || i % c.options.stride < c.options.window ||
                         i + c.options.window >= size;
    if (sampled) verify_row_end(c, i, pieces[piece]);
  }
}

}  // namespace kadr::planner
