#include "planner/override/feed_terrain.h"

#include <algorithm>
#include <cmath>

#include "machine/machine.h"

namespace kadr::planner {
namespace {

using machine::kInfinity;
using machine::LockedFeed;

constexpr int kReachRounds = 12;
constexpr double kReachMargin = 1.25;

bool all_equal(const std::vector<double>& v) {
  return std::adjacent_find(v.begin(), v.end(), std::not_equal_to<>()) == v.end();
}

/// Moves at 100 % whatever the override keep their programmed feed as a hard cap.
PathLimitTable with_fixed_feeds(const Path& path, PathLimitTable table, const std::array<bool, 3>& fixed) {
  for (std::size_t i = 0; i < path.size(); ++i) {
    const PathSegment& segment = path.segments[i];
    if (segment.rapid || !fixed[static_cast<std::size_t>(segment.lock)]) continue;
    for (const std::size_t place : {2 * i, 2 * i + 1, 2 * i + 2}) {
      if (table.cap_u_s[place] <= segment.feed_u_s) continue;
      table.cap_u_s[place] = segment.feed_u_s;
      table.signature[place] = {LimitedBy::program, -1};
    }
  }
  return table;
}

std::vector<double> scaled_feeds(const Path& path, const std::array<bool, 3>& fixed) {
  std::vector<double> feeds(path.size(), kInfinity);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const PathSegment& segment = path.segments[i];
    if (!segment.rapid && !fixed[static_cast<std::size_t>(segment.lock)]) feeds[i] = segment.feed_u_s;
  }
  return feeds;
}

std::vector<double> rapid_caps(const Path& path, const PathLimitTable& table) {
  std::vector<double> caps(path.size(), kInfinity);
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path.segments[i].rapid) caps[i] = table.cap_u_s[2 * i + 1];
  return caps;
}

/// Before a locked move that follows without a stop: its feed, below which an override does not go.
std::vector<double> lead_ins(const Path& path) {
  std::vector<double> least(path.size(), 0.0);
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const PathSegment& segment = path.segments[i];
    const PathSegment& next = path.segments[i + 1];
    if (segment.lock == FeedLock::none && next.lock == FeedLock::thread && !segment.stop_at_end &&
        !segment.rapid)
      least[i] = std::min(segment.feed_u_s, next.feed_u_s);
  }
  return least;
}

/// Path in which acceleration that grows as fast as it may, from 0, takes the speed from low to high: no ramp
/// that ends (or begins) at low with acceleration 0 is faster.
double rising_u(double low, double high, RampLimits l) {
  const double dv = high - low;
  const double a2 = l.accel_u_s2 * l.accel_u_s2;
  if (!(2.0 * dv * l.jerk_u_s3 > a2)) {
    const double t = std::sqrt(2.0 * dv / l.jerk_u_s3);
    return t * (low + l.jerk_u_s3 * t * t / 6.0);
  }
  const double t = l.jerk_u_s3 < kInfinity ? l.accel_u_s2 / l.jerk_u_s3 : 0.0;
  const double v = low + 0.5 * l.accel_u_s2 * t;  // where acceleration is reached
  const double first = t > 0.0 ? t * (low + l.accel_u_s2 * t / 6.0) : 0.0;
  return first + 0.5 * (high - v) * (high + v) / l.accel_u_s2;
}

/// Path after which a ramp up from low to high has a speed between them.
double speed_at_u(double low, double high, RampLimits l, double speed) {
  const double dv = high - low;
  if (!(l.jerk_u_s3 < kInfinity)) return rising_u(low, speed, l);
  const double a2 = l.accel_u_s2 * l.accel_u_s2;
  const double rounded = 0.5 * (dv * l.jerk_u_s3 > a2 ? a2 / l.jerk_u_s3 : dv);  // of dv, at either end
  if (high - speed >= rounded) return rising_u(low, speed, l);
  const double left = std::sqrt(2.0 * (high - speed) / l.jerk_u_s3);
  return ramp_length_u(low, high, l) - left * (high - l.jerk_u_s3 * left * left / 6.0);
}

}  // namespace

FeedTerrain::FeedTerrain(const Path& path, const machine::MachineModel& machine, PathLimitTable table)
    : path_(path),
      proportional_(machine.feed_override.mode == machine::OverrideMode::proportional),
      fixed_{false, machine.feed_override.locked == LockedFeed::full,
             machine.feed_override.disabled == LockedFeed::full},
      table_(with_fixed_feeds(path, std::move(table), fixed_)),
      feed_u_s_(scaled_feeds(path, fixed_)),
      rapid_u_s_(rapid_caps(path, table_)),
      least_u_s_(lead_ins(path)),
      caps_(table_.cap_u_s),
      feeds_(feed_u_s_),
      rapids_(rapid_u_s_),
      accels_(table_.accel_u_s2),
      jerks_(table_.jerk_u_s3) {
  uniform_ = all_equal(table_.accel_u_s2) && all_equal(table_.jerk_u_s3);
  for (std::size_t joint = 0; joint <= path.size(); ++joint)
    if (table_.cap_u_s[2 * joint] == 0.0) stops_.push_back(joint);
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path.segments[i].lock == FeedLock::thread &&
        (i + 1 == path.size() || path.segments[i + 1].lock != FeedLock::thread))
      lock_ends_.push_back(i + 1);
}

