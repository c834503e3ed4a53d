#include "planner/laws/pauses.h"

#include <algorithm>
#include <utility>

#include "machine/base/require.h"
#include "planner/path/path.h"

namespace kadr::planner {
namespace {

/// Copies a plan of motion piece by piece, with standstills between.
class PauseWriter {
 public:
  PauseWriter(FeedPlan& plan, std::size_t pauses) : plan_(plan) {
    pieces_.reserve(plan.law.pieces.size() + pauses);
  }

  /// Moves on to a joint: all before it begins later by the pauses so far.
  void go_to(std::size_t segment, std::size_t piece) {
    for (; segment_ < segment; ++segment_) {
      plan_.segments[segment_].begin_time_s += shift_s_;
      plan_.segments[segment_].end_time_s += shift_s_;
    }
    for (; piece_ < piece; ++piece_) {
      JerkPiece later = plan_.law.pieces[piece_];
      later.begin_s += shift_s_;
      // a later time has fewer bits: what was too short for it is left out
      if (!pieces_.empty() && pieces_.back().begin_s == later.begin_s) pieces_.pop_back();
      pieces_.push_back(later);
    }
  }

  void stand(double s_u, double hold_s) {
    JerkPiece pause;
    pause.begin_s = pieces_.empty() ? 0.0 : pieces_.back().begin_s + pieces_.back().duration_s;
    pause.duration_s = hold_s;
    pause.s_u = s_u;
    pause.limited_by = LimitedBy::stop;
    pieces_.push_back(pause);
    shift_s_ += hold_s;
  }

  void finish() {
    go_to(plan_.segments.size(), plan_.law.pieces.size());
    plan_.law.pieces = std::move(pieces_);
    plan_.law.duration_s += shift_s_;
    plan_.pause_s = shift_s_;
  }

 private:
  FeedPlan& plan_;
  std::vector<JerkPiece> pieces_;
  std::size_t segment_ = 0, piece_ = 0;  // the next ones to copy
  double shift_s_ = 0;
};

}  // namespace

void add_pauses(const Path& path, std::span<const Pause> pauses, std::span<const RunBegin> runs,
                FeedPlan& plan) {
  plan.motion_s = plan.law.duration_s;
  if (pauses.empty()) return;
  PauseWriter writer(plan, pauses.size());
  const std::size_t last = plan.law.pieces.size();
  std::size_t run = 0;
  for (const Pause& pause : pauses) {
    const std::size_t joint = pause.after_segment;
    require(pause.hold_s > 0.0 && joint <= path.size(), "a pause lasts, and has a joint of the path");
    while (run < runs.size() && runs[run].segment < joint) ++run;
    const bool begins = run < runs.size() && runs[run].segment == joint;
    require(begins || joint == path.size(), "the path rests where a pause is planned");
    writer.go_to(joint, begins ? runs[run].piece : last);
    writer.stand(path.size() == 0 ? 0.0 : path.start_s_u[joint], pause.hold_s);
  }
  writer.finish();
}

}  // namespace kadr::planner
