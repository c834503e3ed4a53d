#include <algorithm>

#include "planner/feed_plan.h"

namespace kadr::planner {

MotionState MotionLaw::eval(double time_s, std::size_t& hint) const {
  if (pieces.empty() || time_s >= duration_s) {
    hint = pieces.empty() ? 0 : pieces.size() - 1;
    return {length_u, 0.0, 0.0, 0.0};
  }
  if (!(time_s > 0.0)) time_s = 0.0;
  // mostly this piece or one of the next few; a jump is found by halving
  if (hint >= pieces.size() || pieces[hint].begin_s > time_s) hint = 0;
  for (int i = 0; i < 8 && hint + 1 < pieces.size() && pieces[hint + 1].begin_s <= time_s; ++i) ++hint;
  if (hint + 1 < pieces.size() && pieces[hint + 1].begin_s <= time_s) {
    const auto it = std::upper_bound(pieces.begin() + static_cast<std::ptrdiff_t>(hint), pieces.end(), time_s,
                                     [](double t, const JerkPiece& p) { return t < p.begin_s; });
    hint = static_cast<std::size_t>(it - pieces.begin()) - 1;
  }
  const JerkPiece& p = pieces[hint];
  const double t = std::min(time_s - p.begin_s, p.duration_s);
  return {p.s_u + t * (p.speed_u_s + t * (0.5 * p.accel_u_s2 + t * p.jerk_u_s3 / 6.0)),
          std::max(p.speed_u_s + t * (p.accel_u_s2 + 0.5 * t * p.jerk_u_s3), 0.0),
          p.accel_u_s2 + t * p.jerk_u_s3, p.jerk_u_s3};
}

}  // namespace kadr::planner