/// Proportional mode: the lowest of the segments that meet at a place.
double FeedTerrain::factor(std::size_t place, const Percent& percent) const {
  const auto of = [&](std::size_t i) {
    const PathSegment& s = path_.segments[i];
    if (s.rapid) return percent.rapid;
    return fixed_[static_cast<std::size_t>(s.lock)] ? 1.0
           : s.lock != FeedLock::none               ? percent.frozen
                                                    : percent.feed;
  };
  const std::size_t segment = place / 2;
  double ratio = segment < path_.size() ? of(segment) : of(segment - 1);
  if (place % 2 == 0 && segment > 0) ratio = std::min(ratio, of(segment - 1));
  return ratio;
}

double FeedTerrain::target_u_s(std::size_t segment, const Percent& percent) const {
  const PathSegment& s = path_.segments[segment];
  if (s.rapid) return percent.rapid < 1.0 ? rapid_u_s_[segment] * percent.rapid : kInfinity;
  const double feed = feed_u_s_[segment];
  if (feed == kInfinity) return kInfinity;
  if (s.lock != FeedLock::none) return feed * percent.frozen;
  return percent.feed > 0.0 ? std::max(feed * percent.feed, least_u_s_[segment]) : 0.0;
}

double FeedTerrain::cap_u_s(std::size_t place, const Percent& percent) const {
  double cap = table_.cap_u_s[place];
  const std::size_t segment = place / 2;
  if (proportional_) return cap * factor(place, percent);
  if (segment < path_.size()) cap = std::min(cap, target_u_s(segment, percent));
  if (place % 2 == 0 && segment > 0) cap = std::min(cap, target_u_s(segment - 1, percent));
  return cap;
}

Signature FeedTerrain::cap_reason(std::size_t segment, const Percent& percent) const {
  if (proportional_) {
    const double ratio = factor(2 * segment + 1, percent);
    if (ratio == 0.0) return {LimitedBy::hold, -1};
    return ratio == 1.0 ? table_.signature[2 * segment + 1] : Signature{LimitedBy::override_percent, -1};
  }
  const double target = target_u_s(segment, percent);
  const Signature& hard = table_.signature[2 * segment + 1];
  const double ratio = path_.segments[segment].rapid ? percent.rapid : percent.feed;
  if (target < table_.cap_u_s[2 * segment + 1] || hard.reason == LimitedBy::program) {
    if (target == 0.0) return {LimitedBy::hold, -1};
    return {ratio == 1.0 || locked(segment) ? LimitedBy::program : LimitedBy::override_percent, -1};
  }
  return hard;
}

std::size_t FeedTerrain::run_end(std::size_t segment) const {
  return *std::upper_bound(stops_.begin(), stops_.end(), segment) - 1;
}

std::size_t FeedTerrain::segment_at(double s_u, std::size_t from) const {
  const std::vector<double>& start = path_.start_s_u;
  std::size_t low = from, step = 1;
  while (low + step < path_.size() && start[low + step] <= s_u) low += step, step *= 2;
  std::size_t high = std::min(low + step, path_.size());
  while (high - low > 1) {
    const std::size_t mid = low + (high - low) / 2;
    (start[mid] <= s_u ? low : high) = mid;
  }
  return low;
}

RampLimits FeedTerrain::limits(std::size_t first, std::size_t last) const {
  if (uniform_) return {table_.accel_u_s2.front(), table_.jerk_u_s3.front()};
  return {accels_.min(first, last), jerks_.min(first, last)};
}

std::size_t FeedTerrain::next_at_most(double level, std::size_t from, std::size_t last,
                                      const Percent& percent) const {
  const double lowest = std::min({percent.feed, percent.frozen, percent.rapid, 1.0});
  if (proportional_) return caps_.find_at_most(lowest > 0.0 ? level / lowest : 1e300, from, last);
  std::size_t best = caps_.find_at_most(level, from, last);
  const std::size_t segment = from / 2;  // the joint before a segment has its cap already
  const std::size_t most = path_.size() - 1;
  if (segment > most) return best;
  const double ratio = std::min(percent.feed, percent.frozen);
  best = std::min(best, 2 * feeds_.find_at_most(ratio > 0.0 ? level / ratio : 1e300, segment, most));
  if (percent.rapid < 1.0)
    best = std::min(
        best, 2 * rapids_.find_at_most(percent.rapid > 0.0 ? level / percent.rapid : 1e300, segment, most));
  return std::min(std::max(best, from), last + 1);
}

