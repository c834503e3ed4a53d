#pragma once
#include <vector>

#include "emulator/log/records.h"
#include "planner/planner.h"

namespace kadr::cycle {

/// Finds where a run under an override takes longer than its plan at 100 %, tick by tick: the tick's length less the
/// planned time of the path it makes. The sum over all reasons is the difference of the two times; pauses are in both.
class LostTime {
 public:
  /// @param law  outlives this
  LostTime(const planner::MotionLaw& law, double tau_s) : law_(law), tau_s_(tau_s) {}
  /// A tick that is not a pause of the program.
  void add(const planner::TickMotion& motion, log::LostReason reason);
  /// Longest first; reasons that lost less than a microsecond are left out.
  std::vector<log::LimitShare> shares() const;

 private:
  double planned_s(double s_u);

  const planner::MotionLaw& law_;
  double tau_s_;
  std::size_t piece_ = 0;
  double moving_s_ = 0;  ///< of the pieces before `piece_`, pauses left out
  double reached_s_ = 0;
  struct Share {
    log::LostReason reason;
    double time_s;
  };
  std::vector<Share> shares_;  // in the order in which they came up
};

}  // namespace kadr::cycle
