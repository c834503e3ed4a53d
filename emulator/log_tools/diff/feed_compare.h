#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "emulator/log/log_reader.h"

namespace kadr::log_tools {

/// Path and feed at the end of a control tick.
struct FeedPoint {
  double path_u = 0;
  double feed_u_s = 0;
  double accel_u_s2 = 0;
  double tau_s = 0;  ///< length of the control tick
  Ticks tick;        ///< its end
  double override_used = 1;
  std::int8_t limited_by = 0;
  std::shared_ptr<const log::BlockRecord> block;  ///< under way
};

/// A stretch of the path on which the feeds differ by more than the tolerance.
struct FeedSpan {
  double from_u = 0, to_u = 0;  ///< path length at the first and the last position that differ
  FeedPoint a, b;               ///< at `from_u`; the feed of one is interpolated
  double largest_u_s = 0;       ///< |b - a|
  double largest_at_u = 0;
};

/// Compares two feeds at equal path length: at the end of every control tick of either log.
///
/// The other log's feed there is that of constant acceleration between its control ticks:
///   v^2 = v0^2 + (v1^2 - v0^2) (s - s0) / (s1 - s0)
/// If its acceleration changes by da within that tick of length tau, this is wrong by at most da tau / 4,
/// which is added to the tolerance. A stretch that differs ends where the difference is below half of that sum.
class FeedCompare {
 public:
  /// @param tolerance_u_s  >= 0
  explicit FeedCompare(double tolerance_u_s) : tolerance_u_s_(tolerance_u_s) {}
  /// The next control tick of log A (side 0) or B (side 1); path_u never runs back.
  void add(int side, const FeedPoint& point);
  void finish();
  /// Stretches that have ended since the last call, in order.
  std::vector<FeedSpan> take();

  std::int64_t spans() const { return spans_; }
  double length_u() const { return length_u_; }  ///< of all stretches together
  const std::optional<FeedSpan>& largest() const { return largest_; }

 private:
  void match();
  void compare(const FeedPoint& a, const FeedPoint& b, double slack_u_s);
  void end_span();

  double tolerance_u_s_;
  FeedPoint last_[2];  // after every point that waits
  std::deque<FeedPoint> waiting_[2];
  std::optional<FeedSpan> span_, largest_;
  std::vector<FeedSpan> found_;
  std::int64_t spans_ = 0;
  double length_u_ = 0;
};

}  // namespace kadr::log_tools
