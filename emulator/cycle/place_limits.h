#pragma once
#include "emulator/emulator.h"

namespace kadr::cycle {

/// Puts the technology points that lie at a length of the path on it: a joint is made there, whose speed is
/// limited. K3205 for a length that the path does not have, and where the program waits for an input: how
/// long it waits is decided before its whole path is known.
void limit_places(const std::vector<PlaceLimit>& points, ReadProgram& read, Diagnostics& diagnostics);

}  // namespace kadr::cycle
