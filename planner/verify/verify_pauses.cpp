#include "planner/verify/verify_pauses.h"

#include <cmath>

#include "machine/machine.h"
#include "planner/verify/verify_context.h"

namespace kadr::planner {
namespace {

class PauseVerifier {
 public:
  explicit PauseVerifier(VerifyContext& context) : c_(context) {
    const machine::PlannerSettings& planner = c_.machine.planner;
    if (planner.scheduler == machine::SchedulerKind::blockwise && planner.whole_ticks)
      filling_s_ = c_.machine.clock.tau_s();
  }

  void run() {
    const std::vector<JerkPiece>& pieces = c_.law.pieces;
    for (std::size_t k = 0; k < pieces.size();) {
      const JerkPiece& first = pieces[k];
      double stood_s = 0;
      for (; k < pieces.size() && stands(pieces[k]); ++k) stood_s += pieces[k].duration_s;
      if (stood_s > 0)
        check_stand(first, stood_s);
      else
        ++k;
    }
    if (next_ < c_.pauses.size()) report("pause", c_.law.duration_s, 0.0, c_.pauses[next_].hold_s);
    check_sums();
  }

 private:
  double place_u(const Pause& pause) const {
    return c_.path.size() == 0 ? 0.0 : c_.path.start_s_u[pause.after_segment];
  }

  /// Pieces that stand, one after the other, against the pauses of one joint.
  void check_stand(const JerkPiece& first, double stood_s) {
    double asked_s = 0;
    if (next_ < c_.pauses.size() && std::fabs(place_u(c_.pauses[next_]) - first.s_u) <= c_.slack_u()) {
      const std::size_t joint = c_.pauses[next_].after_segment;
      for (; next_ < c_.pauses.size() && c_.pauses[next_].after_segment == joint; ++next_)
        asked_s += c_.pauses[next_].hold_s;
    }
    if (asked_s == 0.0 && between_copies(first.s_u)) return;
    const double tolerance = kHeldUlps * kUlp * (first.begin_s + stood_s);
    const double excess_s = stood_s - asked_s;
    if (!(excess_s >= -tolerance && excess_s <= filling_s_ + tolerance))
      report("pause", first.begin_s, stood_s, asked_s);
  }

  /// The copies of a shaped rapid need not overlap.
  bool between_copies(double s) const {
    if (c_.path.size() == 0) return false;
    const std::size_t i = c_.segment_at(s);
    return c_.positions(i) && s - c_.path.start_s_u[i] > c_.slack_u() &&
           c_.path.start_s_u[i + 1] - s > c_.slack_u();
  }

  void check_sums() {
    double sum_s = 0;
    for (const Pause& pause : c_.pauses) sum_s += pause.hold_s;
    const double tolerance = kHeldUlps * kUlp * (1.0 + static_cast<double>(c_.pauses.size()));
    const double all_s = c_.plan.motion_s + c_.plan.pause_s, law_s = c_.law.duration_s;
    if (!(std::fabs(c_.plan.pause_s - sum_s) <= tolerance * sum_s))
      report("time of all pauses", law_s, c_.plan.pause_s, sum_s);
    if (!(std::fabs(all_s - law_s) <= tolerance * law_s))
      report("time of motion and pauses", law_s, all_s, law_s);
  }

  void report(const char* what, double time_s, double value, double limit) {
    const std::size_t joint = next_ < c_.pauses.size() ? c_.pauses[next_].after_segment : c_.path.size();
    c_.report(what, time_s, joint > 0 ? joint - 1 : 0, -1, value, limit);
  }

  VerifyContext& c_;
  double filling_s_ = 0;  // that a stop may last unasked
  std::size_t next_ = 0;  // pause
};

}  // namespace

bool stands(const JerkPiece& p) {
  return p.speed_u_s == 0.0 && p.accel_u_s2 == 0.0 && p.jerk_u_s3 == 0.0 && p.quintic_rise_u_s == 0.0;
}

double HeldTimes::held_s(std::size_t after_segment) {
  double sum_s = 0;
  for (; next_ < pauses_.size() && pauses_[next_].after_segment <= after_segment; ++next_)
    sum_s += pauses_[next_].hold_s;
  return sum_s;
}

void verify_pauses(VerifyContext& c) {
  if (c.options.stands_at_pauses_alone) PauseVerifier(c).run();
}

}  // namespace kadr::planner
