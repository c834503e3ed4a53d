#pragma once
#include <cstdint>
#include <vector>

#include "planner/laws/feed_plan.h"
#include "planner/limits/ramp.h"

namespace kadr::planner {

/// Turns elements into pieces of the law and keeps the time, exactly where a run has whole ticks.
class PieceWriter {
 public:
  explicit PieceWriter(MotionLaw& law) : law_(law) {}
  /// Appends one run.
  /// @param stretch    factor on all its times: v/k, a/k^2, j/k^3
  /// @param end_time_s its prescribed end, or a negative number: what the elements last
  void add(const std::vector<Element>& run, double stretch, double end_time_s);
  /// Appends a run that is pieces already, of constant jerk; their own beginnings do not count.
  void add(const std::vector<JerkPiece>& run, double stretch, double end_time_s);
  /// Stands at s until a time that is not before the present one.
  void rest(double s_u, double end_time_s);
  double time_s() const { return time_s_; }

 private:
  void piece(double duration, double s, double v, double a, double j, Signature why, double rise = 0.0);
  void ramp(const Element& e);
  void end_at(double end_time_s);

  MotionLaw& law_;
  double stretch_ = 1.0;
  double time_s_ = 0;
  double lost_s_ = 0;  // compensation of the running sum
};

/// Fills the table of segments from a finished law: peak, end and times of each.
void fill_segment_table(const Path& path, const PathLimitTable& table, FeedPlan& plan);

}  // namespace kadr::planner
