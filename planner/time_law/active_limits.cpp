#include "planner/time_law/active_limits.h"

#include <cmath>

#include "machine/base/require.h"

namespace kadr::planner {

std::vector<ActiveLimit> active_limits(const LawProblem& p, const std::vector<double>& v, double within) {
  require(v.size() == p.nodes(), "a law has a speed for every node");
  const std::vector<NodeCap> caps = node_caps(p);
  const AccelRows rows = accel_rows(p);
  std::vector<ActiveLimit> out(p.nodes() - 1);
  for (std::size_t i = 1; i < p.nodes(); ++i) {
    ActiveLimit& found = out[i - 1];
    if (v[i] > 0.0 && v[i] >= caps[i].speed_u_s * (1.0 - within)) {
      found = {ActiveLimit::Kind::speed, caps[i].reason};
      continue;
    }
    double most = 1.0 - within;
    for (std::size_t r = 0; r < rows.per_interval; ++r) {
      const std::size_t at = i * rows.per_interval + r;
      const double used = std::fabs(rows.before[at] * v[i - 1] * v[i - 1] + rows.after[at] * v[i] * v[i]);
      if (!(used >= most)) continue;
      most = used;
      // rows of an interval: the path, the axes at its end, and at its beginning
      found = r == 0 ? ActiveLimit{ActiveLimit::Kind::path_acceleration, 0}
                     : ActiveLimit{ActiveLimit::Kind::axis_acceleration,
                                   static_cast<std::int32_t>((r - 1) % p.axes)};
    }
  }
  return out;
}

}  // namespace kadr::planner
