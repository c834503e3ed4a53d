#include "planner/scheduler/trapezoid.h"

#include <algorithm>
#include <cmath>

#include "machine/infinity.h"
#include "planner/path/path.h"

namespace kadr::planner {
namespace {

void add_hold(std::vector<Element>& out, double s, double length, double v, Signature why) {
  if (!out.empty() && out.back().is_hold() && out.back().v0_u_s == v && out.back().signature == why)
    out.back().length_u += length;
  else
    out.push_back({s, length, v, v, {0, 0}, why});
}

}  // namespace

void plan_trapezoids(const Path& path, const PathLimitTable& table, const Run& run,
                     std::vector<Element>& out) {
  const std::size_t n = run.last - run.first + 1;
  std::vector<double> v2(n + 1);  // squared speed at the joints
  const auto gain = [&](std::size_t i) {
    return 2.0 * table.accel_u_s2[run.first + i] * path.segments[run.first + i].length_u;
  };
  for (std::size_t i = 0; i <= n; ++i) {
    const double cap = i == 0 || i == n ? 0.0 : table.cap_u_s[2 * (run.first + i)];
    v2[i] = cap * cap;
  }
  for (std::size_t i = 0; i < n; ++i) v2[i + 1] = std::min(v2[i + 1], v2[i] + gain(i));
  for (std::size_t i = n; i-- > 0;) v2[i] = std::min(v2[i], v2[i + 1] + gain(i));

  const auto why_ramp = [&](std::size_t low_joint) {
    const Signature at = table.signature[2 * low_joint];
    return at.reason == LimitedBy::junction ? at : Signature{LimitedBy::length, -1};
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t seg = run.first + i;
    const double a = table.accel_u_s2[seg];
    const double s = path.start_s_u[seg];
    const double end = path.start_s_u[seg + 1];
    const double v0 = std::sqrt(v2[i]);
    const double v1 = std::sqrt(v2[i + 1]);
    const double reach = std::sqrt(0.5 * (v2[i] + v2[i + 1] + gain(i)));
    const double cap = table.cap_u_s[2 * seg + 1];
    const double peak = std::max(std::min(cap, reach), std::max(v0, v1));
    const RampLimits limits{a, machine::kInfinity};
    double up = (peak * peak - v2[i]) / (2.0 * a);
    double down = (peak * peak - v2[i + 1]) / (2.0 * a);
    // one ramp fills the segment up to rounding: no separate peak
    const double length = end - s;
    if (up >= length * (1.0 - 1e-14))
      up = length, down = 0.0;
    else if (down >= length * (1.0 - 1e-14))
      down = length, up = 0.0;
    const double top = up == length ? v1 : down == length ? v0 : peak;
    if (v0 < top) out.push_back({s, up, v0, top, limits, why_ramp(seg)});
    const double hold = std::max(length - up - down, 0.0);
    if (v0 < top && top > v1) {
      add_hold(out, s + up, hold, top,
               peak == cap ? table.signature[2 * seg + 1] : Signature{LimitedBy::length, -1});
    } else if (hold > 0.0) {
      add_hold(out, s + up, hold, top,
               peak == cap ? table.signature[2 * seg + 1] : Signature{LimitedBy::length, -1});
    }
    if (v1 < top) out.push_back({end - down, down, top, v1, limits, why_ramp(seg + 1)});
  }
}

}  // namespace kadr::planner
