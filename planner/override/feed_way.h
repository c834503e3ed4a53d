#pragma once
#include <cstddef>
#include <vector>

#include "planner/limits/ramp.h"
#include "planner/override/approach.h"

namespace kadr::planner {

/// A part of a decided way, of constant jerk.
struct FeedPiece {
  double duration_s = 0;
  MotionState begin{};
  RampLimits limits{0, 0};  ///< under which its acceleration can be brought to 0 in time
  Signature why;
  bool braking = false;  ///< for a valley: no override disturbs it
};

/// What a tracker has decided and runs: pieces one after the other, and where in them it is. A copy is
/// another way tried; storage is kept.
class FeedWay {
 public:
  FeedWay() { pieces_.reserve(16); }

  /// No way left: an empty one that begins at a state.
  void begin_at(const MotionState& state);
  void clear() { pieces_.clear(), at_ = 0; }
  /// Appends constant jerk. A piece of kForever_s does not end.
  void add(double duration_s, double jerk_u_s3, const RampLimits& limits, const Signature& why, bool braking);
  /// Appends an approach to w.
  /// @param held  limits under which the acceleration at its beginning came about
  void add(const Approach& approach, double w_u_s, const RampLimits& held, const Signature& why,
           bool braking);
  /// The way's end lies exactly at s; `place` is its joint, or 0.
  void end_at(double s_u, std::size_t place) { end_.s_u = s_u, end_place_ = place; }

  bool empty() const { return pieces_.empty(); }
  bool over() const { return at_ >= pieces_.size(); }
  const FeedPiece& now() const { return pieces_[at_]; }
  const FeedPiece& last() const { return pieces_.back(); }
  double in_piece_s() const { return in_piece_s_; }
  double left_s() const { return now().duration_s - in_piece_s_; }
  MotionState state() const;
  /// Moves on within the present piece.
  void go(double time_s) { in_piece_s_ += time_s; }
  /// @return whether there is a next piece
  bool next_piece() { return in_piece_s_ = 0, ++at_ < pieces_.size(); }

  const MotionState& end() const { return end_; }  ///< of the last piece, exact
  std::size_t end_place() const { return end_place_; }
  /// Speed at a length of the path that the pieces pass.
  double speed_at_u_s(double s_u) const;

  static constexpr double kForever_s = 1e300;

 private:
  std::vector<FeedPiece> pieces_;  // under way and decided
  std::size_t at_ = 0;
  double in_piece_s_ = 0;
  MotionState end_{};
  std::size_t end_place_ = 0;
};

}  // namespace kadr::planner
