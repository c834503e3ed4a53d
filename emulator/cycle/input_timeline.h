#pragma once
#include <vector>

#include "emulator/emulator.h"

namespace kadr::emulator {

/// Follows one input from a time on. An input reads 0 until its first step; a step holds from the beginning
/// of its control tick. Rise and fall are steps after `begin_s`; high and low may hold already.
/// @param steps  ascending by tick
WaitOutcome wait_for(const gcode::InputWait& wait, double begin_s, const std::vector<InputStep>& steps,
                     double tau_s);

}  // namespace kadr::emulator
