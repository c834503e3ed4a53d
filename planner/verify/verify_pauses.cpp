#include "planner/verify/verify_pauses.h"

#include <cmath>

#include "machine/machine.h"
#include "planner/path/path.h"
#include "planner/verify/verify_blocks.h"

namespace kadr::planner {
namespace {

class PauseVerifier {
 public:
  PauseVerifier(const Path& path, const FeedPlan& plan, const machine::MachineModel& machine,
                std::span<const Pause> pauses, double slack_u, const std::function<bool(double)>& may_stand,
                const VerifyOptions& options, std::vector<Violation>& found)
      : path_(path),
        plan_(plan),
        pauses_(pauses),
        slack_u_(slack_u),
        may_stand_(may_stand),
        options_(options),
        found_(found) {
    const bool fills_ticks =
        machine.planner.scheduler == machine::SchedulerKind::blockwise && machine.planner.whole_ticks;
    if (fills_ticks) filling_s_ = machine.clock.tau_s();
  }

  void run() {
    const std::vector<JerkPiece>& pieces = plan_.law.pieces;
    for (std::size_t k = 0; k < pieces.size();) {
      double stood_s = 0;
      const JerkPiece& first = pieces[k];
      for (; k < pieces.size() && stands(pieces[k]); ++k) stood_s += pieces[k].duration_s;
      if (stood_s > 0)
        check_stand(first, stood_s);
      else
        ++k;
    }
    if (next_ < pauses_.size()) report("pause", plan_.law.duration_s, 0.0, pauses_[next_].hold_s);
    double sum_s = 0;
    for (const Pause& pause : pauses_) sum_s += pause.hold_s;
    const double tolerance = kHeldUlps * kUlp * (1.0 + static_cast<double>(pauses_.size()));
    if (!(std::fabs(plan_.pause_s - sum_s) <= tolerance * sum_s))
      report("time of all pauses", plan_.law.duration_s, plan_.pause_s, sum_s);
    const double all_s = plan_.motion_s + plan_.pause_s;
    if (!(std::fabs(all_s - plan_.law.duration_s) <= tolerance * plan_.law.duration_s))
      report("time of motion and pauses", plan_.law.duration_s, all_s, plan_.law.duration_s);
  }

 private:
  double place_u(const Pause& pause) const {
    return path_.size() == 0 ? 0.0 : path_.start_s_u[pause.after_segment];
  }

  /// Pieces that stand, one after the other, against the pauses of one joint.
  void check_stand(const JerkPiece& first, double stood_s) {
    double asked_s = 0;
    if (next_ < pauses_.size() && std::fabs(place_u(pauses_[next_]) - first.s_u) <= slack_u_) {
      const std::size_t joint = pauses_[next_].after_segment;
      for (; next_ < pauses_.size() && pauses_[next_].after_segment == joint; ++next_)
        asked_s += pauses_[next_].hold_s;
    }
    if (asked_s == 0.0 && may_stand_(first.s_u)) return;
    const double tolerance = kHeldUlps * kUlp * (first.begin_s + stood_s);
    const double excess_s = stood_s - asked_s;
    if (!(excess_s >= -tolerance && excess_s <= filling_s_ + tolerance))
      report("pause", first.begin_s, stood_s, asked_s);
  }

  void report(const char* what, double time_s, double value, double limit) {
    const std::size_t joint = next_ < pauses_.size() ? pauses_[next_].after_segment : path_.size();
    const std::size_t segment = joint > 0 ? joint - 1 : 0;
    if (found_.size() < options_.most)
      found_.push_back({what, time_s, static_cast<std::uint32_t>(segment), -1, value, limit});
  }

  const Path& path_;
  const FeedPlan& plan_;
  std::span<const Pause> pauses_;
  double slack_u_;
  const std::function<bool(double)>& may_stand_;
  const VerifyOptions& options_;
  std::vector<Violation>& found_;
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

void verify_pauses(const Path& path, const FeedPlan& plan, const machine::MachineModel& machine,
                   std::span<const Pause> pauses, double slack_u,
                   const std::function<bool(double)>& may_stand, const VerifyOptions& options,
                   std::vector<Violation>& found) {
  PauseVerifier(path, plan, machine, pauses, slack_u, may_stand, options, found).run();
}

}  // namespace kadr::planner
