#include "planner/scheduler/valley_ramps.h"

#include <algorithm>
#include <functional>

#include "planner/path/path.h"

namespace kadr::planner {
namespace {

/// A ramp grows over so many more stretches, each longer by the margin, then counts the whole region.
constexpr int kGrowRounds = 12;
constexpr double kGrowMargin = 1.25;

bool all_same(const std::vector<double>& v) {
  return std::adjacent_find(v.begin(), v.end(), std::not_equal_to<>()) == v.end();
}

}  // namespace

ValleyRamps::ValleyRamps(const Path& p, const PathLimitTable& t)
    : path(p), table(t), caps(t.cap_u_s), accels_(t.accel_u_s2), jerks_(t.jerk_u_s3) {
  uniform_ = all_same(t.accel_u_s2) && all_same(t.jerk_u_s3);
}

std::size_t ValleyRamps::locate_after(double s, std::size_t from_place, std::size_t to_place) const {
  const std::vector<double>& start = path.start_s_u;
  std::size_t low = from_place / 2;  // start[low] <= s
  const std::size_t most = (to_place + 1) / 2;
  std::size_t step = 1;
  while (low + step <= most && start[low + step] <= s) low += step, step *= 2;
  std::size_t high = std::min(low + step, most + 1);  // start[high] > s, or beyond
  while (high - low > 1) {
    const std::size_t mid = low + (high - low) / 2;
    (start[mid] <= s ? low : high) = mid;
  }
  return start[low] == s || low == most ? 2 * low : 2 * low + 1;
}

std::size_t ValleyRamps::locate_before(double s, std::size_t from_place, std::size_t to_place) const {
  const std::vector<double>& start = path.start_s_u;
  std::size_t high = (from_place + 1) / 2;  // start[high] >= s
  const std::size_t least = to_place / 2;
  std::size_t step = 1;
  while (high >= least + step && start[high - step] >= s) high -= step, step *= 2;
  std::size_t low = high >= least + step ? high - step : least;
  if (start[low] >= s) return 2 * low;
  while (high - low > 1) {
    const std::size_t mid = low + (high - low) / 2;
    (start[mid] >= s ? high : low) = mid;
  }
  return start[high] == s ? 2 * high : 2 * low + 1;
}

Anchor ValleyRamps::anchor_after(const Anchor& a, double distance, double v, const Anchor& b) const {
  const double s = std::min(a.s + distance, b.s);
  return {s, v, locate_after(s, a.place, b.place)};
}

Anchor ValleyRamps::anchor_before(const Anchor& b, double distance, double v, const Anchor& a) const {
  const double s = std::max(b.s - distance, a.s);
  return {s, v, locate_before(s, b.place, a.place)};
}

RampLimits ValleyRamps::limits_between(std::size_t first, std::size_t last) const {
  if (uniform_) return {table.accel_u_s2.front(), table.jerk_u_s3.front(), table.law};
  if (first == last) return {table.accel_u_s2[first], table.jerk_u_s3[first], table.law};
  return {accels_.min(first, last), jerks_.min(first, last), table.law};
}

Ramp ValleyRamps::ramp_from(const Anchor& a, double w, const Anchor& b) const {
  const std::size_t first = a.place / 2;
  if (uniform_) return make_ramp(a.v, w, limits_between(first, first));
  const std::size_t most = std::max(first, b.last_inside() / 2);
  std::size_t covered = first;
  Ramp r = make_ramp(a.v, w, limits_between(first, first));
  for (int i = 0; i < kGrowRounds; ++i) {
    if (covered == most || a.s + r.length <= path.start_s_u[covered + 1]) return r;
    const double reach = std::min(a.s + kGrowMargin * r.length, b.s);
    covered = std::min(locate_after(reach, a.place, b.place) / 2, most);
    r = make_ramp(a.v, w, limits_between(first, covered));
  }
  return make_ramp(a.v, w, limits_between(first, most));
}

Ramp ValleyRamps::ramp_to(const Anchor& b, double w, const Anchor& a) const {
  const std::size_t last = b.last_inside() / 2;
  if (uniform_) return make_ramp(b.v, w, limits_between(last, last));
  const std::size_t least = std::min(last, a.first_inside() / 2);
  std::size_t covered = last;
  Ramp r = make_ramp(b.v, w, limits_between(last, last));
  for (int i = 0; i < kGrowRounds; ++i) {
    if (covered == least || b.s - r.length >= path.start_s_u[covered]) return r;
    const double reach = std::max(b.s - kGrowMargin * r.length, a.s);
    const std::size_t place = locate_before(reach, b.place, a.place);
    covered = std::max(place % 2 == 0 && place > 0 ? place / 2 - 1 : place / 2, least);
    r = make_ramp(b.v, w, limits_between(covered, last));
  }
  return make_ramp(b.v, w, limits_between(least, last));
}

Ramp ValleyRamps::make_ramp(double v, double w, RampLimits limits) {
  return {ramp_length_u(std::min(v, w), std::max(v, w), limits), limits};
}

}  // namespace kadr::planner
