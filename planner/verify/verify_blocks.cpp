#include "planner/verify/verify_blocks.h"

#include <algorithm>
#include <cmath>

#include "machine/machine.h"
#include "planner/verify/verify_context.h"
#include "planner/verify/verify_pauses.h"

namespace kadr::planner {
namespace {

// a block's end is a product and a sum; every pause before it adds its rounding
constexpr double kBlockUlps = 4.0;
constexpr double kBlockAccelUlps = 32.0;  // of a time: the acceleration that a jerk makes in it
// kl are numbers near 1: their products agree to this
constexpr double kSameFeed = 1e-9;

bool is_blockwise(const machine::MachineModel& machine) {
  return machine.planner.scheduler == machine::SchedulerKind::blockwise;
}

class BlockVerifier {
 public:
  explicit BlockVerifier(VerifyContext& context)
      : c_(context),
        law_(context.law),
        tau_s_(context.machine.clock.tau_s()),
        tick_ulps_(kBlockUlps + static_cast<double>(context.pauses.size())) {}

  void run() {
    for (std::size_t i = 0; i < c_.plan.segments.size() && !c_.full(); ++i) {
      const SegmentPlan& row = c_.plan.segments[i];
      check_row(i, row);
      check_diagram(i, row.end_time_s);
    }
  }

 private:
  void report(const char* what, double time, std::size_t segment, double value, double limit) {
    c_.report(what, time, segment, -1, value, limit);
  }

  void check_row(std::size_t i, const SegmentPlan& row) {
    const double time = row.end_time_s;
    const double off = std::fabs(time - std::floor(time / tau_s_ + 0.5) * tau_s_);
    if (c_.machine.planner.whole_ticks && !(off <= kTickSlack_s + tick_ulps_ * kUlp * time))
      report("whole ticks", time, i, off, kTickSlack_s);
    const bool sound = row.rule == TickRule::scale ? row.kl > 0.0 && row.kl <= 1.0 : row.kl == 1.0;
    if (!sound) report("kl", time, i, row.kl, 1.0);
  }

  /// The pieces of one block: they end with it, rise, then fall, and have no acceleration at the ends.
  void check_diagram(std::size_t i, double end_s) {
    while (piece_ < law_.pieces.size() && stands(law_.pieces[piece_])) ++piece_;
    const std::size_t first = piece_;
    bool falls = false;
    for (; piece_ < law_.pieces.size() && law_.pieces[piece_].begin_s < end_s; ++piece_) {
      if (stands(law_.pieces[piece_]) && begins_at(law_.pieces[piece_], end_s)) break;  // a pause behind it
      const JerkPiece& p = law_.pieces[piece_];
      const double change = verified_state(p, p.duration_s).v - p.speed_u_s;
      const double tolerance = c_.options.relative_tolerance * c_.top_speed_u_s();
      if (change > tolerance && falls) report("block diagram", p.begin_s, i, change, 0.0);
      falls = falls || change < -tolerance;
    }
    if (first == piece_) return report("block without pieces", end_s, i, 0.0, 1.0);
    const JerkPiece& p = law_.pieces[piece_ - 1];
    const double gap = std::fabs(p.begin_s + p.duration_s - end_s);
    if (!(gap <= kBlockUlps * kUlp * end_s)) report("block end inside a piece", end_s, i, gap, 0.0);
    if (!c_.jerk_limited(i)) return;
    check_rest_of_accel(i, law_.pieces[first], 0.0);
    check_rest_of_accel(i, p, p.duration_s);
  }

  static bool begins_at(const JerkPiece& p, double time_s) {
    return std::fabs(p.begin_s - time_s) <= kBlockUlps * kUlp * time_s;
  }

  void check_rest_of_accel(std::size_t i, const JerkPiece& p, double t) {
    const double accel = std::fabs(verified_state(p, t).a);
    const double jerk = std::fabs(p.jerk_u_s3);
    const double tolerance = c_.options.relative_tolerance * (std::fabs(p.accel_u_s2) + jerk * p.duration_s) +
                             kBlockAccelUlps * kUlp * p.begin_s * jerk;
    if (!(accel <= tolerance)) report("acceleration at a block end", p.begin_s + t, i, accel, tolerance);
  }

  VerifyContext& c_;
  const MotionLaw& law_;
  double tau_s_;
  double tick_ulps_;
  std::size_t piece_ = 0;
};

}  // namespace

VerifiedState verified_state(const JerkPiece& p, double t) {
  if (p.quintic_rise_u_s != 0.0) {
    const double d = p.quintic_rise_u_s, T = p.duration_s, x = t / T;
    const double x2 = x * x, x3 = x2 * x, x4 = x3 * x, x5 = x4 * x, x6 = x5 * x;
    return {p.s_u + p.speed_u_s * t + d * T * (2.5 * x4 - 3.0 * x5 + x6),
            p.speed_u_s + d * (10.0 * x3 - 15.0 * x4 + 6.0 * x5), d / T * (30.0 * x2 - 60.0 * x3 + 30.0 * x4),
            d / (T * T) * (60.0 * x - 180.0 * x2 + 120.0 * x3)};
  }
  const double j = p.jerk_u_s3;
  return {p.s_u + p.speed_u_s * t + p.accel_u_s2 * t * t / 2.0 + j * t * t * t / 6.0,
          p.speed_u_s + p.accel_u_s2 * t + j * t * t / 2.0, p.accel_u_s2 + j * t, j};
}

StatedJumps::StatedJumps(const FeedPlan& plan, const machine::MachineModel& machine)
    : plan_(plan), blockwise_(is_blockwise(machine)) {}

double StatedJumps::stated_jump_u_s(double time_s) {
  if (!blockwise_) return 0.0;
  const std::vector<SegmentPlan>& rows = plan_.segments;
  while (row_ > 0 && rows[row_ - 1].end_time_s >= time_s) --row_;
  while (row_ < rows.size() && rows[row_].end_time_s < time_s) ++row_;
  if (row_ + 1 >= rows.size() || rows[row_].end_time_s != time_s) return 0.0;
  const SegmentPlan& row = rows[row_];
  const double behind = (row.end_u_s + row.end_jump_u_s) * row.kl;
  const double before = row.end_u_s * rows[row_ + 1].kl;
  return std::fabs(behind - before) <= kSameFeed * before ? row.end_jump_u_s : 0.0;
}

void verify_blocks(VerifyContext& c) {
  if (is_blockwise(c.machine)) BlockVerifier(c).run();
}

}  // namespace kadr::planner
