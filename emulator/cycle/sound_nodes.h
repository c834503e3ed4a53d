#pragma once
#include "emulator/emulator.h"
#include "emulator/interpolator/interpolator.h"

namespace kadr::cycle {

/// The interpolator's check of itself, after a control tick for which it was on: at every pulse the node of
/// every axis is within half a step of the path.
/// @param control_tick  that was advanced
/// @throws BrokenPromise with program line, axis, and the distance in steps
void require_sound_nodes(ControlTicks control_tick, const interpolator::CrossingInterpolator& interpolator,
                         const Job& job);

}  // namespace kadr::cycle
