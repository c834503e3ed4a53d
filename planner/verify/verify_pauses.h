#pragma once
#include <functional>
#include <span>
#include <vector>

#include "planner/verify/verify.h"

/// The part of verify() that knows what the program asks for where the path rests.
namespace kadr::planner {

/// Times beside a pause are sums of a few rounded ones.
inline constexpr double kHeldUlps = 8.0;

/// Whether the path stands still all along a piece.
bool stands(const JerkPiece& piece);

/// Sum of the pauses at each joint in turn.
class HeldTimes {
 public:
  explicit HeldTimes(std::span<const Pause> pauses) : pauses_(pauses) {}
  /// At the joint behind that many segments. Joints have to ascend.
  double held_s(std::size_t after_segment);

 private:
  std::span<const Pause> pauses_;
  std::size_t next_ = 0;
};

/// The law stands at every pause, as long as it asks for, and nowhere else, except that a blockwise plan may
/// stand for a part of a control tick to fill it. Times of the plan add up to the law's.
/// @param slack_u    lengths of the path closer than this are one
/// @param may_stand  whether a motion may stand at a length of the path for reasons of its own
void verify_pauses(const Path& path, const FeedPlan& plan, const machine::MachineModel& machine,
                   std::span<const Pause> pauses, double slack_u,
                   const std::function<bool(double)>& may_stand, const VerifyOptions& options,
                   std::vector<Violation>& found);

}  // namespace kadr::planner
