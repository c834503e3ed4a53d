#pragma once
#include <limits>
#include <vector>

#include "planner/verify/verify.h"

/// The part of verify() that knows about blocks: plans of the blockwise scheduler.
namespace kadr::planner {

inline constexpr double kUlp = std::numeric_limits<double>::epsilon();
/// A time this close to a control tick is on it, however early it is.
inline constexpr double kTickSlack_s = 1e-12;

struct VerifiedState {
  double s, v, a, j;
};
/// A piece's state t seconds after its beginning, from the definition in feed_plan.h.
VerifiedState verified_state(const JerkPiece& piece, double t);

/// Jumps of speed that a table of blocks states, and that kl explains (paper 003, eq. 3-4):
///   F_KK kl_i+1 - F_KK kl_i,  with the same F_KK before scaling on both sides
class StatedJumps {
 public:
  StatedJumps(const FeedPlan& plan, const machine::MachineModel& machine);
  /// The jump stated at exactly that time, or 0. Times have to ascend, except for small steps back.
  double stated_jump_u_s(double time_s);

 private:
  const FeedPlan& plan_;
  bool blockwise_;
  std::size_t row_ = 0;
};

class VerifyContext;

/// For planner.scheduler = blockwise, at every block end: a whole number of control ticks (where asked), and
/// acceleration zero on both sides where jerk is limited; within a block the feed first rises, then falls
/// (paper 003, Fig. 2 and 3). Does nothing for another scheduler.
void verify_blocks(VerifyContext& c);

}  // namespace kadr::planner
