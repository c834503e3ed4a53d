#include <algorithm>
#include <cmath>

#include "machine/machine.h"
#include "planner/verify/verify_context.h"
#include "planner/verify/verify_pauses.h"

namespace kadr::planner {
namespace {

/// A piece's beginning is a sum: the rounding of its last terms.
constexpr double kTimeUlps = 4.0;
constexpr double kAccelUlps = 32.0;

/// Whether a piece ends at a time; each of many pauses at one joint adds its rounding to the last one's end.
bool ends_at(const VerifyContext& c, const JerkPiece& p, double time_s) {
  const double ulps = kTimeUlps + (stands(p) ? static_cast<double>(c.pauses.size()) : 0.0);
  return std::fabs(p.begin_s + p.duration_s - time_s) <= ulps * kUlp * time_s;
}

/// A quintic ramp's jerk is zero at both ends; rapids and time laws are not made of such ramps.
bool has_ramps_of_law(const VerifyContext& c, double s_u) {
  const bool by_law = machine::facts(c.machine.planner.method).is_law &&
                      c.machine.planner.scheduler == machine::SchedulerKind::chained;
  return !by_law && !c.positions(c.segment_at(s_u));
}

void verify_link(VerifyContext& c, StatedJumps& jumps, const JerkPiece& p, const JerkPiece& q) {
  const VerifiedState end = verified_state(p, p.duration_s);
  const double time = q.begin_s;
  const auto report = [&](const char* what, double value, double limit) {
    c.report(what, time, c.segment_at(q.s_u), -1, value, limit);
  };
  if (!ends_at(c, p, time)) report("gap in time", p.begin_s + p.duration_s, time);
  if (!(std::fabs(end.s - q.s_u) <= c.way_tolerance_u(p, end))) report("continuity of s", end.s, q.s_u);
  const double steep = std::fabs(end.a) + std::fabs(end.j) * p.duration_s;
  const double jump = jumps.stated_jump_u_s(time);
  if (!(std::fabs(end.v + jump - q.speed_u_s) <= c.speed_tolerance(end.v, steep, time)))
    report("continuity of speed", end.v, q.speed_u_s);
  // acceleration may jump only where a segment at this place has no jerk limit
  // a piece may be far shorter than the control tick whose ramp it ends, and has the rounding of that ramp
  const double ramp_s = std::max(p.duration_s, c.machine.clock.tau_s());
  const double scale = std::max(std::fabs(p.accel_u_s2), std::fabs(q.accel_u_s2)) + std::fabs(end.j) * ramp_s;
  const double tolerance = c.options.relative_tolerance * scale + kAccelUlps * kUlp * time * std::fabs(end.j);
  if (!(std::fabs(end.a - q.accel_u_s2) <= tolerance) && c.jerk_limited_around(q.s_u))
    report("continuity of acceleration", end.a, q.accel_u_s2);
  const double begin_j = verified_state(q, 0.0).j;
  if (c.machine.planner.law == machine::RampLaw::quintic && (end.j != 0.0 || begin_j != 0.0) &&
      has_ramps_of_law(c, 0.5 * (p.s_u + end.s)) && has_ramps_of_law(c, q.s_u))
    report("continuity of jerk", end.j, begin_j);
}

}  // namespace

void verify_law_ends(VerifyContext& c) {
  const JerkPiece& first = c.law.pieces.front();
  const JerkPiece& last = c.law.pieces.back();
  const VerifiedState end = verified_state(last, last.duration_s);
  const std::size_t segment = c.path.size() - 1;
  const double duration = c.law.duration_s;
  if (first.begin_s != 0.0 || std::fabs(first.s_u) > 0.0)
    c.report("start", first.begin_s, 0, -1, first.s_u, 0.0);
  if (std::fabs(first.speed_u_s) > 0.0) c.report("rest at the start", 0.0, 0, -1, first.speed_u_s, 0.0);
  const double tolerance =
      c.speed_tolerance(0.0, std::fabs(end.a) + std::fabs(end.j) * last.duration_s, duration);
  if (!(std::fabs(end.v) <= tolerance)) c.report("rest at the end", duration, segment, -1, end.v, tolerance);
  if (!(std::fabs(end.s - c.path.length_u()) <= c.way_tolerance_u(last)) ||
      c.law.length_u != c.path.length_u())
    c.report("length", duration, segment, -1, end.s, c.path.length_u());
  if (!ends_at(c, last, duration))
    c.report("duration", duration, segment, -1, last.begin_s + last.duration_s, duration);
}

void verify_law_links(VerifyContext& c) {
  StatedJumps jumps(c.plan, c.machine);
  const std::vector<JerkPiece>& pieces = c.law.pieces;
  for (std::size_t k = 0; k < pieces.size() && !c.full(); ++k) {
    const JerkPiece& p = pieces[k];
    if (!(p.duration_s > 0.0))
      c.report("piece without duration", p.begin_s, c.segment_at(p.s_u), -1, p.duration_s, 0.0);
    if (k + 1 < pieces.size()) verify_link(c, jumps, p, pieces[k + 1]);
  }
}

}  // namespace kadr::planner
