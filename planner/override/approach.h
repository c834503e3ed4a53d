#pragma once
#include <cstddef>

#include "planner/laws/feed_plan.h"
#include "planner/limits/ramp.h"

namespace kadr::planner {

class FeedTerrain;

/// A ramp from a state to (w, a = 0); where acceleration points away from w it is brought to 0 first.
struct Approach {
  MotionState from{};     ///< where the ramp begins
  double flare_s = 0;     ///< time until then
  double flare_jerk = 0;  ///< during it
  RampLimits limits{0, 0};
  double virtual_u_s = 0;  ///< speed at which the ramp would have begun with a = 0
  double done_s = 0;       ///< elapsed time of it
  double end_u = 0;        ///< s at its end

  /// Takes limits for the ramp to w. @return whether the present acceleration fits into it
  bool ramp_on(double w_u_s, RampLimits limits);
  /// s at the end of the ramp to w.
  double reach_u(double w_u_s) const;
};

/// Where ramps begin, and what they may ask for.
struct ApproachStart {
  const FeedTerrain& terrain;
  const MotionState& state;
  std::size_t segment;
  RampLimits held;  ///< under which the state's acceleration can be brought to 0 in time
  double scale;     ///< on the terrain's limits
  double slack_u;   ///< lengths of the path closer than this are one
};
/// The ramp to w with the lowest limits of the segments that it runs over.
Approach approach(const ApproachStart& start, double w_u_s);

}  // namespace kadr::planner
