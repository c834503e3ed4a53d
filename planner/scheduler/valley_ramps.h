#pragma once
#include <cstddef>

#include "planner/limits/limits.h"
#include "planner/limits/ramp.h"
#include "planner/limits/range_min.h"

namespace kadr::planner {

/// A point of the plan where acceleration is zero. `place` is the joint (even) or segment (odd) in which s lies.
struct Anchor {
  double s = 0;
  double v = 0;
  std::size_t place = 0;
  std::size_t first_inside() const { return place + (place % 2 == 0 ? 1 : 0); }
  std::size_t last_inside() const { return place - (place % 2 == 0 ? 1 : 0); }
};

struct Ramp {
  double length = 0;
  RampLimits limits{0, 0};
};

/// The places of a path between which ramps run, and how far they do. Places as in PathLimitTable.
class ValleyRamps {
 public:
  /// Both outlive it.
  ValleyRamps(const Path& path, const PathLimitTable& table);

  const Path& path;
  const PathLimitTable& table;
  const RangeMin caps;

  double begin_of(std::size_t place) const { return path.start_s_u[place / 2]; }
  double end_of(std::size_t place) const { return path.start_s_u[(place + 1) / 2]; }
  /// Place of s, which is known to lie between two places: galloping from the first, then halving.
  std::size_t locate_after(double s, std::size_t from_place, std::size_t to_place) const;
  std::size_t locate_before(double s, std::size_t from_place, std::size_t to_place) const;
  Anchor anchor_after(const Anchor& a, double distance, double v, const Anchor& b) const;
  Anchor anchor_before(const Anchor& b, double distance, double v, const Anchor& a) const;

  /// Every segment has the same limits.
  bool uniform() const { return uniform_; }
  /// Lowest limits of the segments [first, last].
  RampLimits limits_between(std::size_t first, std::size_t last) const;
  /// Ramp between a.v and w that begins at a and goes towards b: grows until the segments it spans carry it.
  Ramp ramp_from(const Anchor& a, double w, const Anchor& b) const;
  /// The same for a ramp that ends at b, grown backwards towards a.
  Ramp ramp_to(const Anchor& b, double w, const Anchor& a) const;
  static Ramp make_ramp(double v, double w, RampLimits limits);

 private:
  RangeMin accels_, jerks_;
  bool uniform_;
};

}  // namespace kadr::planner