bool FeedTerrain::valleys(std::size_t segment, double below_u_s, double until_u, const Percent& percent,
                          std::vector<Valley>& out) const {
  out.clear();
  const std::size_t last = 2 * (run_end(segment) + 1);
  // a cap that is lower by rounding alone is no valley
  constexpr double kLower = 1.0 - 1e-12;
  double level = below_u_s;
  // a thread keeps its feed to its end: an override takes effect after it
  const auto lock_end = std::upper_bound(lock_ends_.begin(), lock_ends_.end(), segment);
  const std::size_t free_places = lock_end == lock_ends_.end() ? last + 1 : 2 * *lock_end;
  const Percent behind{std::max(percent.feed, 1.0), std::max(percent.rapid, 1.0),
                       std::max(percent.frozen, 1.0)};
  for (std::size_t place = 2 * (segment + 1); place <= last && level > 0.0; ++place) {
    place = next_at_most(level * kLower, place, last, percent);
    if (place > last) return false;
    const double s = path_.start_s_u[place / 2];
    if (s > until_u) return true;
    const double cap = cap_u_s(place, place < free_places ? percent : behind);
    if (!(cap < level * kLower)) continue;
    out.push_back({place, s, cap, cap == table_.cap_u_s[place]});
    level = cap;
  }
  return false;
}

void FeedTerrain::thin_out(std::vector<Valley>& valleys, double scale) const {
  if (valleys.size() < 2) return;
  std::size_t kept = valleys.size() - 1;  // valleys [kept, size) stay; they are moved up from behind
  std::size_t next = kept;                // the first of them that is not tight
  for (std::size_t k = kept; k-- > 0;) {
    Valley valley = valleys[k];
    const Valley& after = valleys[next];
    const double way = after.s_u - valley.s_u;
    RampLimits l;
    valley.tight = braking_u(valley.cap_u_s, after, scale, l) > way;
    l = scaled(valley.place / 2, (after.place - 1) / 2, scale);
    for (std::size_t t = kept; t < next && !valley.tight; ++t)
      valley.tight = passes_above(valley.cap_u_s, valley.s_u, valleys[t], after, scale);
    if (valley.tight && !(rising_u(after.cap_u_s, valley.cap_u_s, l) < way)) continue;
    valleys[--kept] = valley;
    if (!valley.tight) next = kept;
  }
  valleys.erase(valleys.begin(), valleys.begin() + static_cast<std::ptrdiff_t>(kept));
}

bool FeedTerrain::passes_above(double w, double begin_u, const Valley& tight, const Valley& next,
                               double scale) const {
  RampLimits l;
  if (next.s_u - braking_u(w, next, scale, l) < begin_u) return true;
  // backwards from the next valley the ramp rises
  return w > tight.cap_u_s && speed_at_u(next.cap_u_s, w, l, tight.cap_u_s) < next.s_u - tight.s_u;
}

RampLimits FeedTerrain::scaled(std::size_t first, std::size_t last, double scale) const {
  const RampLimits l = limits(first, last);
  return {l.accel_u_s2 * scale, l.jerk_u_s3 * scale};
}

double FeedTerrain::limit_scale(const Percent& percent, std::size_t segment, double speed_u_s) const {
  if (!proportional_) return 1.0;
  const double ratio = factor(2 * segment + 1, percent);
  // a hold is not multiplied by zero
  return ratio > 0.0 ? std::max(ratio, speed_u_s / table_.cap_u_s[2 * segment + 1]) : 1.0;
}

double FeedTerrain::braking_u(double w_u_s, const Valley& valley, double scale, RampLimits& ramp) const {
  const std::size_t last = (valley.place - 1) / 2;  // the segment that ends there
  ramp = scaled(last, last, scale);
  double length = ramp_length_u(valley.cap_u_s, w_u_s, ramp);
  std::size_t covered = last;
  for (int i = 0; i < kReachRounds && !uniform_; ++i) {
    if (covered == 0 || valley.s_u - length >= path_.start_s_u[covered]) return length;
    const double from = i + 1 == kReachRounds ? 0.0 : valley.s_u - kReachMargin * length;
    while (covered > 0 && path_.start_s_u[covered] > from) --covered;
    ramp = scaled(covered, last, scale);
    length = ramp_length_u(valley.cap_u_s, w_u_s, ramp);
  }
  return length;
}

}  // namespace kadr::planner
