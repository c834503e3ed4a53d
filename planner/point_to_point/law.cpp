#include "planner/point_to_point/law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "machine/base/require.h"

namespace kadr::planner {
namespace {

constexpr double kSameMoment = 1e-13;  ///< of the duration: edges closer than that are one
constexpr double kNothing = 1e-13;     ///< of the largest jump: a smaller sum of jumps is zero
constexpr double kEndTolerance = 1e-9;

/// Jumps cancel in exact arithmetic; here they leave a few units in the last place of the largest one.
double without_rest(double value, double largest) {
  return std::fabs(value) <= kNothing * largest ? 0.0 : value;
}

}  // namespace

PointState PointPiece::at(double t) const {
  return {position_u + t * (speed_u_s + t * (accel_u_s2 / 2 + t * jerk_u_s3 / 6)),
          speed_u_s + t * (accel_u_s2 + t * jerk_u_s3 / 2), accel_u_s2 + t * jerk_u_s3};
}

PointLaw PointLaw::from_edges(std::span<const PointEdge> edges, double distance_u) {
  require(edges.size() >= 2 && edges.size() <= kMostEdges, "a law has 2 to 72 edges");
  PointLaw law;
  std::array<PointEdge, kMostEdges> sorted{};
  std::copy(edges.begin(), edges.end(), sorted.begin());
  const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(edges.size());
  std::stable_sort(sorted.begin(), end,
                   [](const PointEdge& a, const PointEdge& b) { return a.time_s < b.time_s; });
  const double last_s = (end - 1)->time_s;
  double largest_accel = 0, largest_jerk = 0;
  for (auto e = sorted.begin(); e != end; ++e) {
    largest_accel = std::max(largest_accel, std::fabs(e->accel_u_s2));
    largest_jerk = std::max(largest_jerk, std::fabs(e->jerk_u_s3));
  }
  largest_accel = std::max(largest_accel, largest_jerk * last_s);
  // the running state; a piece ends where the next edge begins
  PointState now;
  double jerk = 0, time_s = 0;
  std::size_t count = 0;
  for (auto e = sorted.begin(); e != end;) {
    PointEdge joined = *e++;
    while (e != end && e->time_s - joined.time_s <= kSameMoment * last_s) {
      joined.accel_u_s2 += e->accel_u_s2;
      joined.jerk_u_s3 += e->jerk_u_s3;
      ++e;
    }
    if (count > 0) {
      law.pieces_[count - 1].duration_s = joined.time_s - time_s;
      now = law.pieces_[count - 1].at(joined.time_s - time_s);
    }
    time_s = joined.time_s;
    jerk = without_rest(jerk + joined.jerk_u_s3, largest_jerk);
    now.accel_u_s2 = without_rest(now.accel_u_s2 + joined.accel_u_s2, largest_accel);
    law.edges_[count] = joined;
    if (e != end) law.pieces_[count] = {time_s, 0, now.position_u, now.speed_u_s, now.accel_u_s2, jerk};
    ++count;
  }
  law.count_ = count - 1;
  law.duration_s_ = time_s;
  law.distance_u_ = distance_u;
  law.measure();
  require(law.edges_[0].time_s == 0.0 && law.count_ >= 1, "a law begins at 0 s and lasts");
  require(std::fabs(now.position_u - distance_u) <= kEndTolerance * distance_u, "a law covers its distance");
  require(std::fabs(now.speed_u_s) <= kEndTolerance * law.peak_speed_u_s_, "a law ends at rest");
  require(std::fabs(now.accel_u_s2) <= kEndTolerance * law.peak_accel_u_s2_ && jerk == 0.0,
          "a law ends without acceleration");
  return law;
}

void PointLaw::measure() {
  for (const PointPiece& p : pieces()) {
    const PointState end = p.at(p.duration_s);
    peak_speed_u_s_ = std::max({peak_speed_u_s_, p.speed_u_s, end.speed_u_s});
    peak_accel_u_s2_ = std::max({peak_accel_u_s2_, std::fabs(p.accel_u_s2), std::fabs(end.accel_u_s2)});
    peak_jerk_u_s3_ = std::max(peak_jerk_u_s3_, std::fabs(p.jerk_u_s3));
    // the speed peaks where the acceleration passes zero
    const double turn_s = p.jerk_u_s3 != 0.0 ? -p.accel_u_s2 / p.jerk_u_s3 : 0.0;
    if (turn_s > 0.0 && turn_s < p.duration_s)
      peak_speed_u_s_ = std::max(peak_speed_u_s_, p.at(turn_s).speed_u_s);
  }
  for (const PointEdge& e : edges())
    if (std::fabs(e.accel_u_s2) > kEndTolerance * peak_accel_u_s2_)
      peak_jerk_u_s3_ = std::numeric_limits<double>::infinity();
}

PointState PointLaw::at(double time_s) const {
  if (time_s >= duration_s_) return {distance_u_, 0, 0};
  if (time_s <= 0.0) return {};
  const auto all = pieces();
  std::size_t i = all.size() - 1;
  while (i > 0 && all[i].begin_s > time_s) --i;
  return all[i].at(time_s - all[i].begin_s);
}

}  // namespace kadr::planner
