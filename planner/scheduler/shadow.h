#pragma once
#include "planner/scheduler/valley_ramps.h"

namespace kadr::planner {

/// A level above the lowest cap of a region: the ramps to it pass lower places while they are still below
/// those places' caps (the shadows of valley.h).
struct ShadowLevel {
  double w = 0;
  Ramp up, down;
  Anchor up_end, down_begin;
};

/// At which ends of a region the ramps may pass lower places.
struct ShadowSides {
  bool left, right;
};
/// Highest level whose ramps may pass places lower than it; false if nothing worthwhile is found.
/// @param m      the region's lowest cap
/// @param start  the level to begin with
bool find_level(const ValleyRamps& r, const Anchor& a, const Anchor& b, double m, double start,
                ShadowSides sides, ShadowLevel& found);

/// True if the ramp p -> q is at or below every cap inside it (q and p themselves excepted). Halves in time
/// until a part's highest speed is below the lowest cap it passes.
bool keeps_below_caps(const ValleyRamps& r, const Anchor& p, const Anchor& q, RampLimits limits,
                      const Anchor& b);

}  // namespace kadr::planner
