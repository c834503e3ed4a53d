#pragma once
#include <cstddef>
#include <span>

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

class VerifyContext;

/// The law stands at every pause, as long as it asks for, and nowhere else, except that a blockwise plan may
/// stand for a part of a control tick to fill it, and a shaped rapid between its copies. Times of the plan
/// add up to the law's.
void verify_pauses(VerifyContext& c);

}  // namespace kadr::planner
